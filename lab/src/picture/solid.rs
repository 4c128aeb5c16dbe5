//! Draws what a cloth lies on, in grey.

use std::f32::consts::{PI, TAU};

use super::camera::Camera;
use super::cloth::Lights;
use super::color::{Linear, to_linear};
use super::raster::{Raster, Vertex};
use super::vector::{Vec3, add, scale};
use crate::scene::Solid;

/// Colour of every solid.
const GREY: [u8; 3] = [168, 168, 164];

/// Drawn smaller by this share: cloth that lies on it is made of flat pieces that would dip into it.
const SHRUNK: f32 = 0.99;

/// Pieces around, and from top to bottom.
const AROUND: usize = 96;
const DOWN: usize = 48;

/// Length of an endless pedestal in the picture, in radii.
const LEG: f32 = 2.0;

/// Draws a solid.
pub fn draw(raster: &mut Raster, camera: &Camera, solid: &Solid) {
    let lights = Lights::new(camera);
    let grey = to_linear(GREY);
    let shade = |&[x, y, z]: &[f32; 3]| -> Linear {
        let light = lights.at([x, y, z]);
        std::array::from_fn(|i| grey[i] * light[i])
    };
    let mut piece = |corners: [(Vec3, Vec3); 4]| {
        let [a, b, c, d] = corners.map(|(at, normal)| Vertex { screen: camera.project(at), values: normal });
        raster.triangle([&a, &b, &c], shade);
        raster.triangle([&a, &c, &d], shade);
    };
    let circle = |i: usize| {
        let (sin, cos) = (TAU * i as f32 / AROUND as f32).sin_cos();
        [cos, 0.0, sin]
    };
    match *solid {
        Solid::Sphere { middle_m, radius_m } => {
            let at = |down: usize, around: usize| {
                let (sin, cos) = (PI * down as f32 / DOWN as f32).sin_cos();
                let normal = add(scale(circle(around), sin), [0.0, cos, 0.0]);
                (add(middle_m, scale(normal, SHRUNK * radius_m)), normal)
            };
            for (i, j) in (0..DOWN).flat_map(|i| (0..AROUND).map(move |j| (i, j))) {
                piece([at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
            }
        }
        Solid::Pedestal { top_m, radius_m } => {
            let radius = SHRUNK * radius_m;
            let top = add(top_m, [0.0, -(radius_m - radius), 0.0]);
            let at = |around: usize, down: f32| add(add(top, scale(circle(around), radius)), [0.0, -down, 0.0]);
            for i in 0..AROUND {
                let (a, b) = (circle(i), circle(i + 1));
                let (leg, up) = (LEG * radius, [0.0, 1.0, 0.0]);
                piece([(at(i, 0.0), a), (at(i + 1, 0.0), b), (at(i + 1, leg), b), (at(i, leg), a)]);
                piece([(top, up), (at(i, 0.0), up), (at(i + 1, 0.0), up), (top, up)]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::camera::{Frame, View};
    use super::*;

    #[test]
    fn a_sphere_is_a_disc_and_a_pedestal_stands_below_its_top() {
        let view = View::new(0.0, 0.0);
        let frame = Frame { min: [-1.0, -1.0], max: [1.0, 1.0] };
        let camera = Camera::fit(view, &frame, 100, 100, 0);
        let covered = |solid: Solid| {
            let mut raster = Raster::new(100, 100);
            draw(&mut raster, &camera, &solid);
            let share = |rows: std::ops::Range<usize>| {
                let pixels = rows.flat_map(|y| (0..100).map(move |x| (x, y)));
                pixels.map(|(x, y)| f64::from(raster.pixel(x, y).1)).sum::<f64>() / 2500.0
            };
            [share(0..50), share(50..100)]
        };
        let [upper, lower] = covered(Solid::Sphere { middle_m: [0.0; 3], radius_m: 0.5 });
        let half = 0.5 * std::f64::consts::PI * (0.5 * f64::from(SHRUNK)).powi(2);
        assert!((upper - half).abs() < 0.01 && (lower - half).abs() < 0.01, "{upper} {lower}");
        let [upper, lower] = covered(Solid::Pedestal { top_m: [0.0; 3], radius_m: 0.5 });
        assert!(upper == 0.0 && (lower - 2.0 * 0.5 * f64::from(SHRUNK)).abs() < 0.02, "{upper} {lower}");
    }
}
