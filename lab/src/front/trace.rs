//! What is kept of a run to compare it with another.

use taut::Cloth;

use crate::compare::Frame;
use crate::metrics::percentile;
use crate::scene::Scene;

/// Frames of the last second whose strains count where a scene does not come to rest.
const LATE_FRAMES: u32 = 10;

/// A run as it is compared.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    /// Centre of mass after each frame in m.
    pub centres_m: Vec<[f64; 3]>,
    /// Kinetic energy after each frame in J for each kg, with the mass, not the inertia.
    pub kinetic_j_per_kg: Vec<f64>,
    /// Thread CPU time of each frame in s.
    pub frames_s: Vec<f64>,
    /// Strains of the springs along u and along v, late in the run: at its end where the scene rests, else those of ten
    /// frames of the last second. In the order of the springs until [`Trace::finish`] sorts them.
    pub late: [Vec<f64>; 2],
    /// Positions at the end in m.
    pub positions: Vec<[f32; 3]>,
    late_largest: Vec<f64>,
}

impl Trace {
    /// Takes a frame of a scene.
    pub fn take(&mut self, scene: Scene, rate_hz: f32, cloth: &Cloth<'_>, frame: Frame) {
        self.frames_s.push(frame.cpu.as_secs_f64());
        let particles = cloth.grid().particles();
        let (mut centre, mut squares, mut free) = ([0.0; 3], 0.0, 0.0f64);
        let mut pinned = vec![false; particles];
        cloth.pinned().for_each(|p| pinned[p] = true);
        for i in 0..particles {
            let (Ok(x), Ok(v)) = (cloth.position(i), cloth.velocity(i)) else { continue };
            for (sum, x) in centre.iter_mut().zip(x.iter()) {
                *sum += f64::from(*x) / particles as f64;
            }
            if !pinned[i] {
                squares += v.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>();
                free += 1.0;
            }
        }
        self.centres_m.push(centre);
        self.kinetic_j_per_kg.push(0.5 * squares / free.max(1.0));

        let left = frame.of - 1 - frame.index;
        let every = ((rate_hz / LATE_FRAMES as f32).round() as u32).max(1);
        let counts = if scene.rests() { left == 0 } else { left < every * LATE_FRAMES && left.is_multiple_of(every) };
        if counts {
            let mut largest = f64::NEG_INFINITY;
            cloth.each_structural_strain(|a, b, strain| {
                let strain = f64::from(strain);
                self.late[usize::from(b != a + 1)].push(strain);
                largest = largest.max(strain);
            });
            self.late_largest.push(largest);
        }
        if left == 0 {
            let positions = (0..particles).filter_map(|i| cloth.position(i).ok());
            self.positions = positions.map(|p| [p.x, p.y, p.z]).collect();
        }
    }

    /// Sorts the late strains. Call it once, after the last frame.
    pub fn finish(&mut self) {
        for strains in &mut self.late {
            strains.sort_by(f64::total_cmp);
        }
    }

    /// Largest, 99th percentile and mean of the late strains in percent; the largest is the mean of the frames' largest.
    pub fn stretch_pct(&self) -> [f64; 3] {
        let mut all = self.late.concat();
        all.sort_by(f64::total_cmp);
        if all.is_empty() {
            return [f64::NAN; 3];
        }
        let mean = |v: &[f64]| 100.0 * v.iter().sum::<f64>() / v.len() as f64;
        [mean(&self.late_largest), 100.0 * percentile(&all, 0.99), mean(&all)]
    }

    /// Root mean square difference of the sorted strains to those of another run in points of percent: 0 where as many
    /// springs are stretched as much, wherever a fold happens to lie. Both runs are of one grid, and finished.
    pub fn strain_error_points(&self, other: &Trace) -> f64 {
        let (mut squares, mut count) = (0.0, 0.0f64);
        for (a, b) in self.late.iter().zip(&other.late) {
            // another rate counts as many frames, a mask as many springs
            if a.len() != b.len() {
                return f64::NAN;
            }
            squares += a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            count += a.len() as f64;
        }
        100.0 * (squares / count).sqrt()
    }

    /// Root mean square distance of the particles at the end in m.
    pub fn distance_m(&self, other: &Trace) -> f64 {
        let squares = self
            .positions
            .iter()
            .zip(&other.positions)
            .map(|(a, b)| a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>());
        (squares.sum::<f64>() / self.positions.len() as f64).sqrt()
    }

    /// Root mean square distance of the centres of mass over the run in m; NaN where the frames are not as many.
    pub fn centre_error_m(&self, other: &Trace) -> f64 {
        if self.centres_m.len() != other.centres_m.len() {
            return f64::NAN;
        }
        let squares = self
            .centres_m
            .iter()
            .zip(&other.centres_m)
            .map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>());
        (squares.sum::<f64>() / self.centres_m.len() as f64).sqrt()
    }

    /// Mean kinetic energy over the run in J/kg.
    pub fn kinetic_energy(&self) -> f64 {
        self.kinetic_j_per_kg.iter().sum::<f64>() / self.kinetic_j_per_kg.len() as f64
    }

    /// Period of the swing in s: see [`swing_period`].
    pub fn swing_period_s(&self, rate_hz: f32) -> f64 {
        let z: Vec<f64> = self.centres_m.iter().map(|c| c[2]).collect();
        swing_period(&z, f64::from(rate_hz))
    }
}

/// Period in s of what swings about 0, from its first three passages: samples at a rate in Hz. NaN where it passes fewer
/// than three times.
pub fn swing_period(samples: &[f64], rate_hz: f64) -> f64 {
    let mut passages = Vec::new();
    for (i, pair) in samples.windows(2).enumerate() {
        if (pair[0] > 0.0) != (pair[1] > 0.0) {
            passages.push((i as f64 + pair[0] / (pair[0] - pair[1])) / rate_hz);
        }
    }
    if passages.len() < 3 { f64::NAN } else { passages[2] - passages[0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cosine_has_its_period() {
        let samples: Vec<f64> = (0..240).map(|i| (std::f64::consts::TAU * f64::from(i) / 60.0 / 1.7).cos()).collect();
        assert!((swing_period(&samples, 60.0) - 1.7).abs() < 1e-3, "{}", swing_period(&samples, 60.0));
        assert!(swing_period(&samples[..60], 60.0).is_nan(), "one passage is no period");
    }

    #[test]
    fn a_run_has_no_distance_to_itself_and_the_known_one_to_a_shifted_run() {
        let a = Trace {
            centres_m: vec![[0.0; 3]; 4],
            late: [vec![0.01, 0.02], vec![0.03, 0.05]],
            positions: vec![[0.0; 3]; 5],
            ..Trace::default()
        };
        let mut b = a.clone();
        assert_eq!((a.strain_error_points(&b), a.distance_m(&b), a.centre_error_m(&b)), (0.0, 0.0, 0.0));
        b.centres_m.iter_mut().for_each(|c| c[1] += 0.3);
        b.positions.iter_mut().for_each(|p| p[2] += 0.25);
        b.late.iter_mut().flatten().for_each(|s| *s += 0.02);
        assert!((a.strain_error_points(&b) - 2.0).abs() < 1e-9);
        assert!((a.distance_m(&b) - 0.25).abs() < 1e-9 && (a.centre_error_m(&b) - 0.3).abs() < 1e-9);
        b.late[0].pop();
        assert!(a.strain_error_points(&b).is_nan());
    }
}
