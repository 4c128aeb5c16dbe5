//! How the program is linked: without any start files or libraries, at fixed addresses.

use std::env::var;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=cortex_m.ld");
    let linux = var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux");
    let folder = var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let arguments = if linux {
        // not position independent: there is no loader that could relocate it
        ["-nostartfiles", "-nostdlib", "-static", "-no-pie"].map(String::from).to_vec()
    } else {
        vec![format!("-T{folder}/cortex_m.ld")]
    };
    for argument in arguments {
        println!("cargo::rustc-link-arg-bins={argument}");
    }
}
