//! One run of one fabric in one scene, and what is measured of it.

use std::path::Path;

use serde::{Deserialize, Serialize};
use taut_lab::against::{Mesh, Picture, Reference, Stage, Strain};
use taut_lab::cusick::{DISC_M, Silhouette};
use taut_lab::npz::{self, Npz, Numbers};
use taut_lab::scene::Scene;

use super::command::CommandError;
use super::scenes::{self, STEPS_PER_FRAME, STEPS_PER_S};
use super::{Cloth, Measured, Sheet, V3};

/// A strain in percent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrainPct {
    /// Mean.
    pub mean: f64,
    /// 99th percentile.
    pub p99: f64,
}

impl From<Strain> for StrainPct {
    fn from(s: Strain) -> StrainPct {
        StrainPct { mean: s.mean, p99: s.p99 }
    }
}

/// Strains along u, v and the diagonals of the edges more than 0.1 m from any pin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Strains {
    /// Along u.
    pub u: StrainPct,
    /// Along v.
    pub v: StrainPct,
    /// Along both diagonals.
    pub diag: StrainPct,
}

impl Strains {
    fn of(mesh: &Mesh, x: &[[f32; 3]], pins: &[usize]) -> Strains {
        let [u, v, diag] = mesh.strains(x, pins).map(StrainPct::from);
        Strains { u, v, diag }
    }

    /// Mean and 99th percentile by direction, as they stand in the table.
    pub fn numbers(&self) -> [f64; 6] {
        [self.u.mean, self.u.p99, self.v.mean, self.v.p99, self.diag.mean, self.diag.p99]
    }
}

/// The cloth beside ARCSim's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Beside {
    /// ARCSim's strains.
    pub arcsim_ex_pin_pct: Strains,
    /// Intersection over union of the silhouettes.
    pub silhouette_iou: f64,
    /// NMSE of the silhouettes.
    pub silhouette_nmse: f64,
    /// Root mean square distance of the vertices as a share of the side, where each has its own place at rest.
    pub distance_pct: Option<f64>,
}

/// A run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Scene.
    pub scene: String,
    /// Fabric.
    pub fabric: String,
    /// Simulated time in s.
    pub seconds: f64,
    /// Strains of the last frame; none of a disc.
    pub ex_pin_pct: Option<Strains>,
    /// Root mean square speed of the last frame in m/s.
    pub rms_speed_m_s: f64,
    /// Beside the data, where there are some.
    pub beside: Option<Beside>,
    /// Share of the ring that the disc covers, and the folds of its outline (`cusick`).
    pub drape_coefficient: Option<f64>,
    /// Folds of the outline (`cusick`).
    pub nodes: Option<usize>,
}

/// What to run.
pub struct Job<'a> {
    /// Scene.
    pub scene: Scene,
    /// Fabric.
    pub fabric: &'a Measured,
    /// Vertices along a side.
    pub side: usize,
    /// Seed of the bump, where the data do not give the start.
    pub seed: u64,
    /// Data of other engines: the folder and its mesh.
    pub data: Option<(&'a Path, &'a Mesh)>,
    /// Where the trajectory goes.
    pub out: &'a Path,
}

