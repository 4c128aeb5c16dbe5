//! All of it in one.

use serde::Serialize;
use taut::{Error, Solver};

use super::{Drape, Jitter, Kind, Mesh, Order, Precision, Smooth, Swing};
use super::{drapes, jitter, mesh, order, precision, swings};
use crate::scene::Scene;

/// Everything that was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Drapes at every rate.
    pub drapes: Vec<Drape>,
    /// Swings at every rate.
    pub swings: Vec<Swing>,
    /// States under frame times that jitter.
    pub jitter: Vec<Jitter>,
    /// Orders of the solvers.
    pub orders: Vec<Order>,
    /// Convergence of the mesh.
    pub mesh: Vec<Mesh>,
    /// f32 beside f64.
    pub precision: Vec<Precision>,
}

/// Parts that [`report`] tells of.
pub const PARTS: [&str; 6] = ["drapes", "swings", "jitter", "orders", "mesh", "precision"];

/// Measures everything. `progress` is called with the number of the part and the share of it that is done.
pub fn report(mut progress: impl FnMut(usize, f32)) -> Result<Report, Error> {
    let mut all = Report {
        drapes: Vec::new(),
        swings: Vec::new(),
        jitter: Vec::new(),
        orders: Vec::new(),
        mesh: Vec::new(),
        precision: Vec::new(),
    };
    let kinds = Kind::ALL.len() as f32;
    for (i, kind) in Kind::ALL.into_iter().enumerate() {
        progress(0, i as f32 / kinds);
        for scene in [Scene::Hang2, Scene::Edge] {
            all.drapes.extend(drapes(scene, kind)?);
        }
    }
    for (i, kind) in Kind::ALL.into_iter().enumerate() {
        progress(1, i as f32 / kinds);
        all.swings.extend(swings(kind)?);
    }
    progress(2, 0.0);
    all.jitter = jitter(600)?;
    for (i, scene) in Smooth::ALL.into_iter().enumerate() {
        progress(3, i as f32 / 3.0);
        for solver in [Solver::SymplecticEuler, Solver::ImplicitEuler, Solver::Bdf2] {
            all.orders.push(order(scene, solver)?);
        }
    }
    progress(4, 0.0);
    all.mesh = mesh(&[16, 32, 64, 128])?;
    for (i, (scene, side)) in
        [(Scene::Hang2, 16), (Scene::Edge, 16), (Scene::Hang2, 32), (Scene::Edge, 32)].into_iter().enumerate()
    {
        progress(5, i as f32 / 4.0);
        all.precision.push(precision(scene, side, 10.0)?);
    }
    progress(5, 1.0);
    Ok(all)
}
