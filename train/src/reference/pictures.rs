//! The cloths side by side.

use taut_lab::npz::Npz;
use taut_lab::picture::{Grid, Panel, Sheet};
use taut_lab::plot::{Axis, Chart, Figure, Mark};
use taut_lab::scene::Scene;

use super::command::CommandError;
use super::run::{Job, Row};
use super::scenes;

/// Fabrics on one sheet.
const FABRICS: usize = 4;

/// Draws the runs of one scene into the folder of their trajectories: `SCENE.png`, or `SCENE-1.png` and so on, and where
/// there are data, `SCENE-strains.png`. A disc is not drawn.
pub fn draw(runs: &[(&Job<'_>, &Row)]) -> Result<(), CommandError> {
    let Some((first, _)) = runs.first() else { return Ok(()) };
    let (scene, out) = (first.scene, first.out);
    if scene == Scene::Cusick {
        return Ok(());
    }
    let beside = runs.iter().any(|(_, row)| row.beside.is_some());
    let sheets: Vec<_> = runs.chunks(FABRICS).collect();
    for (i, chunk) in sheets.iter().enumerate() {
        let mut sheet = Sheet::new(format!("{scene}: the reference cloth{}", if beside { " and ARCSim" } else { "" }))
            .seen_from(if scene.is_level() { 35.0 } else { 10.0 })
            .subtitle(format!("{} x {} vertices, {} s", first.side, first.side, first.seconds()));
        for (job, row) in *chunk {
            let strains = row.ex_pin_pct.map_or([f64::NAN; 6], |s| s.numbers());
            sheet = sheet.panel(panel(job, job.fabric.name, strains, &mine(job)?)?);
            if let (Some(reference), Some(b)) = (job.reference()?, row.beside) {
                sheet = sheet.panel(panel(job, "ARCSim", b.arcsim_ex_pin_pct.numbers(), reference.positions())?);
            }
        }
        let name = if sheets.len() == 1 { format!("{scene}.png") } else { format!("{scene}-{}.png", i + 1) };
        sheet.save(&out.join(name)).map_err(CommandError::part)?;
    }
    if beside {
        let pairs = |at: usize| -> Vec<[f64; 2]> {
            let all = runs.iter().filter_map(|(_, row)| Some((row.ex_pin_pct?, row.beside?.arcsim_ex_pin_pct)));
            all.map(|(mine, theirs)| [theirs.numbers()[at], mine.numbers()[at]]).collect()
        };
        let most = (0..6).flat_map(pairs).flatten().fold(0.02, f64::max);
        let title = format!("{scene}: strain more than 0.1 m from any pin");
        // the legend stands in the upper right corner: the higher axis keeps the points below it
        let axis = |label: &str, room: f64| Axis { range: Some([0.01, room * most]), ..Axis::log(label) };
        let mut chart = Chart::new(&title, axis("ARCSim, %", 1.5), axis("the reference cloth, %", 50.0));
        for (at, name) in ["u mean", "u p99", "v mean", "v p99", "diagonal mean", "diagonal p99"].iter().enumerate() {
            chart = chart.with(name, Mark::Points, pairs(at));
        }
        chart = chart.with("equal", Mark::Line, vec![[0.01, 0.01], [1.5 * most, 1.5 * most]]);
        let path = out.join(format!("{scene}-strains.png"));
        let png = chart.png().map_err(CommandError::part)?;
        std::fs::write(&path, png).map_err(|e| CommandError::Part(format!("cannot write {}: {e}", path.display())))?;
    }
    Ok(())
}

/// The last frame of a run in the lab's axes.
fn mine(job: &Job<'_>) -> Result<Vec<[f32; 3]>, CommandError> {
    let path = job.out.join(format!("{}.npz", job.name()));
    let x = Npz::open(&path).and_then(|mut npz| npz.floats("x_final")).map_err(CommandError::part)?;
    Ok(x.values.as_chunks::<3>().0.iter().map(|p| job.stage().map_or(*p, |s| s.place(*p))).collect())
}

fn panel(job: &Job<'_>, name: &str, strains: [f64; 6], x: &[[f32; 3]]) -> Result<Panel, CommandError> {
    let n = job.side;
    // the renderer counts rows from the top
    let flipped: Vec<[f32; 3]> = (0..n * n).filter_map(|i| x.get((n - 1 - i / n) * n + i % n).copied()).collect();
    let pins: Vec<usize> = (scenes::pins(job.scene, &scenes::sheet(job.scene, n)?, n).iter())
        .map(|p| (n - 1 - p / n) * n + p % n)
        .collect();
    let grid = Grid::new(&flipped, n, n, 1.0, 1.0)
        .and_then(|g| g.with_pins(&pins))
        .map_err(CommandError::part)?
        .with_solid(job.scene.solid(1.0, 1.0));
    let [u, u99, v, v99, ..] = strains;
    Ok(Panel::new(name, grid).line(format!("u {u:.2} / {u99:.2} %")).line(format!("v {v:.2} / {v99:.2} %")))
}
