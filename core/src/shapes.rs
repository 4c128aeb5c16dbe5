//! The shapes of colliders: signed distance and outward normal, each in the frame of its collider. All are convex.

use crate::math::{max, min, sqrt};
use crate::simd::{Three, Vector};
use crate::{Error, Vector3};

/// Numbers that a shape is stored as.
pub(crate) const SHAPE_NUMBERS: usize = 8;

/// Sizes of shapes in m; below, squares underflow.
const LEAST_M: f32 = 1e-6;
const MOST_M: f32 = 1e4;

/// What a collider is, in its own frame. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A ball around the collider's position; radius 1e-6 to 1e4.
    Sphere {
        /// Radius.
        radius_m: f32,
    },
    /// The hull of two balls: a capsule where the radii are equal, else a tapered one. Ends at most 1e4 from the position
    /// along each axis, radii 1e-6 to 1e4. Where one ball holds the other it is the larger ball.
    Capsule {
        /// Centres of the balls.
        ends_m: [[f32; 3]; 2],
        /// Radii of the balls.
        radii_m: [f32; 2],
    },
    /// The half space behind the plane through the collider's position.
    Plane {
        /// Direction out of the half space, 1e-3 to 1e3 long.
        normal: [f32; 3],
    },
    /// A box around the collider's position, its sides along the axes of the frame.
    Box {
        /// Half the side lengths, each 1e-6 to 1e4.
        half_m: [f32; 3],
    },
}

impl Shape {
    /// Errors: [`Error::NotFinite`], [`Error::OutOfRange`] (a size outside its range, zero included).
    pub(crate) fn check(&self) -> Result<(), Error> {
        let (_, numbers) = self.encode();
        if !numbers.iter().all(|x| x.is_finite()) {
            return Err(Error::NotFinite);
        }
        let size = |x: &f32| (LEAST_M..=MOST_M).contains(x);
        let fits = match self {
            Shape::Sphere { radius_m } => size(radius_m),
            Shape::Capsule { ends_m, radii_m } => {
                radii_m.iter().all(size) && ends_m.as_flattened().iter().all(|x| x.abs() <= MOST_M)
            }
            Shape::Plane { normal } => (1e-3..=1e3).contains(&length(Vector3::from(*normal))),
            Shape::Box { half_m } => half_m.iter().all(size),
        };
        if fits { Ok(()) } else { Err(Error::OutOfRange) }
    }

    /// The kind, 1 to 4, and the numbers.
    pub(crate) fn encode(&self) -> (f32, [f32; SHAPE_NUMBERS]) {
        match *self {
            Shape::Sphere { radius_m: r } => (1.0, [r, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            Shape::Capsule { ends_m: [a, b], radii_m: [r, s] } => (2.0, [a[0], a[1], a[2], b[0], b[1], b[2], r, s]),
            Shape::Plane { normal: n } => (3.0, [n[0], n[1], n[2], 0.0, 0.0, 0.0, 0.0, 0.0]),
            Shape::Box { half_m: h } => (4.0, [h[0], h[1], h[2], 0.0, 0.0, 0.0, 0.0, 0.0]),
        }
    }

    /// The reverse of [`Shape::encode`]; nothing for another kind.
    pub(crate) fn decode(kind: f32, n: [f32; SHAPE_NUMBERS]) -> Option<Shape> {
        match kind {
            1.0 => Some(Shape::Sphere { radius_m: n[0] }),
            2.0 => Some(Shape::Capsule { ends_m: [[n[0], n[1], n[2]], [n[3], n[4], n[5]]], radii_m: [n[6], n[7]] }),
            3.0 => Some(Shape::Plane { normal: [n[0], n[1], n[2]] }),
            4.0 => Some(Shape::Box { half_m: [n[0], n[1], n[2]] }),
            _ => None,
        }
    }
}

/// A shape made ready for distances.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Solid {
    Sphere {
        radius: f32,
    },
    /// The hull of a ball of radius `large` at `from` and one of radius `small` at `from + axis * length`.
    Capsule {
        from: Vector3<f32>,
        /// Of length 1.
        axis: Vector3<f32>,
        length: f32,
        large: f32,
        small: f32,
        /// Of the normal of the side: its part along the axis, and across.
        sine: f32,
        cosine: f32,
        /// Any direction across the axis.
        beside: Vector3<f32>,
    },
    /// Outward normal of length 1.
    Plane {
        normal: Vector3<f32>,
    },
    Box {
        half: Vector3<f32>,
    },
}

impl Solid {
    pub fn new(shape: &Shape) -> Solid {
        match *shape {
            Shape::Sphere { radius_m } => Solid::Sphere { radius: radius_m },
            Shape::Capsule { ends_m: [a, b], radii_m: [r, s] } => {
                let (a, b, large, small) = if r >= s { (a, b, r, s) } else { (b, a, s, r) };
                let (from, way) = (Vector3::from(a), Vector3::from(b) - Vector3::from(a));
                let length = length(way);
                let (axis, _) = direction(way);
                // a ball within the other has no side: the normal then points along the axis everywhere
                let sine = if large - small < length { (large - small) / length } else { 1.0 };
                let cosine = sqrt(max(1.0 - sine * sine, 0.0));
                Solid::Capsule { from, axis, length, large, small, sine, cosine, beside: beside(axis) }
            }
            Shape::Plane { normal } => Solid::Plane { normal: direction(Vector3::from(normal)).0 },
            Shape::Box { half_m } => Solid::Box { half: Vector3::from(half_m) },
        }
    }

