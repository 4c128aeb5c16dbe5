//! What a picture of 64 x 64 pixels shows of a cloth: its silhouette and its shading.
//!
//! The camera is parallel and stands in front of the scene (x to the right, y up) or above it (x to the right, -z up), at
//! the same place for the reference and for taut. The shading is Lambert's, of both sides alike, with a share of light from
//! everywhere; the background is black.

use super::mesh::Mesh;
use super::score;
use crate::picture::{Raster, Vertex};

/// Pixels along each side.
pub const SIDE: usize = 64;

/// Direction to the light (right, up, toward the viewer), and the share of the light that is there whatever the direction.
const LIGHT: [f32; 3] = [0.48, 0.39, 0.79];
const AMBIENT: f32 = 0.25;

/// Where the camera stands and what it sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Whether it looks down along -y, else along -z.
    pub above: bool,
    /// The lower left corner of what it sees (right, up) in m.
    pub corner_m: [f32; 2],
    /// The side of what it sees in m.
    pub side_m: f32,
}

/// Intensities from 0 to 1, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The share of each pixel that cloth covers.
    pub silhouette: Vec<f64>,
    /// Light.
    pub shading: Vec<f64>,
}

/// How like the reference a picture is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Likeness {
    /// NMSE of the silhouettes.
    pub silhouette_nmse: f64,
    /// PSNR of the shadings in dB.
    pub psnr_db: f64,
    /// SSIM of the shadings.
    pub ssim: f64,
}

impl View {
    /// Right, up and toward the viewer.
    fn seen(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        if self.above { [x, -z, y] } else { [x, y, z] }
    }

    /// The picture of a shape of a mesh, whose coordinates must be finite.
    pub fn picture(&self, mesh: &Mesh, x: &[[f32; 3]]) -> Picture {
        let x: Vec<[f32; 3]> = x.iter().map(|p| self.seen(*p)).collect();
        let scale = SIDE as f32 / self.side_m;
        let screen = |[right, up, toward]: [f32; 3]| {
            [(right - self.corner_m[0]) * scale, SIDE as f32 - (up - self.corner_m[1]) * scale, toward]
        };
        let normals = normals(mesh, &x);
        let mut raster = Raster::new(SIDE, SIDE);
        for triangle in &mesh.triangles {
            let corners = triangle.map(|v| Vertex { screen: screen(x[v]), values: normals[v] });
            let [a, b, c] = &corners;
            raster.triangle([a, b, c], |normal| [light(*normal); 3]);
        }
        let pixels = (0..SIDE * SIDE).map(|i| raster.pixel(i % SIDE, i / SIDE));
        let (silhouette, shading) =
            pixels.map(|([light, ..], share)| (f64::from(share), f64::from(light * share))).unzip();
        Picture { silhouette, shading }
    }
}

impl Picture {
    /// How like a reference it is.
    pub fn likeness(&self, reference: &Picture) -> Likeness {
        Likeness {
            silhouette_nmse: score::nmse(&reference.silhouette, &self.silhouette),
            psnr_db: score::psnr(&reference.shading, &self.shading),
            ssim: score::ssim(&reference.shading, &self.shading, SIDE),
        }
    }
}

/// Normals of the vertices, as long as the area around them: the sums of those of their triangles.
fn normals(mesh: &Mesh, x: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut normals = vec![[0.0; 3]; x.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| x[v]);
        let [p, q]: [[f32; 3]; 2] = [std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i])];
        let normal = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        for v in triangle {
            for (sum, n) in normals[*v].iter_mut().zip(normal) {
                *sum += n;
            }
        }
    }
    normals
}

/// Light that a white surface sends to the viewer, 0 to 1.
fn light(normal: [f32; 3]) -> f32 {
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let long = (dot(normal, normal) * dot(LIGHT, LIGHT)).sqrt();
    let toward = if normal[2] < 0.0 { -1.0 } else { 1.0 };
    let lambert = if long > 0.0 { toward * dot(normal, LIGHT) / long } else { 0.0 };
    AMBIENT + (1.0 - AMBIENT) * lambert.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRONT: View = View { above: false, corner_m: [-0.5, -0.5], side_m: 2.0 };

    fn flat() -> (Mesh, Vec<[f32; 3]>) {
        let mesh = Mesh::square(9);
        let x = mesh.uv.iter().map(|[u, v]| [*u, *v, 0.0]).collect();
        (mesh, x)
    }

    #[test]
    fn a_square_covers_its_pixels_and_is_lit_by_its_slope() {
        let (mesh, x) = flat();
        let picture = FRONT.picture(&mesh, &x);
        for (i, share) in picture.silhouette.iter().enumerate() {
            let inside = (16..48).contains(&(i % SIDE)) && (16..48).contains(&(i / SIDE));
            assert_eq!(*share, f64::from(u8::from(inside)), "pixel {i}");
        }
        let flat = f64::from(AMBIENT + (1.0 - AMBIENT) * LIGHT[2] / LIGHT.map(|x| x * x).iter().sum::<f32>().sqrt());
        assert!((picture.shading[32 * SIDE + 32] - flat).abs() < 1e-5);
        // turned by 45 degrees about the vertical, either side is as bright as the other
        let turned = |side: f32| {
            let h = std::f32::consts::FRAC_1_SQRT_2;
            let x: Vec<[f32; 3]> = x.iter().map(|[u, v, _]| [0.5 + h * (u - 0.5), *v, side * h * u]).collect();
            FRONT.picture(&mesh, &x).shading[32 * SIDE + 32]
        };
        assert!(turned(-1.0) > flat && turned(1.0) < flat);
    }

    #[test]
    fn seen_from_above_row_0_is_at_the_top() {
        let (mesh, _) = flat();
        // a strip along u at z = 0 to 0.1
        let x: Vec<[f32; 3]> = mesh.uv.iter().map(|[u, v]| [*u, 0.3, 0.1 * (1.0 - v)]).collect();
        let view = View { above: true, corner_m: [0.0, -1.0], side_m: 1.0 };
        let picture = view.picture(&mesh, &x);
        assert!(picture.silhouette[SIDE + 32] == 1.0 && picture.silhouette[20 * SIDE + 32] == 0.0);
    }

    #[test]
    fn likeness_falls_with_the_way_that_a_cloth_is_moved() {
        let (mesh, x) = flat();
        let reference = FRONT.picture(&mesh, &x);
        let moved = |way: f32| {
            let x: Vec<[f32; 3]> = x.iter().map(|[u, v, z]| [u + way, *v, *z]).collect();
            FRONT.picture(&mesh, &x).likeness(&reference)
        };
        let (same, near, far) = (moved(0.0), moved(0.03125), moved(0.125));
        assert_eq!((same.silhouette_nmse, same.psnr_db), (0.0, f64::INFINITY));
        // one column of 32 goes, one comes
        assert!((near.silhouette_nmse - 2.0 / 32.0).abs() < 1e-9, "{near:?}");
        assert!(same.ssim > near.ssim && near.ssim > far.ssim && near.psnr_db > far.psnr_db);
    }
}
