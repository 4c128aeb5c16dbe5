//! Ctrl-C, and a reader that goes away.

use std::io::Read;
use std::process::{Command, Stdio};

use crate::run::{entries, home};

/// Sends the signal of Ctrl-C once the folder is there, which is before the long simulation.
#[cfg(unix)]
#[test]
fn an_interrupt_leaves_nothing() {
    use std::time::{Duration, Instant};
    let home = home();
    let mut child = Command::new(env!("CARGO_BIN_EXE_taut"))
        .args(["drape", "denim", "--grid", "64x64", "--seconds", "3600", "--out", "a/b"])
        .current_dir(home.path())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let start = Instant::now();
    while !home.path().join("a/b").exists() {
        if start.elapsed() > Duration::from_secs(120) {
            let _ = child.kill();
            panic!("the folder is not made");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("kill runs").success());
    let status = child.wait().expect("it ends");
    assert_eq!(status.code(), Some(130));
    let mut stderr = String::new();
    child.stderr.take().expect("piped").read_to_string(&mut stderr).expect("UTF-8");
    assert_eq!(stderr, "taut: interrupted\n");
    assert!(entries(home.path()).is_empty());
}

/// The rows that were measured before Ctrl-C are whole, and belong to the same measurement.
#[cfg(unix)]
#[test]
fn an_interrupted_measurement_keeps_its_rows() {
    use std::time::{Duration, Instant};
    use taut_lab::atlas::{Atlas, Finding};
    use taut_lab::ledger::Ledger;
    let home = home();
    let rows = home.path().join("a/atlas-quick.jsonl");
    let mut child = Command::new(env!("CARGO_BIN_EXE_taut"))
        .args(["measure", "atlas", "--quick", "--out", "a"])
        .current_dir(home.path())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let lines = || std::fs::read(&rows).map_or(0, |bytes| bytes.iter().filter(|b| **b == b'\n').count());
    let start = Instant::now();
    while lines() < 20 {
        if start.elapsed() > Duration::from_secs(120) {
            let _ = child.kill();
            panic!("no rows");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("kill runs").success());
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    let mut stderr = String::new();
    child.stderr.take().expect("piped").read_to_string(&mut stderr).expect("UTF-8");
    assert_eq!(stderr, "taut: interrupted\n");
    assert_eq!(entries(&home.path().join("a")), ["atlas-quick.jsonl"]);
    let atlas = Atlas::new(true);
    let ledger: Ledger<Finding> = Ledger::open(&rows, &atlas.header()).expect("the same measurement");
    assert!(ledger.len() >= 19, "{} rows", ledger.len());
    assert!(ledger.get(&atlas.entries()[0].cell.key()).is_some());
}

#[test]
fn a_closed_pipe_is_no_error() {
    let home = home();
    let mut child = Command::new(env!("CARGO_BIN_EXE_taut"))
        .args(["info", "--json"])
        .current_dir(home.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    let status = child.wait().expect("it ends");
    let mut stderr = String::new();
    child.stderr.take().expect("piped").read_to_string(&mut stderr).expect("UTF-8");
    assert_eq!((status.code(), stderr.as_str()), (Some(0), ""));
}
