//! How the program is linked: without any start files or libraries, at fixed addresses.

use std::env::var;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=cortex_m.ld");
    let folder = var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let target = var("TARGET").unwrap_or_default();
    // not position independent: there is no loader that could relocate it
    let arguments: &[&str] = match target.split('-').next() {
        Some("x86_64") => &["-nostartfiles", "-nostdlib", "-static", "-no-pie"],
        Some("i686") => &["-static", "--no-pie"],
        Some("wasm32") => &["--no-entry", "--export=run"],
        Some("thumbv7em") => &[&format!("-T{folder}/cortex_m.ld")],
        _ => &[],
    };
    for argument in arguments {
        println!("cargo::rustc-link-arg-bins={argument}");
    }
}
