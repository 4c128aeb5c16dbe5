//! `taut measure scenes`: the scenes by name.

use taut_lab::scene::Scene;

use crate::failure::{self, Failure};
use crate::table::aligned;

/// `taut measure scenes`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// As JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    if args.json {
        let scenes =
            Scene::ALL.map(|s| serde_json::json!({ "scene": s.name(), "about": s.about(), "rests": s.rests() }));
        return failure::print(&(serde_json::to_string_pretty(&scenes).map_err(Failure::new)? + "\n"));
    }
    let rows: Vec<Vec<String>> = Scene::ALL.iter().map(|s| vec![s.name().into(), s.about().into()]).collect();
    failure::print(&aligned(&["scene", "what it is"], &rows))
}
