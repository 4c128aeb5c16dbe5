//! Three-component arithmetic for the renderer.

/// A point or direction.
pub type Vec3 = [f32; 3];

/// `a + b`.
pub fn add(a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|i| a[i] + b[i])
}

/// `a - b`.
pub fn sub(a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|i| a[i] - b[i])
}

/// `a * factor`.
pub fn scale(a: Vec3, factor: f32) -> Vec3 {
    a.map(|v| v * factor)
}

/// Scalar product.
pub fn dot(a: Vec3, b: Vec3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Euclidean length.
pub fn length(a: Vec3) -> f32 {
    dot(a, a).sqrt()
}

/// The unit vector along `a`; none when `a` is (nearly) zero or not finite.
pub fn normalized(a: Vec3) -> Option<Vec3> {
    let length = length(a);
    (length > 1e-20 && length.is_finite()).then(|| scale(a, 1.0 / length))
}