impl Job<'_> {
    /// Name of the run and of its files.
    pub fn name(&self) -> String {
        format!("{}-{}", self.scene, self.fabric.name)
    }

    /// Simulated time in s.
    pub fn seconds(&self) -> f64 {
        self.stage().map_or(3.0, |s| f64::from(s.seconds))
    }

    /// The scene beside data, where it is one of those.
    pub fn stage(&self) -> Option<Stage> {
        Stage::named(self.scene.name()).ok()
    }

    fn file(&self) -> Option<std::path::PathBuf> {
        let (folder, _) = self.data?;
        self.stage()?;
        Some(folder.join(self.scene.name()).join(format!("{}.npz", self.fabric.name)))
    }

    /// The other engine's run, with its last frame in the lab's axes.
    pub fn reference(&self) -> Result<Option<Reference>, CommandError> {
        match (self.file(), self.data, self.stage()) {
            (Some(path), Some((_, mesh)), Some(stage)) => {
                Ok(Some(Reference::load(&path, mesh, stage).map_err(CommandError::part)?))
            }
            _ => Ok(None),
        }
    }

    /// The first frame of the other engine's run.
    fn first(&self) -> Result<Option<Vec<V3>>, CommandError> {
        let (Some(path), Some(stage)) = (self.file(), self.stage()) else { return Ok(None) };
        let mut npz = Npz::open(&path).map_err(CommandError::part)?;
        let frames = npz.floats("x").map_err(CommandError::part)?;
        let n = self.side * self.side;
        if frames.shape[1..] != [n, 3] || frames.values.len() < 3 * n {
            return Err(CommandError::part(
                npz.wrong("x", format!("has the shape {:?}, not [frames, {n}, 3]", frames.shape)),
            ));
        }
        Ok(Some(frames.values.as_chunks::<3>().0[..n].iter().map(|p| stage.place(*p).map(f64::from)).collect()))
    }

    /// Runs, writes the trajectory and measures. `each` is told the share that is done and ends the run by `false`, which
    /// then answers nothing.
    pub fn run(&self, mut each: impl FnMut(f64) -> bool) -> Result<Option<Row>, CommandError> {
        let material = self.fabric.material()?;
        let mut cloth = scenes::set_up(self.scene, self.side, material, self.first()?, self.seed)?;
        let stage = self.stage();
        let place = |x: V3| {
            let x = x.map(|x| x as f32);
            stage.map_or(x, |s| s.place_back(x))
        };
        let mut frames: Vec<[f32; 3]> = cloth.positions().iter().map(|x| place(*x)).collect();
        let count = (self.seconds() * STEPS_PER_S as f64) as usize / STEPS_PER_FRAME;
        for frame in 0..count {
            for _ in 0..STEPS_PER_FRAME {
                cloth.step(1.0 / STEPS_PER_S as f64)?;
            }
            frames.extend(cloth.positions().iter().map(|x| place(*x)));
            if !each((frame + 1) as f64 / count as f64) {
                return Ok(None);
            }
        }
        let n = cloth.positions().len();
        let last = &frames[count * n..];
        let path = self.out.join(format!("{}.npz", self.name()));
        npz::write(
            &path,
            &[
                ("x", &[count + 1, n, 3], Numbers::Floats(frames.as_flattened())),
                ("x_final", &[n, 3], Numbers::Floats(last.as_flattened())),
            ],
        )
        .map_err(CommandError::part)?;
        Ok(Some(self.measure(&cloth)?))
    }

    fn measure(&self, cloth: &Cloth) -> Result<Row, CommandError> {
        let x: Vec<[f32; 3]> = cloth.positions().iter().map(|x| x.map(|x| x as f32)).collect();
        let sheet = scenes::sheet(self.scene, self.side)?;
        let mut row = Row {
            scene: self.scene.name().into(),
            fabric: self.fabric.name.into(),
            seconds: self.seconds(),
            ex_pin_pct: None,
            rms_speed_m_s: cloth.rms_speed_m_s(),
            beside: None,
            drape_coefficient: None,
            nodes: None,
        };
        if self.scene == Scene::Cusick {
            let silhouette = silhouette(&sheet, cloth.positions());
            row.drape_coefficient = Some(silhouette.drape_coefficient());
            row.nodes = Some(silhouette.nodes());
            return Ok(row);
        }
        let pins = scenes::pins(self.scene, &sheet, self.side);
        let square = Mesh::square(self.side);
        let mesh = self.data.map_or(&square, |(_, mesh)| mesh);
        row.ex_pin_pct = Some(Strains::of(mesh, &x, &pins));
        if let (Some(reference), Some(stage)) = (self.reference()?, self.stage()) {
            let other = reference.positions();
            let [mine, theirs] = [stage.view.picture(mesh, &x), stage.view.picture(mesh, other)];
            let squares = x.as_flattened().iter().zip(other.as_flattened()).map(|(a, b)| f64::from(a - b).powi(2));
            let distance = (squares.sum::<f64>() / x.len() as f64).sqrt();
            row.beside = Some(Beside {
                arcsim_ex_pin_pct: Strains::of(mesh, other, &pins),
                silhouette_iou: overlap(&mine, &theirs),
                silhouette_nmse: mine.likeness(&theirs).silhouette_nmse,
                distance_pct: matches!(self.scene, Scene::Hang2 | Scene::Edge).then_some(100.0 * distance),
            });
        }
        Ok(row)
    }
}

/// Intersection over union.
fn overlap(a: &Picture, b: &Picture) -> f64 {
    let pairs = || a.silhouette.iter().zip(&b.silhouette);
    pairs().map(|(a, b)| a.min(*b)).sum::<f64>() / pairs().map(|(a, b)| a.max(*b)).sum::<f64>()
}

/// What the camera of the test of Cusick sees of the disc.
fn silhouette(sheet: &Sheet, x: &[V3]) -> Silhouette {
    let radius = f64::from(DISC_M);
    Silhouette::of_disc(|right, down| {
        // the triangle of the rest shape that holds the place, or the one that is nearest to do so
        let at = [f64::from(right), -f64::from(down)];
        let weights = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| sheet.uv[i]);
            let area =
                |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
            let all = area(a, b, c);
            [area(at, b, c) / all, area(a, at, c) / all, area(a, b, at) / all]
        };
        let least = |t: &[usize; 3]| weights(t).into_iter().fold(f64::INFINITY, f64::min);
        let best = sheet.triangles.iter().max_by(|s, t| least(s).total_cmp(&least(t)));
        let Some(t) = best else { return [0.0; 3] };
        let w = weights(t);
        let place: V3 = std::array::from_fn(|axis| (0..3).map(|i| w[i] * x[t[i]][axis]).sum());
        [(place[0] - radius) as f32, place[1] as f32, (place[2] - radius) as f32]
    })
}
