//! What tethers, strain limit and levels cost beside the plain step, in every vector width, as a table: thread CPU time in
//! ns per particle-step, settings taken in turn, the least of each frame over many rounds, since other programs on the
//! machine only make a frame longer.
//!
//! *Idle*: a sheet that swings on two corners, limits that nothing reaches, 16 substeps a frame. *Fall*: the first second of
//! a level sheet of 1 m that falls on two corners, as stiff as the certified budget lets it be, no speed limit, 4 substeps a frame, limits
//! and slack of 5 %; "one cycle" is a cycle through the levels in each substep that aims at no strain at all, with one sweep over the
//! cloth itself.
//!
//! `taskset -c 1 cargo run --release -p taut-lab --example limits_cost [ms per setting] [sides, e.g. 64,128] [widths]`

use cpu_time::ThreadTime;
use taut::{Budget, Cloth, ClothDef, Features, Grid, GridDef, StepFlags, Width};
use taut_lab::block::Block;

/// A cloth that is stepped through the same frames again and again.
struct Setting {
    cloth: Cloth<'static>,
    start: Vec<u8>,
    /// The least time of each frame in ns.
    least: Vec<f64>,
    steps: f64,
    /// Largest strain at the end of any frame.
    peak: f32,
}

impl Setting {
    fn new(side: u32, (features, cycles): (Features, u32), fall: bool, width: Width) -> Result<Setting, taut::Error> {
        let grid = Grid::new(&GridDef { rows: side, columns: side, ..GridDef::default() })?;
        let limits = match (fall, cycles) {
            (false, _) => [5.0; 3],
            (true, 0) => [0.05; 3],
            (true, _) => [0.0; 3],
        };
        let def = ClothDef {
            features,
            substeps: if fall { 4 } else { 16 },
            budget: if fall { Budget::Certified } else { Budget::Tuned },
            speed_limit: if fall { 0.0 } else { 0.25 },
            tether_slack: limits,
            strain_limit: limits,
            level_cycles: cycles,
            strain_passes: if cycles > 0 { 1 } else { 2 },
            v_axis: if fall { [0.0, 0.0, 1.0] } else { [0.0, -1.0, 0.0] },
            ..ClothDef::default()
        };
        let mut cloth = Cloth::create(&grid, &def, Block::leaked(Cloth::memory(&grid, &def)?))?;
        cloth.set_width(width)?;
        cloth.set_stiffness_uniform(if fall { [1e8; 4] } else { [5000.0, 5000.0, 1500.0, 100.0] })?;
        cloth.pin(0)?;
        cloth.pin(side as usize - 1)?;
        if !fall {
            cloth.step()?;
        }
        let mut start = vec![0; cloth.snapshot_size()];
        cloth.snapshot(&mut start)?;
        let frames = if fall { 60 } else { 8 };
        let steps = f64::from(side * side * def.substeps * frames);
        Ok(Setting { cloth, start, least: vec![f64::INFINITY; frames as usize], steps, peak: 0.0 })
    }

    fn round(&mut self) -> Result<(), taut::Error> {
        self.cloth.restore(&self.start)?;
        for least in &mut self.least {
            let clock = ThreadTime::now();
            assert_eq!(self.cloth.step()?, StepFlags(0));
            *least = least.min(clock.elapsed().as_nanos() as f64);
            self.peak = self.peak.max(self.cloth.strain().largest);
        }
        Ok(())
    }

    fn ns(&self) -> f64 {
        self.least.iter().sum::<f64>() / self.steps
    }
}

fn main() -> Result<(), taut::Error> {
    let mut args = std::env::args().skip(1);
    let ms: u128 = args.next().and_then(|a| a.parse().ok()).unwrap_or(500);
    let sides = args.next().unwrap_or_else(|| "32,64,128,256".into());
    let names = args.next();
    let wanted = |w: &Width| w.is_supported() && names.as_ref().is_none_or(|n| n.split(',').any(|n| n == w.name()));
    let features = [
        (Features::NONE, 0),
        (Features::TETHERS, 0),
        (Features::STRAIN_LIMIT, 0),
        (Features::LEVELS, 0),
        (Features::LEVELS, 1),
    ];
    println!(
        "| width | N | idle: plain | tethers | strain limit | levels | one cycle | fall: plain | tethers | strain limit | levels | one cycle | peaks of these % |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for width in Width::ALL.into_iter().filter(wanted) {
        for side in sides.split(',').filter_map(|n| n.parse::<u32>().ok()) {
            let cases = [false, true].into_iter().flat_map(|fall| features.map(|f| (f, fall)));
            let mut settings =
                cases.map(|(f, fall)| Setting::new(side, f, fall, width)).collect::<Result<Vec<_>, _>>()?;
            let clock = std::time::Instant::now();
            let mut rounds = 0;
            while rounds < 2 || clock.elapsed().as_millis() < ms * settings.len() as u128 {
                settings.iter_mut().try_for_each(Setting::round)?;
                rounds += 1;
            }
            let cells = settings.chunks(features.len()).flat_map(|group| {
                let plain = group[0].ns();
                group.iter().map(move |s| format!("{:.1} ({:.2})", s.ns(), s.ns() / plain))
            });
            let cells: Vec<String> = cells.collect();
            let last = &settings[settings.len() - 2..];
            let peaks: Vec<String> = last.iter().map(|s| format!("{:.1}", 100.0 * s.peak)).collect();
            println!("| {} | {side} | {} | {} |", width.name(), cells.join(" | "), peaks.join(", "));
        }
    }
    Ok(())
}
