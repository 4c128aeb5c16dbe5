//! A fixed parallel camera.
//!
//! Parallel, not perspective: a metre is the same number of pixels in every panel and at every depth, so that lengths on
//! a sheet can be compared with a ruler.

use super::vector::{Vec3, cross, dot, normalized};

/// Where the viewer stands, as seen from the cloth: y is up in the lab's scenes, z points to the front.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Unit vector to the right of the picture.
    pub right: Vec3,
    /// Unit vector to the top of the picture.
    pub up: Vec3,
    /// Unit vector from the scene to the viewer.
    pub toward: Vec3,
}

impl View {
    /// The viewer stands `yaw` degrees to the right of the front and `pitch` degrees (below 90) above the horizon.
    pub fn new(yaw: f32, pitch: f32) -> Self {
        let (sin_yaw, cos_yaw) = yaw.to_radians().sin_cos();
        let (sin_pitch, cos_pitch) = pitch.to_radians().sin_cos();
        let toward = [sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch];
        let right = normalized(cross([0.0, 1.0, 0.0], toward)).unwrap_or([1.0, 0.0, 0.0]);
        Self { right, up: cross(toward, right), toward }
    }

    /// Metres to the right, metres up, metres toward the viewer.
    pub fn coordinates(&self, point: Vec3) -> Vec3 {
        [dot(point, self.right), dot(point, self.up), dot(point, self.toward)]
    }
}

/// A box in the picture's plane, metres right and up in a [`View`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Smallest coordinates.
    pub min: [f32; 2],
    /// Largest coordinates.
    pub max: [f32; 2],
}

impl Frame {
    /// The box around points; none without points. Points must be finite.
    pub fn around(view: &View, points: &[Vec3]) -> Option<Self> {
        points.iter().fold(None, |frame: Option<Self>, &point| {
            let [x, y, _] = view.coordinates(point);
            let at = Self { min: [x, y], max: [x, y] };
            Some(frame.map_or(at, |frame| frame.union(&at)))
        })
    }

    /// The box around both.
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: std::array::from_fn(|i| self.min[i].min(other.min[i])),
            max: std::array::from_fn(|i| self.max[i].max(other.max[i])),
        }
    }

    /// This box, cut where it leaves `limit`; a part of `limit` even when they are disjoint or this one is not finite.
    pub fn clamped(&self, limit: &Self) -> Self {
        Self {
            min: std::array::from_fn(|i| self.min[i].max(limit.min[i]).min(limit.max[i])),
            max: std::array::from_fn(|i| self.max[i].max(limit.min[i]).min(limit.max[i])),
        }
    }

    /// The box grown by `margin` metres on every side.
    pub fn grown(&self, margin: f32) -> Self {
        Self { min: self.min.map(|v| v - margin), max: self.max.map(|v| v + margin) }
    }

    /// Width and height, metres.
    pub fn size(&self) -> [f32; 2] {
        [self.max[0] - self.min[0], self.max[1] - self.min[1]]
    }
}

/// A view of a frame through a window of pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    view: View,
    center: [f32; 2],
    pixels_per_metre: f32,
    window: [f32; 2],
}

impl Camera {
    /// Fits `frame` into a window of `width` x `height` pixels, `margin` pixels free all round, centred.
    pub fn fit(view: View, frame: &Frame, width: usize, height: usize, margin: usize) -> Self {
        let window = [width as f32, height as f32];
        let size = frame.size();
        let free = window.map(|side| (side - 2.0 * margin as f32).max(1.0));
        let pixels_per_metre = (free[0] / size[0].max(1e-6)).min(free[1] / size[1].max(1e-6));
        let center = [0.5 * (frame.min[0] + frame.max[0]), 0.5 * (frame.min[1] + frame.max[1])];
        Self { view, center, pixels_per_metre, window }
    }

    /// The directions it looks along.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// Its scale.
    pub fn pixels_per_metre(&self) -> f32 {
        self.pixels_per_metre
    }

    /// Pixels right of and below the window's top left corner, and metres toward the viewer.
    pub fn project(&self, point: Vec3) -> Vec3 {
        let [x, y, depth] = self.view.coordinates(point);
        [
            0.5 * self.window[0] + (x - self.center[0]) * self.pixels_per_metre,
            0.5 * self.window[1] - (y - self.center[1]) * self.pixels_per_metre,
            depth,
        ]
    }

    /// A direction given in the picture's frame (right, up, toward the viewer) as one of the scene.
    pub fn direction(&self, local: Vec3) -> Vec3 {
        let View { right, up, toward } = self.view;
        std::array::from_fn(|i| right[i] * local[0] + up[i] * local[1] + toward[i] * local[2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn view_is_right_handed_and_orthonormal() {
        let view = View::new(25.0, 10.0);
        for (a, b) in [(view.right, view.up), (view.up, view.toward), (view.toward, view.right)] {
            assert!(dot(a, b).abs() < 1e-6);
            assert!((dot(a, a) - 1.0).abs() < 1e-6);
        }
        assert!(dot(cross(view.right, view.up), view.toward) > 0.99);
        assert!(view.up[1] > 0.9 && view.toward[0] > 0.0 && view.toward[1] > 0.0);
    }

    #[test]
    fn fitted_frame_touches_the_margin() {
        let view = View::new(0.0, 0.0);
        let frame = Frame { min: [-1.0, -2.0], max: [1.0, 0.0] };
        let camera = Camera::fit(view, &frame, 120, 300, 10);
        let corner = camera.project([-1.0, 0.0, 5.0]);
        assert!((corner[0] - 10.0).abs() < 1e-3 && (corner[1] - 100.0).abs() < 1e-3, "{corner:?}");
        assert!((camera.pixels_per_metre() - 50.0).abs() < 1e-3);
    }

    #[test]
    fn a_far_frame_is_cut_to_its_limit() {
        let limit = Frame { min: [0.0, 0.0], max: [1.0, 1.0] };
        let far = Frame { min: [5.0, 0.5], max: [6.0, 9.0] };
        assert_eq!(far.clamped(&limit), Frame { min: [1.0, 0.5], max: [1.0, 1.0] });
    }
}
