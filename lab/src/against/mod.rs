//! taut's cloth beside a trajectory of another engine, in the format of ARCSim's runs: the same scene, the same edges, the
//! same pictures.
//!
//! A trajectory is an `.npz` file with `x_final` [n, 3], or `x` [frames, n, 3] of which the last frame counts, in m, with z
//! up. Its mesh is an `.npz` file with `uv` [n, 2] (the square metre, v = 1 at the top) and `tris`. taut's grid is resampled
//! to the vertices of the mesh, so that both cloths are measured by the same edges and drawn from the same triangles.

mod mesh;
mod score;
mod view;

use std::fmt;
use std::path::{Path, PathBuf};

use serde::Serialize;

pub use mesh::{Mesh, Strain};
pub use view::{Likeness, Picture, SIDE, View};

use crate::npz::{Npz, NpzError};
use crate::scene::Scene;

/// Most frames of a trajectory.
const MOST_FRAMES: usize = 1 << 16;

/// A scene that trajectories are of, and where it stands in the axes of taut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// taut's scene.
    pub scene: Scene,
    /// How long its trajectories last, in s.
    pub seconds: f32,
    /// Where its origin lies in taut's scene, in m.
    origin_m: [f32; 3],
    /// What its pictures show.
    pub view: View,
    /// Whether every vertex has its own place at rest: where folds come as they like, distances mean nothing.
    distance: bool,
}

impl Stage {
    /// The stages by their names.
    pub const NAMES: [&str; 5] = ["hang2", "hang1", "edge", "drape", "hang2_res"];

    /// The stage of a name; `hang2_res` is `hang2` on other meshes. Error: no trajectory is of that scene.
    pub fn named(name: &str) -> Result<Stage, String> {
        let front = |corner_m, side_m| View { above: false, corner_m, side_m };
        let upright = Stage {
            scene: Scene::Hang2,
            seconds: 4.0,
            origin_m: [0.5, 0.0, 0.0],
            view: front([-0.25, -1.35], 1.5),
            distance: true,
        };
        match name {
            "hang2" | "hang2_res" => Ok(upright),
            "edge" => Ok(Stage { scene: Scene::Edge, seconds: 3.0, ..upright }),
            "hang1" => Ok(Stage {
                scene: Scene::Hang1,
                origin_m: [0.0; 3],
                view: front([-0.9, -1.7], 1.8),
                distance: false,
                ..upright
            }),
            // the sphere's middle is the origin, its top 2 cm below the sheet
            "drape" => Ok(Stage {
                scene: Scene::Drape,
                seconds: 3.0,
                origin_m: [0.5, -0.32, 0.5],
                view: View { above: true, corner_m: [-0.25, -1.25], side_m: 1.5 },
                distance: false,
            }),
            _ => {
                let [first @ .., last] = &Stage::NAMES;
                Err(format!("no trajectory is of the scene `{name}`: choose {} or {last}", first.join(", ")))
            }
        }
    }

    /// A place with z up, in taut's axes.
    pub fn place(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        [x + self.origin_m[0], z + self.origin_m[1], self.origin_m[2] - y]
    }

    /// A place in taut's axes, with z up.
    pub fn place_back(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        [x - self.origin_m[0], self.origin_m[2] - z, y - self.origin_m[1]]
    }

    /// The vertices that the scene pins: those at the places of the pinned particles of a fine grid.
    fn pinned(&self, mesh: &Mesh) -> Vec<usize> {
        let at = |u: f32, v: f32| mesh.uv.iter().position(|p| (p[0] - u).hypot(p[1] - v) < 1e-4);
        match self.scene {
            Scene::Hang2 => [at(0.0, 1.0), at(1.0, 1.0)].into_iter().flatten().collect(),
            Scene::Hang1 => at(0.0, 1.0).into_iter().collect(),
            Scene::Edge => (0..mesh.uv.len()).filter(|i| (mesh.uv[*i][1] - 1.0).abs() < 1e-4).collect(),
            _ => vec![],
        }
    }
}

/// The last frame of a trajectory with what is measured of it.
#[derive(Clone, Debug)]
pub struct Reference {
    stage: Stage,
    mesh: Mesh,
    pinned: Vec<usize>,
    x: Vec<[f32; 3]>,
    strains: [Strain; 3],
    picture: Picture,
}

/// What cannot be compared.
#[derive(Debug)]
pub enum AgainstError {
    /// A file cannot be read.
    File(NpzError),
    /// The mesh lacks a vertex that the scene pins.
    Unpinned(PathBuf, Scene),
}

impl fmt::Display for AgainstError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AgainstError::File(e) => e.fmt(f),
            AgainstError::Unpinned(path, scene) => {
                write!(f, "{}: its mesh has no vertex where the scene {scene} is pinned", path.display())
            }
        }
    }
}

impl std::error::Error for AgainstError {}

impl From<NpzError> for AgainstError {
    fn from(e: NpzError) -> AgainstError {
        AgainstError::File(e)
    }
}

