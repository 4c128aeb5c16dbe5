//! `taut correct`: a stiffness field for a game to load.

use serde::Serialize;

use crate::failure::{self, Failure, one_line};
use crate::report::{Generated, Stiffness};
use crate::{args, model, notes, output};

/// What was written, for `--json`.
#[derive(Serialize)]
struct Written<'a> {
    file: String,
    file_bytes: usize,
    scene: &'a str,
    description: &'a str,
    seed: u64,
    /// Rows, columns.
    grid: [u32; 2],
    /// Width (along u), height (along v).
    size_m: [f32; 2],
    generator: Generated,
    known_words: &'a [String],
    unknown_words: &'a [String],
    dropped_words: &'a [String],
}

/// Runs the command.
pub fn run(args: &args::Correct) -> Result<(), Failure> {
    let cloth = &args.cloth;
    let (generator, correction) = model::correct(cloth)?;
    let bytes = correction.to_baked()?;
    output::write(&args.out, &bytes)?;
    let told = Generated::new(generator.info(), &correction);
    if args.json {
        let written = Written {
            file: args.out.display().to_string(),
            file_bytes: bytes.len(),
            scene: cloth.scene.name(),
            description: &cloth.description,
            seed: cloth.seed,
            grid: [cloth.grid.rows, cloth.grid.columns],
            size_m: [cloth.size.width_m, cloth.size.height_m],
            generator: told,
            known_words: &correction.tokens,
            unknown_words: &correction.unknown_words,
            dropped_words: &correction.dropped_words,
        };
        let json = serde_json::to_string_pretty(&written).map_err(Failure::new)?;
        return failure::print(&format!("{json}\n"));
    }
    let Stiffness { warp, weft, shear, bend } = told.median_stiffness_n_per_m;
    let limits = told.stretch_limits;
    let percent = |x: f32| notes::number(100.0 * f64::from(x));
    failure::print(&format!(
        "Fabric              {} (words that count: {})\n\
         Scene               {}, {} x {} particles, {} m x {} m, seed {}\n\
         Stiffness, medians  warp {warp:.1}, weft {weft:.1}, shear {shear:.2}, bend {bend:.3} N/m before the budget\n\
         Density             {:.4} kg/m^2\n\
         Hinge rigidity      {:.2e} N m\n\
         Stretch limits      warp {} %, weft {} %, diagonal {} %\n\
         Wrote {} ({} bytes)\n",
        one_line(&cloth.description),
        correction.tokens.join(", "),
        model::scene_text(cloth.scene),
        cloth.grid.rows,
        cloth.grid.columns,
        cloth.size.width_m,
        cloth.size.height_m,
        cloth.seed,
        told.density_kg_m2,
        told.hinge_rigidity_n_m,
        percent(limits.warp),
        percent(limits.weft),
        percent(limits.diagonal),
        args.out.display(),
        bytes.len(),
    ))
}