    /// Distance to the surface in m, negative inside, and the outward normal of the nearest place on it, of the places of
    /// some lanes.
    #[inline(always)]
    pub fn distance<V: Vector>(&self, zero: V, y: Three<V>) -> (V, Three<V>) {
        match *self {
            Solid::Sphere { radius } => {
                let (normal, away) = directions(zero, y);
                (away - zero.all(radius), normal)
            }
            Solid::Capsule { from, axis, length, large, small, sine, cosine, beside } => {
                let (axis, sine, cosine) = (Three::all(zero, axis), zero.all(sine), zero.all(cosine));
                let w = y.minus(Three::all(zero, from));
                let along = w.dot(axis);
                let across = w.minus(axis.times(along));
                let away = across.length();
                let side = Three::choose(away, zero, across.over(away), Three::all(zero, beside));
                let away = away.above(zero, away, zero);
                // the normal of the side through y starts on the axis at (along - away * sine / cosine)
                let start = along * cosine - away * sine;
                let before = start.one_unless_above(zero);
                let beyond = before.pick(zero, (zero.all(length) * cosine).one_unless_above(start));
                let (normal, to_end) = directions(zero, Three::pick(beyond, w.minus(axis.times(zero.all(length))), w));
                let of_end = to_end - beyond.pick(zero.all(small), zero.all(large));
                let of_side = along * sine + away * cosine - zero.all(large);
                let end = before + beyond;
                (end.pick(of_end, of_side), Three::pick(end, normal, axis.times(sine).plus(side.times(cosine))))
            }
            Solid::Plane { normal } => {
                let normal = Three::all(zero, normal);
                (normal.dot(y), normal)
            }
            Solid::Box { half } => {
                let Three([x, y, z]) = y;
                let (minus, one) = (zero.all(-1.0), zero.all(1.0));
                let sign = [zero.above(x, minus, one), zero.above(y, minus, one), zero.above(z, minus, one)];
                let q = Three([x, y, z]).abs().minus(Three::all(zero, half));
                let outside = q.max(Three([zero; 3]));
                let away = outside.length();
                let n = outside.over(away);
                // inside the nearest face counts, of equal ones the first
                let [qx, qy, qz] = q.0;
                let first = qy.one_unless_above(qx) * qz.one_unless_above(qx);
                let second = first.pick(zero, qz.one_unless_above(qy));
                let third = one - first - second;
                let [x, y, z] = sign;
                let face = Three([first.pick(x, zero), second.pick(y, zero), third.pick(z, zero)]);
                let depth = first.pick(qx, second.pick(qy, qz));
                let n = Three([n.0[0] * x, n.0[1] * y, n.0[2] * z]);
                (away.above(zero, away, depth), Three::choose(away, zero, n, face))
            }
        }
    }
}

/// [`direction`] in each lane.
#[inline(always)]
fn directions<V: Vector>(zero: V, v: Three<V>) -> (Three<V>, V) {
    let length = v.length();
    let up = Three([zero, zero.all(1.0), zero]);
    (Three::choose(length, zero, v.over(length), up), length.above(zero, length, zero))
}

/// Length of a vector.
#[inline(always)]
pub(crate) fn length(v: Vector3<f32>) -> f32 {
    sqrt(v.x * v.x + v.y * v.y + v.z * v.z)
}

/// Direction and length; y where there is no direction.
#[inline(always)]
pub(crate) fn direction(v: Vector3<f32>) -> (Vector3<f32>, f32) {
    let length = length(v);
    if length > 0.0 { (v / length, length) } else { (Vector3::new(0.0, 1.0, 0.0), 0.0) }
}

/// A direction across an axis of length 1.
fn beside(axis: Vector3<f32>) -> Vector3<f32> {
    let (x, y, z) = (axis.x.abs(), axis.y.abs(), axis.z.abs());
    let least = min(x, min(y, z));
    let other = if x == least {
        Vector3::new(0.0, axis.z, -axis.y)
    } else if y == least {
        Vector3::new(-axis.z, 0.0, axis.x)
    } else {
        Vector3::new(axis.y, -axis.x, 0.0)
    };
    direction(other).0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{Pass, run};
    use crate::width::Supported;
    use crate::{Width, noise};

    /// The distance from a solid.
    struct At<'a>(&'a Solid, Vector3<f32>);