/// A strain of both cloths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Both {
    /// Of taut.
    pub taut: Strain,
    /// Of the reference.
    pub reference: Strain,
}

/// Strains by direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Directions {
    /// Along u, the weft.
    pub u: Both,
    /// Along v, the warp.
    pub v: Both,
    /// Along the diagonals.
    pub diag: Both,
}

/// taut's cloth beside the reference. What cannot be measured is not a number.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Strains in percent of the edges that lie more than 0.1 m from any pin.
    pub ex_pin_pct: Directions,
    /// Squared error of the silhouette over its square.
    pub silhouette_nmse: f64,
    /// Of the shaded pictures.
    pub psnr_db: f64,
    /// Of the shaded pictures.
    pub ssim: f64,
    /// Root mean square distance of the vertices as a share of the side, where that means something (hang2, edge).
    pub distance_pct: Option<f64>,
    /// Whether taut's run stayed finite.
    pub finite: bool,
}

impl Reference {
    /// Reads the last frame of a trajectory of a mesh. Errors: the file, shapes that are not those of the mesh, numbers
    /// that are not finite, a mesh without the pinned vertices of the scene.
    pub fn load(path: &Path, mesh: &Mesh, stage: Stage) -> Result<Reference, AgainstError> {
        let mut npz = Npz::open(path)?;
        let n = mesh.uv.len();
        let array = if npz.has("x_final") || !npz.has("x") { "x_final" } else { "x" };
        let all = npz.floats(array)?;
        let [frames, vertices, axes] = match all.shape[..] {
            [vertices, axes] if array == "x_final" => [1, vertices, axes],
            [frames, vertices, axes] if array == "x" => [frames, vertices, axes],
            _ => [0, 0, 0],
        };
        if axes != 3 || !(1..=MOST_FRAMES).contains(&frames) {
            let meant = if array == "x" { "[frames, n, 3]" } else { "[n, 3]" };
            return Err(npz.wrong(array, format!("has the shape {:?}, not {meant}", all.shape)).into());
        }
        if vertices != n {
            return Err(npz.wrong(array, format!("has {vertices} vertices, the mesh has {n}")).into());
        }
        let pinned = stage.pinned(mesh);
        if pinned.len() < stage.scene.pins(2, 2).len() {
            return Err(AgainstError::Unpinned(path.into(), stage.scene));
        }
        let last = &all.values.as_chunks::<3>().0[(frames - 1) * n..];
        Ok(Reference::new(mesh, stage, pinned, last.iter().map(|p| stage.place(*p)).collect()))
    }

    /// A cloth of taut's as the reference: a grid in taut's axes at the vertices of a mesh, whose pinned vertices must be
    /// there.
    pub fn of_grid(mesh: &Mesh, stage: Stage, positions: &[[f32; 3]], rows: usize, columns: usize) -> Reference {
        Reference::new(mesh, stage, stage.pinned(mesh), mesh.resampled(positions, rows, columns))
    }

    fn new(mesh: &Mesh, stage: Stage, pinned: Vec<usize>, x: Vec<[f32; 3]>) -> Reference {
        let (strains, picture) = (mesh.strains(&x, &pinned), stage.view.picture(mesh, &x));
        Reference { stage, mesh: mesh.clone(), pinned, x, strains, picture }
    }

