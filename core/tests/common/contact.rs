//! Short ways to make colliders.

use taut::{ColliderDef, Pose, Shape, Vector3};

pub fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::at(Vector3::new(x, y, z))
}

/// Turned by an angle in rad around an axis of length 1.
pub fn turned(position_m: Vector3<f64>, axis: [f64; 3], angle: f64) -> Pose {
    let (s, c) = (angle / 2.0).sin_cos();
    let [x, y, z] = axis.map(|a| (a * s) as f32);
    Pose { position_m, rotation: [x, y, z, c as f32] }
}

pub fn with(shape: Shape, pose: Pose, friction: f32, thickness_m: f32) -> ColliderDef {
    ColliderDef { shape, pose, friction, thickness_m }
}

pub const UP: Shape = Shape::Plane { normal: [0.0, 1.0, 0.0] };