    impl Pass for At<'_> {
        type Output = (f32, Vector3<f32>);

        #[inline(always)]
        fn run<V: Vector>(self, zero: V) -> (f32, Vector3<f32>) {
            let (distance, Three([x, y, z])) = self.0.distance(zero, Three::all(zero, self.1));
            let first = |lanes: V| {
                let mut all = [0.0; 16];
                lanes.write(&mut all, 0);
                all[0]
            };
            (first(distance), Vector3::new(first(x), first(y), first(z)))
        }
    }

    fn distance(solid: &Solid, y: Vector3<f32>) -> (f32, Vector3<f32>) {
        run(Supported::new(Width::Scalar).unwrap(), At(solid, y))
    }

    fn random(count: &mut u32, size: f32) -> Vector3<f32> {
        *count += 3;
        let g = |i: u32| size * noise::gaussian(7, *count - i);
        Vector3::new(g(0), g(1), g(2))
    }

    /// Places all over the surface of the hull of two balls: balls along the axis whose radius runs linearly.
    fn hull_distance(y: Vector3<f32>, ends: [[f32; 3]; 2], radii: [f32; 2]) -> f64 {
        let (a, b) = (Vector3::from(ends[0]).cast::<f64>(), Vector3::from(ends[1]).cast::<f64>());
        let of = |t: f64| {
            let r = f64::from(radii[0]) * (1.0 - t) + f64::from(radii[1]) * t;
            (y.cast::<f64>() - a * (1.0 - t) - b * t).norm() - r
        };
        (0..=40_000).map(|i| of(f64::from(i) / 40_000.0)).fold(f64::INFINITY, f64::min)
    }

    /// Outside, the signed distance to a hull of balls is the least of the distances to its balls.
    #[test]
    fn the_capsule_agrees_with_its_balls() {
        let mut count = 0;
        let cases = [
            ([[0.0, 0.0, 0.0], [0.3, 0.1, -0.2]], [0.1, 0.1]),
            ([[0.1, 0.0, 0.2], [-0.3, 0.1, 0.5]], [0.05, 0.2]),
            ([[0.0, 0.2, 0.0], [0.0, -0.2, 0.0]], [0.3, 0.02]),
            // one holds the other; and no length at all
            ([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]], [0.3, 0.05]),
            ([[0.1, 0.1, 0.1], [0.1, 0.1, 0.1]], [0.2, 0.2]),
        ];
        for (ends_m, radii_m) in cases {
            let solid = Solid::new(&Shape::Capsule { ends_m, radii_m });
            let mut outside = 0;
            for _ in 0..60 {
                let y = random(&mut count, 0.5);
                let (phi, n) = distance(&solid, y);
                let brute = hull_distance(y, ends_m, radii_m);
                assert!((length(n) - 1.0).abs() < 1e-5);
                if brute > 0.0 {
                    outside += 1;
                    assert!((f64::from(phi) - brute).abs() < 1e-5, "{ends_m:?} {y:?}: {phi} {brute}");
                } else {
                    assert!(phi <= 1e-6);
                }
            }
            assert!(outside > 20);
        }
    }

    /// Against the nearest of many places on the six faces.
    #[test]
    fn the_box_agrees_with_places_on_its_faces() {
        let half = Vector3::new(0.3f32, 0.1, 0.2);
        let solid = Solid::new(&Shape::Box { half_m: [0.3, 0.1, 0.2] });
        let mut count = 0;
        for _ in 0..100 {
            let y = random(&mut count, 0.25);
            let (phi, _) = distance(&solid, y);
            let inside = (0..3).all(|a| y[a].abs() < half[a]);
            let mut nearest = f32::INFINITY;
            for axis in 0..3 {
                let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
                for side in [-1.0, 1.0] {
                    for i in 0..=100 {
                        for j in 0..=100 {
                            let mut p = Vector3::zeros();
                            p[axis] = side * half[axis];
                            p[b] = half[b] * (i as f32 / 50.0 - 1.0);
                            p[c] = half[c] * (j as f32 / 50.0 - 1.0);
                            nearest = nearest.min((p - y).norm());
                        }
                    }
                }
            }
            // places are 6 mm apart at most: a place d away is seen within d^2 / 2 phi of it
            let seen = if inside { -nearest } else { nearest };
            assert!((phi - seen).abs() < 0.005 && phi <= seen.max(nearest) + 1e-6, "{y:?}: {phi} {seen}");
        }
    }

    /// The normal is the gradient: what the search of the entry rests on. And the distance never falls faster than the way.
    #[test]
    fn normals_are_gradients() {
        let shapes = [
            Shape::Sphere { radius_m: 0.2 },
            Shape::Capsule { ends_m: [[0.1, 0.0, 0.2], [-0.3, 0.1, 0.5]], radii_m: [0.05, 0.2] },
            Shape::Plane { normal: [1.0, 2.0, -0.5] },
            Shape::Box { half_m: [0.3, 0.1, 0.2] },
        ];
        let mut count = 50_000;
        for shape in shapes {
            assert_eq!(shape.check(), Ok(()));
            let (kind, numbers) = shape.encode();
            assert_eq!(Shape::decode(kind, numbers), Some(shape));
            let solid = Solid::new(&shape);
            for _ in 0..300 {
                let (y, way) = (random(&mut count, 0.4), random(&mut count, 1e-3));
                let (phi, n) = distance(&solid, y);
                let (next, m) = distance(&solid, y + way);
                assert!((next - phi).abs() <= length(way) * 1.001 + 1e-6);
                if n.dot(&m) > 0.99 {
                    // second order: way^2 / (2 radius of curvature)
                    assert!((next - phi - n.dot(&way)).abs() < 1e-4, "{shape:?} {y:?}");
                }
                // convex: the distance is above its tangent
                assert!(next >= phi + n.dot(&way) - 2e-6, "{shape:?} {y:?}");
            }
        }
    }

    #[test]
    fn sizes_that_are_none_are_refused() {
        for x in [0.0, -1.0, 1e5, 1e-7] {
            let half = [0.1, x, 0.1];
            assert_eq!(Shape::Sphere { radius_m: x }.check(), Err(Error::OutOfRange));
            assert_eq!(Shape::Box { half_m: half }.check(), Err(Error::OutOfRange));
            let capsule = Shape::Capsule { ends_m: [[0.0; 3], [1.0, 0.0, 0.0]], radii_m: [0.1, x] };
            assert_eq!(capsule.check(), Err(Error::OutOfRange));
        }
        assert_eq!(Shape::Plane { normal: [0.0; 3] }.check(), Err(Error::OutOfRange));
        let far = Shape::Capsule { ends_m: [[0.0; 3], [0.0, 2e4, 0.0]], radii_m: [0.1; 2] };
        assert_eq!(far.check(), Err(Error::OutOfRange));
        for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(Shape::Sphere { radius_m: x }.check(), Err(Error::NotFinite));
            assert_eq!(Shape::Plane { normal: [0.0, x, 1.0] }.check(), Err(Error::NotFinite));
        }
    }
}