    /// Its vertices in taut's axes, in m.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.x
    }

    /// Compares a grid of taut's, as [`crate::compare::Outcome`] has it.
    pub fn compare(&self, positions: &[[f32; 3]], rows: usize, columns: usize, finite: bool) -> Comparison {
        let finite = finite && positions.as_flattened().iter().all(|x| x.is_finite());
        let mut strains = [Strain::NONE; 3];
        let mut likeness = Likeness { silhouette_nmse: f64::NAN, psnr_db: f64::NAN, ssim: f64::NAN };
        let mut distance = f64::NAN;
        if finite {
            let x = self.mesh.resampled(positions, rows, columns);
            strains = self.mesh.strains(&x, &self.pinned);
            likeness = self.stage.view.picture(&self.mesh, &x).likeness(&self.picture);
            let squares =
                x.iter().zip(&self.x).flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)));
            distance = 100.0 * (squares.sum::<f64>() / x.len() as f64).sqrt();
        }
        let both = |i: usize| Both { taut: strains[i], reference: self.strains[i] };
        Comparison {
            ex_pin_pct: Directions { u: both(0), v: both(1), diag: both(2) },
            silhouette_nmse: likeness.silhouette_nmse,
            psnr_db: likeness.psnr_db,
            ssim: likeness.ssim,
            distance_pct: self.stage.distance.then_some(distance),
            finite,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::npz::tests::{f4, npy, write};

    /// The start of a scene as ARCSim writes it: z up, v = 1 at the top, no bump.
    fn start(mesh: &Mesh, name: &str) -> Vec<f32> {
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let place = |[u, v]: [f32; 2]| match name {
            "hang1" => [(u + v - 1.0) * half, 0.0, (v - 1.0 - u) * half],
            "drape" => [u - 0.5, v - 0.5, 0.32],
            _ => [u - 0.5, 0.0, v - 1.0],
        };
        mesh.uv.iter().flat_map(|p| place(*p)).collect()
    }

    #[test]
    fn the_same_start_is_the_same_cloth_in_every_scene() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("a.npz");
        let mesh = Mesh::square(33);
        for name in ["hang2", "edge", "hang1", "drape"] {
            let stage = Stage::named(name).unwrap();
            write(&path, &[("x_final", f4("(1089, 3)", &start(&mesh, name)))]);
            let reference = Reference::load(&path, &mesh, stage).unwrap();
            assert!(
                reference
                    .positions()
                    .iter()
                    .flat_map(|x| stage.place_back(*x))
                    .zip(start(&mesh, name))
                    .all(|(back, x)| (back - x).abs() < 1e-6)
            );
            // taut's start but for its bump
            let (rows, columns) = (16, 20);
            let x: Vec<[f32; 3]> = (0..rows * columns)
                .map(|i| {
                    let (u, v) = ((i % columns) as f32 / 19.0, (i / columns) as f32 / 15.0);
                    let mut x = stage.scene.start(u, v, 1.0, 1.0, 0);
                    x[if stage.scene.is_level() { 1 } else { 2 }] = 0.0;
                    x
                })
                .collect();
            let c = reference.compare(&x, rows, columns, true);
            assert!(c.silhouette_nmse < 1e-6 && c.psnr_db > 80.0 && c.ssim > 0.9999, "{name}: {c:?}");
            assert!(c.ex_pin_pct.diag.taut.p99.abs() < 1e-3 && c.ex_pin_pct.u.reference.mean.abs() < 1e-3, "{name}");
            match c.distance_pct {
                Some(d) => assert!(d < 1e-3 && stage.distance, "{name}: {d}"),
                None => assert!(!stage.distance),
            }
            let own = Reference::of_grid(&mesh, stage, &x, rows, columns).compare(&x, rows, columns, true);
            assert_eq!((own.silhouette_nmse, own.ssim), (0.0, 1.0), "{name}");
            assert!(own.ex_pin_pct.u.taut == own.ex_pin_pct.u.reference && own.distance_pct.is_none_or(|d| d == 0.0));
            // mirrored along v it is another cloth
            let mirrored: Vec<[f32; 3]> = x.iter().map(|[x, y, z]| [*x, -1.0 - y, *z]).collect();
            if stage.distance {
                assert!(reference.compare(&mirrored, rows, columns, true).distance_pct.unwrap() > 50.0);
            }
            let blown = reference.compare(&vec![[f32::NAN; 3]; rows * columns], rows, columns, true);
            assert!(!blown.finite && blown.psnr_db.is_nan() && blown.ex_pin_pct.u.taut.mean.is_nan());
            assert!(blown.ex_pin_pct.u.reference.mean.is_finite());
        }
    }

    #[test]
    fn the_last_frame_counts() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("a.npz");
        let mesh = Mesh::square(33);
        let x = start(&mesh, "edge");
        let longer: Vec<f32> = x.iter().map(|x| 1.01 * x).collect();
        write(&path, &[("x", f4("(2, 1089, 3)", &[x, longer].concat()))]);
        let reference = Reference::load(&path, &mesh, Stage::named("edge").unwrap()).unwrap();
        assert!(reference.strains.iter().all(|s| (s.mean - 1.0).abs() < 1e-3), "{:?}", reference.strains);
    }

    #[test]
    fn trajectories_that_do_not_fit_are_named() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("t.npz");
        let mesh = Mesh::square(5);
        let fails = |arrays: &[(&str, Vec<u8>)], named: &str| {
            write(&path, arrays);
            let e = Reference::load(&path, &mesh, Stage::named("hang2").unwrap()).unwrap_err().to_string();
            assert!(e.contains("t.npz") && e.contains(named), "{e}");
        };
        fails(&[("y", f4("(25, 3)", &[0.0; 75]))], "`x_final`: is not there");
        fails(&[("x_final", f4("(24, 3)", &[0.0; 72]))], "24 vertices, the mesh has 25");
        fails(&[("x_final", f4("(26, 3)", &[0.0; 78]))], "26 vertices, the mesh has 25");
        fails(&[("x_final", f4("(25, 2)", &[0.0; 50]))], "shape [25, 2]");
        fails(&[("x", f4("(25, 3)", &[0.0; 75]))], "`x`: has the shape [25, 3], not [frames, n, 3]");
        fails(&[("x", f4("(0, 25, 3)", &[]))], "shape [0, 25, 3]");
        let mut nan = [0.0; 75];
        nan[7] = f32::NAN;
        fails(&[("x_final", f4("(25, 3)", &nan))], "number 7 is not finite");
        fails(&[("x_final", npy("<i4", "(25, 3)", &[0; 300]))], "float32 or float64");
        assert!(Stage::named("cusick").unwrap_err().contains("hang2, hang1, edge, drape or hang2_res"));
    }
}
