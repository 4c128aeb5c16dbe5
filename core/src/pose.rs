use crate::Vector3;

/// Where something is in the world and how it is turned: a collider, the frame of a cloth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position in m: of a collider at most 1e6 from the cloth's origin along each axis, of a frame at most 1e12 in size.
    pub position_m: Vector3<f64>,
    /// Rotation as a quaternion x, y, z, w, 1e-3 to 1e3 long. Of a frame only its changes count: 0, 0, 0, 1 is how the cloth
    /// was made.
    pub rotation: [f32; 4],
}

impl Pose {
    /// At a place, not turned.
    pub fn at(position_m: Vector3<f64>) -> Pose {
        Pose { position_m, rotation: [0.0, 0.0, 0.0, 1.0] }
    }
}
