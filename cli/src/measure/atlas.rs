//! `taut measure atlas`: where the cloth stays stable, where it is only bounded, and what is refused.

use std::collections::HashSet;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

use taut_lab::atlas::{Atlas, Class, Finding, MAPS, Variant, run as run_cell};
use taut_lab::ledger::Ledger;
use taut_lab::plot::Figure;

use crate::failure::{self, Failure};
use crate::output::Folder;
use crate::progress::Progress;
use crate::table::aligned;

/// `taut measure atlas`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Every second value of each axis, a short sample, short runs.
    #[arg(long)]
    pub quick: bool,
    /// Only the summary as JSON on stdout; the table goes to stderr.
    #[arg(long)]
    pub json: bool,
    /// Folder for atlas.csv, atlas.json, atlas.png and the rows of a run that was interrupted; made if it is not there.
    #[arg(long, value_name = "DIR", default_value = "out/atlas")]
    pub out: PathBuf,
}

/// Runs the command. A broken cell is a failure, after everything is written.
pub fn run(args: &Args) -> Result<(), Failure> {
    let folder = Folder::open(&args.out, &["atlas.csv", "atlas.json", "atlas.png"])?;
    let mut atlas = Atlas::new(args.quick);
    let rows = args.out.join(if args.quick { "atlas-quick.jsonl" } else { "atlas.jsonl" });
    let mut ledger: Ledger<Finding> = Ledger::open(&rows, &atlas.header()).map_err(Failure::new)?;
    measure(&mut atlas, &mut ledger)?;

    let json = serde_json::to_string_pretty(&atlas.json()).map_err(Failure::new)? + "\n";
    let png = atlas.maps().png().map_err(Failure::new)?;
    let paths = folder.fill(&[atlas.csv().as_bytes(), json.as_bytes(), &png])?;
    let table = table(&atlas);
    if args.json {
        failure::print_aside(&table);
        failure::print(&(serde_json::to_string_pretty(&atlas.summary()).map_err(Failure::new)? + "\n"))?;
    } else {
        let written: String = paths.iter().map(|p| format!("wrote {}\n", p.display())).collect();
        failure::print(&format!("{table}\n{written}"))?;
    }
    let broken = atlas.broken();
    match broken.first() {
        None => Ok(()),
        Some(first) => Err(Failure::new(format_args!("{} cells are broken, the first: {first}", broken.len()))),
    }
}

/// Runs the cells that the ledger does not have, on all cores.
fn measure(atlas: &mut Atlas, ledger: &mut Ledger<Finding>) -> Result<(), Failure> {
    let entries = atlas.entries().to_vec();
    let mut missing: Vec<usize> = Vec::new();
    let mut seen = HashSet::new();
    for (i, entry) in entries.iter().enumerate() {
        let key = entry.cell.key();
        match ledger.get(&key) {
            Some(found) => atlas.add(key, found.clone()),
            // some cells stand in more than one map
            None if seen.insert(key) => missing.push(i),
            None => {}
        }
    }
    let progress = Progress::new(missing.len());
    let (effort, next) = (atlas.effort(), AtomicUsize::new(0));
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            let (send, next, entries, missing) = (send.clone(), &next, &entries, &missing);
            scope.spawn(move || {
                while let Some(i) = missing.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let found = run_cell(&entries[*i].cell, &effort, |_| {});
                    // nobody listens any more after a row that could not be written
                    if send.send((*i, found)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(send);
        for (done, (i, found)) in receive.into_iter().enumerate() {
            let key = entries[i].cell.key();
            ledger.add(&key, found.clone()).map_err(Failure::new)?;
            atlas.add(key, found);
            progress.at(done, entries[i].map, 1.0);
        }
        Ok(())
    })
}

/// How many cells ended in each class: by variant, by map, in all.
fn table(atlas: &Atlas) -> String {
    let row = |name: &str, counts: [usize; 6]| {
        let cells = [counts.iter().sum()].into_iter().chain(counts).map(|n: usize| n.to_string());
        std::iter::once(name.to_string()).chain(cells).collect::<Vec<String>>()
    };
    let header: Vec<&str> = ["cells of", "all"].into_iter().chain(Class::ALL.map(Class::name)).collect();
    let mut rows: Vec<Vec<String>> =
        Variant::ALL.iter().map(|v| row(v.name(), atlas.counts(None, Some(v.name())))).collect();
    rows.extend(MAPS.iter().map(|m| row(m.name, atlas.counts(Some(m.name), None))));
    rows.push(row("sample", atlas.counts(Some("sample"), None)));
    rows.push(row("everything", atlas.counts(None, None)));
    aligned(&header, &rows)
}
