//! `taut drape`: the same scene with seven choices of stiffness.

use taut::ClothDef;
use taut_lab::compare::{self, Case, Outcome, Setting};
use taut_lab::fabric::{Fabric, rigidity_at};
use taut_onnx::Correction;

use crate::failure::{self, Failure, complain};
use crate::measure::fabric_of;
use crate::notes;
use crate::output::Folder;
use crate::progress::Progress;
use crate::report::Report;
use crate::{args, model, numbers, picture};

/// Files of a comparison, in the order in which they are written.
const FILES: [&str; 2] = ["drape.png", "report.json"];

/// Runs the command.
pub fn run(args: &args::Drape) -> Result<(), Failure> {
    let (generator, correction) = model::correct(&args.cloth)?;
    let case = case(&args.cloth, &args.step, args.seconds, &correction)?;
    let reference = fabric_of(&correction);
    let folder = Folder::open(&args.out, &FILES)?;
    let outcomes = simulate(&case, &reference, &correction)?;

    let report = Report::new(&case, &reference, generator.info(), &correction, &outcomes);
    let png = picture::png(&report, case.scene, &outcomes)?;
    let json = serde_json::to_string_pretty(&report).map_err(Failure::new)? + "\n";
    let paths = folder.fill(&[&png, json.as_bytes()])?;

    let mut text = format!("{}: {}\n\n", failure::one_line(&report.description), notes::setup(&report));
    text.push_str(&notes::table(&report));
    text.push('\n');
    for note in notes::notes(&report) {
        text.push_str(&format!("{note}\n"));
    }
    for path in paths {
        text.push_str(&format!("Wrote {}\n", path.display()));
    }
    failure::answer(args.json, &text, &json)
}

/// What all settings share. Everything that core would refuse later is refused here.
pub fn case(cloth: &args::Cloth, step: &args::Step, seconds: f32, correction: &Correction) -> Result<Case, Failure> {
    let density_kg_m2 = match step.density {
        Some(density) => density,
        None => {
            let told = correction.density_kg_m2;
            numbers::density(&told.to_string()).map_err(|e| {
                Failure::new(format_args!(
                    "the generator tells a density of {told} kg/m^2, which {e}: give one with --density"
                ))
            })?
        }
    };
    let def = ClothDef { rate_hz: step.rate, substeps: step.substeps, density_kg_m2, ..ClothDef::default() };
    def.check().map_err(|e| {
        Failure::new(format_args!("{} Hz x {} substeps is a step of {} s: {e}", step.rate, step.substeps, def.dt_s()))
    })?;
    Ok(Case {
        scene: cloth.scene,
        rows: cloth.grid.rows,
        columns: cloth.grid.columns,
        size_m: [cloth.size.width_m, cloth.size.height_m],
        rate_hz: step.rate,
        substeps: step.substeps,
        budget: step.budget,
        density_kg_m2,
        seconds,
        hinge_rigidity_n_m: rigidity_at(correction.hinge_rigidity_n_m, correction.density_kg_m2, density_kg_m2),
        seed: cloth.seed,
    })
}

fn simulate(case: &Case, reference: &Fabric, c: &Correction) -> Result<Vec<Outcome>, Failure> {
    let settings = [
        Setting::Reference(reference.clone()),
        Setting::Random,
        Setting::Uniform,
        Setting::Analytic(reference.clone()),
        Setting::UniformInertia,
        Setting::AnalyticInertia(reference.clone()),
        Setting::Generated(c.field.iter().copied().collect()),
    ];
    let progress = Progress::new(settings.len());
    let mut outcomes = Vec::with_capacity(settings.len());
    for (i, setting) in settings.iter().enumerate() {
        let name = setting.name();
        let outcome = compare::run(case, setting, |share| progress.at(i, name, share))
            .map_err(|e| Failure::new(format_args!("the setting {name} cannot run: {e}")))?;
        outcomes.push(outcome);
    }
    drop(progress);
    if let Some(o) = outcomes.iter().find(|o| o.name == "reference" && !o.finite) {
        complain(&format!("warning: the reference itself blew up at {} substeps", o.substeps));
    }
    Ok(outcomes)
}
