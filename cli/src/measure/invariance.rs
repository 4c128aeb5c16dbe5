//! `taut measure invariance`: what must not depend on how it is computed.

use std::path::PathBuf;

use taut_lab::invariance::{PARTS, Report, report};

use crate::failure::{self, Failure};
use crate::output::Folder;
use crate::progress::Progress;
use crate::table::aligned;

/// `taut measure invariance`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Only the report as JSON on stdout; the tables go to stderr.
    #[arg(long)]
    pub json: bool,
    /// Folder for invariance.json; made if it is not there.
    #[arg(long, value_name = "DIR", default_value = "out/invariance")]
    pub out: PathBuf,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let folder = Folder::open(&args.out, &["invariance.json"])?;
    let progress = Progress::new(PARTS.len());
    let report = report(|part, share| progress.at(part, PARTS[part], share)).map_err(Failure::new)?;
    drop(progress);
    let json = serde_json::to_string_pretty(&report).map_err(Failure::new)? + "\n";
    let paths = folder.fill(&[json.as_bytes()])?;
    let tables = tables(&report);
    if args.json {
        failure::print_aside(&tables);
        return failure::print(&json);
    }
    let written: String = paths.iter().map(|p| format!("wrote {}\n", p.display())).collect();
    failure::print(&format!("{tables}\n{written}"))
}

fn tables(r: &Report) -> String {
    let drapes: Vec<Vec<String>> = r
        .drapes
        .iter()
        .map(|d| {
            vec![
                format!("{} {}", d.scene, d.kind.name()),
                format!("{} x {}", d.rate_hz, d.substeps),
                format!("{:.1}", 100.0 * d.cut_fraction),
                format!("{:.2}", d.strain_pct),
                format!("{:.4}", d.from_240_hz_pct),
                format!("{:.1e}", d.rms_speed_m_s),
            ]
        })
        .collect();
    let swings: Vec<Vec<String>> = r
        .swings
        .iter()
        .map(|s| {
            vec![
                s.kind.name().into(),
                format!("{}", s.rate_hz),
                format!("{:.4}", s.period_s),
                format!("{:.4}", s.chain_s),
                format!("{:.4}", s.fall_s),
            ]
        })
        .collect();
    let jitter: Vec<Vec<String>> = r
        .jitter
        .iter()
        .map(|j| vec![j.frames.clone(), j.rendered.to_string(), j.steps.to_string(), j.state_hash.clone()])
        .collect();
    let orders: Vec<Vec<String>> = r
        .orders
        .iter()
        .map(|o| {
            let measured: Vec<String> = o.orders.iter().map(|p| format!("{p:.3}")).collect();
            vec![
                format!("{} {}", o.scene.name(), o.solver),
                format!("{:.2}", o.coarsest_dt_ms),
                measured.join(" "),
                format!("{}", o.expected),
            ]
        })
        .collect();
    let mesh: Vec<Vec<String>> = r
        .mesh
        .iter()
        .map(|m| {
            vec![
                format!("{0} x {0}", m.side),
                format!("{:.4}", m.mean_strain_pct),
                format!("{:.4}", m.continuum_mean_pct),
                format!("{:.2}", 100.0 * m.error),
                m.order.map_or(String::new(), |o| format!("{o:.3}")),
            ]
        })
        .collect();
    let precision: Vec<Vec<String>> = r
        .precision
        .iter()
        .map(|p| {
            vec![
                format!("{} {1} x {1}", p.scene, p.side),
                format!("{:.1e}", p.position_peak_m),
                format!("{:.1e}", p.position_end_m),
                format!("{:.1e}", p.strain_peak_pct),
                format!("{:.1e}", p.strain_end_pct),
                format!("{:.2}", p.largest_strain_pct),
            ]
        })
        .collect();
    [
        aligned(&["drape", "Hz x substeps", "K cut %", "strain %", "from 240 Hz, % of side", "m/s"], &drapes),
        aligned(&["swing", "Hz", "period s", "chain s", "fall s"], &swings),
        aligned(&["frame times", "rendered", "steps", "state"], &jitter),
        aligned(&["solver", "coarsest dt ms", "order, halving dt", "theory"], &orders),
        aligned(&["mesh", "mean strain %", "continuum %", "error %", "order"], &mesh),
        aligned(&["f32 - f64", "peak m", "end m", "peak strain %", "end strain %", "of strain %"], &precision),
    ]
    .join("\n")
}
