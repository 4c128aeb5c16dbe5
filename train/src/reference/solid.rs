//! What the cloth lies on.

use taut_lab::scene;

use super::vector::{V3, length, scale, sub};

/// A solid that does not move. y points up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solid {
    /// A ball.
    Sphere {
        /// Its middle in m.
        middle_m: V3,
        /// Its radius in m.
        radius_m: f64,
    },
    /// An upright cylinder, endless downwards.
    Pedestal {
        /// The middle of its top in m.
        top_m: V3,
        /// Its radius in m.
        radius_m: f64,
    },
}

impl From<scene::Solid> for Solid {
    fn from(solid: scene::Solid) -> Solid {
        match solid {
            scene::Solid::Sphere { middle_m, radius_m } => {
                Solid::Sphere { middle_m: middle_m.map(f64::from), radius_m: f64::from(radius_m) }
            }
            scene::Solid::Pedestal { top_m, radius_m } => {
                Solid::Pedestal { top_m: top_m.map(f64::from), radius_m: f64::from(radius_m) }
            }
        }
    }
}

impl Solid {
    /// Signed distance of a place from the surface in m, negative inside, and the normal there, outwards.
    pub fn distance(&self, at: V3) -> (f64, V3) {
        const UP: V3 = [0.0, 1.0, 0.0];
        match *self {
            Solid::Sphere { middle_m, radius_m } => {
                let way = sub(at, middle_m);
                let far = length(way);
                (far - radius_m, if far > 0.0 { scale(1.0 / far, way) } else { UP })
            }
            Solid::Pedestal { top_m, radius_m } => {
                let [x, y, z] = sub(at, top_m);
                let r = x.hypot(z);
                let side = if r > 0.0 { [x / r, 0.0, z / r] } else { [1.0, 0.0, 0.0] };
                let (out, above) = (r - radius_m, y);
                if out > 0.0 && above > 0.0 {
                    // the rim is nearest
                    let far = out.hypot(above);
                    (far, [side[0] * out / far, above / far, side[2] * out / far])
                } else if above > out {
                    (above, UP)
                } else {
                    (out, side)
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_the_shapes() {
        let ball = Solid::Sphere { middle_m: [0.0, 1.0, 0.0], radius_m: 0.5 };
        assert_eq!(ball.distance([0.0, 2.0, 0.0]), (0.5, [0.0, 1.0, 0.0]));
        assert_eq!(ball.distance([0.25, 1.0, 0.0]), (-0.25, [1.0, 0.0, 0.0]));
        let pedestal = Solid::Pedestal { top_m: [0.0; 3], radius_m: 1.0 };
        assert_eq!(pedestal.distance([0.3, 0.25, 0.0]), (0.25, [0.0, 1.0, 0.0]));
        assert_eq!(pedestal.distance([0.0, -0.25, 0.5]), (-0.25, [0.0, 1.0, 0.0]));
        assert_eq!(pedestal.distance([2.0, -3.0, 0.0]), (1.0, [1.0, 0.0, 0.0]));
        let (far, normal) = pedestal.distance([4.0, 4.0, 0.0]);
        assert!((far - 5.0).abs() < 1e-12 && (normal[0] - 0.6).abs() < 1e-12 && (normal[1] - 0.8).abs() < 1e-12);
    }
}
