//! The points that no other point beats.

/// Indices of the points (cost, error) to which no other is at most as dear and at most as wrong, by rising cost. Points
/// that are not finite never belong to them; of equal points the first does.
pub fn pareto(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|i| points[*i].iter().all(|x| x.is_finite())).collect();
    order.sort_by(|a, b| {
        let ([ca, ea], [cb, eb]) = (points[*a], points[*b]);
        ca.total_cmp(&cb).then(ea.total_cmp(&eb)).then(a.cmp(b))
    });
    let mut least = f64::INFINITY;
    order.retain(|i| {
        let better = points[*i][1] < least;
        least = least.min(points[*i][1]);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points = [[3.0, 1.0], [1.0, 4.0], [2.0, 5.0], [2.0, 2.0], [2.0, 2.0], [f64::NAN, 0.0], [9.0, 1.0]];
        assert_eq!(pareto(&points), [1, 3, 0]);
        assert_eq!(pareto(&[]), [0usize; 0]);
    }

    #[test]
    fn every_point_off_the_front_is_beaten_by_one_on_it() {
        let draw = |i: u32| f64::from(taut::noise::uniform(5, i));
        let points: Vec<[f64; 2]> = (0..200).map(|i| [draw(2 * i), draw(2 * i + 1)]).collect();
        let front = pareto(&points);
        for (i, p) in points.iter().enumerate() {
            let beaten = front.iter().any(|f| *f != i && points[*f][0] <= p[0] && points[*f][1] <= p[1]);
            assert_ne!(beaten, front.contains(&i), "{i}");
        }
    }
}
