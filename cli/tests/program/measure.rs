//! `taut measure against` and `taut measure cusick` on small files that the tests make.

use std::fs;
use std::io::Write;
use std::path::Path;

use crate::run::{entries, home, refuses, succeeds};

/// Writes an `.npz` file of arrays of type, shape and bytes.
fn npz(path: &Path, arrays: &[(&str, &str, &str, Vec<u8>)]) {
    let mut zip = zip::ZipWriter::new(fs::File::create(path).expect("made"));
    for (name, kind, shape, data) in arrays {
        let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
        while (header.len() + 11) % 64 != 0 {
            header.push(' ');
        }
        header.push('\n');
        zip.start_file(format!("{name}.npy"), zip::write::FileOptions::default()).expect("started");
        zip.write_all(b"\x93NUMPY\x01\x00").expect("written");
        zip.write_all(&(header.len() as u16).to_le_bytes()).expect("written");
        zip.write_all(header.as_bytes()).expect("written");
        zip.write_all(data).expect("written");
    }
    zip.finish().expect("finished");
}

fn bytes(values: impl IntoIterator<Item = f32>) -> Vec<u8> {
    values.into_iter().flat_map(f32::to_le_bytes).collect()
}

/// A mesh of 5 x 5 vertices and the sheet of hang2 at rest, z up.
fn write_reference(folder: &Path) -> Vec<f32> {
    let share = |i: usize| i as f32 / 4.0;
    let uv = bytes((0..25).flat_map(|i| [share(i % 5), share(i / 5)]));
    let cells = (0..16).map(|i| i / 4 * 5 + i % 4);
    let triangles = cells.flat_map(|a| [a, a + 1, a + 6, a, a + 6, a + 5]);
    let triangles: Vec<u8> = triangles.flat_map(|v: i32| v.to_le_bytes()).collect();
    npz(&folder.join("mesh.npz"), &[("uv", "<f4", "(25, 2)", uv), ("tris", "<i4", "(32, 3)", triangles)]);
    let x: Vec<f32> = (0..25).flat_map(|i| [share(i % 5) - 0.5, 0.0, share(i / 5) - 1.0]).collect();
    npz(&folder.join("flat.npz"), &[("x_final", "<f4", "(25, 3)", bytes(x.clone()))]);
    x
}

const AGAINST: [&str; 14] = [
    "measure",
    "against",
    "--mesh",
    "mesh.npz",
    "--scene",
    "hang2",
    "--describe",
    "denim",
    "--density",
    "0.3",
    "--grid",
    "9x9",
    "--seconds",
    "0.05",
];

#[test]
fn a_trajectory_is_compared_with_every_setting() {
    let home = home();
    write_reference(home.path());
    let run = succeeds(home.path(), &[&AGAINST[..], &["--reference", "flat.npz", "--json", "out.json"]].concat());
    let names = [
        "random",
        "uniform",
        "analytic",
        "uniform_inertia",
        "analytic_inertia",
        "ratios_inertia",
        "generated",
        "uniform_limits",
        "analytic_limits",
        "ratios_limits",
        "generated_limits",
        "generated_limits_where_cut",
    ];
    assert!(names.iter().all(|n| run.stdout.contains(n)) && run.stdout.contains("the trajectory"), "{}", run.stdout);
    let json = fs::read_to_string(home.path().join("out.json")).expect("written");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let settings = json["settings"].as_object().expect("settings");
    assert_eq!(settings.len(), names.len());
    for name in names {
        let s = &settings[name];
        assert_eq!(s["finite"], true, "{name}");
        for direction in ["u", "v", "diag"] {
            let e = &s["ex_pin_pct"][direction];
            assert!(e["reference"]["mean"].as_f64().expect("a number").abs() < 1e-3);
            assert!(e["reference"]["p99"].is_number() && e["taut"]["mean"].is_number() && e["taut"]["p99"].is_number());
        }
        // after 50 ms it has hardly moved: 1.2 cm at most
        let distance = s["distance_pct"].as_f64().expect("hang2 has distances");
        assert!((0.01..2.0).contains(&distance), "{name}: {distance}");
        assert!(s["silhouette_nmse"].as_f64().expect("a number") < 0.05 && s["ssim"].as_f64().expect("a number") > 0.8);
        assert!(s["psnr_db"].as_f64().expect("a number") > 20.0);
    }
}

#[test]
fn what_cannot_be_compared_is_named() {
    let home = home();
    let x = write_reference(home.path());
    let mut nan = x.clone();
    nan[4] = f32::NAN;
    npz(&home.path().join("nan.npz"), &[("x_final", "<f4", "(25, 3)", bytes(nan))]);
    npz(&home.path().join("more.npz"), &[("x_final", "<f4", "(26, 3)", bytes((0..78).map(|_| 0.0)))]);
    npz(&home.path().join("other.npz"), &[("y", "<f4", "(25, 3)", bytes(x))]);
    let flat = fs::read(home.path().join("flat.npz")).expect("read");
    fs::write(home.path().join("cut.npz"), &flat[..flat.len() / 2]).expect("written");
    let before = entries(home.path());
    for (file, named) in [
        ("nan.npz", "`x_final`: number 4 is not finite"),
        ("more.npz", "`x_final`: has 26 vertices, the mesh has 25"),
        ("other.npz", "`x_final`: is not there"),
        ("cut.npz", "no .npz file"),
        ("missing.npz", "cannot be read"),
    ] {
        let line = refuses(home.path(), &[&AGAINST[..], &["--reference", file, "--json", "out.json"]].concat());
        assert!(line.contains(file) && line.contains(named), "{line}");
    }
    let line = refuses(home.path(), &["measure", "against", "--reference", "flat.npz", "--scene", "moon"]);
    assert!(line.contains("hang2, hang1, edge, drape or hang2_res"), "{line}");
    let line = refuses(home.path(), &["measure", "against", "--reference", "flat.npz"]);
    assert!(line.contains("--mesh") && line.contains("--density"), "{line}");
    let line = refuses(home.path(), &["measure", "against", "--folder", "."]);
    assert!(line.contains("no SCENE/FABRIC.npz"), "{line}");
    assert_eq!(entries(home.path()), before);
}

#[test]
fn a_folder_goes_on_where_it_was_interrupted() {
    let home = home();
    write_reference(home.path());
    fs::create_dir(home.path().join("hang2")).expect("made");
    fs::rename(home.path().join("flat.npz"), home.path().join("hang2/blue-denim.npz")).expect("moved");
    let materials = r#"{"fabrics": {"blue-denim": {"use": "jeans", "fibre": "100% cotton", "density_kg_m2": 0.3}}}"#;
    fs::write(home.path().join("materials.json"), materials).expect("written");
    let args = ["measure", "against", "--folder", ".", "--grid", "9x9", "--seconds", "0.05", "--json", "all.json"];
    let first = succeeds(home.path(), &args);
    assert!(first.stdout.contains("hang2, 1 fabrics") && first.stderr.contains("hang2/blue-denim.npz"));
    let whole = fs::read(home.path().join("all.json")).expect("written");
    let again = succeeds(home.path(), &args);
    assert!(again.stdout == first.stdout && !again.stderr.contains("blue-denim"), "{}", again.stderr);
    let json: serde_json::Value = serde_json::from_slice(&whole).expect("JSON");
    let later = fs::read(home.path().join("all.json")).expect("written");
    assert!(same(&json, &serde_json::from_slice(&later).expect("JSON")), "{}", String::from_utf8_lossy(&later));
    assert_eq!(json["runs"][0]["description"], "jeans blue denim cotton");
    assert!(json["mean_errors"]["hang2"]["generated_limits"]["mean_points"][0].is_number());
}

/// Whether two values are the same but for the last digits of their numbers, which go through a file of text.
fn same(a: &serde_json::Value, b: &serde_json::Value) -> bool {
    use serde_json::Value::{Array, Number, Object};
    match (a, b) {
        (Array(a), Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        (Object(a), Object(b)) => a.len() == b.len() && a.iter().all(|(k, v)| b.get(k).is_some_and(|w| same(v, w))),
        (Number(a), Number(b)) => {
            let (a, b) = (a.as_f64().unwrap_or(f64::NAN), b.as_f64().unwrap_or(f64::NAN));
            (a - b).abs() <= 1e-12 * a.abs()
        }
        _ => a == b,
    }
}

/// Writes pictures of a disc of so many pixels of radius.
fn write_photos(folder: &Path, samples: usize, radius: f32) {
    fs::create_dir_all(folder).expect("made");
    let inside = |i: usize| ((i % 256) as f32 - 127.5).hypot((i / 256) as f32 - 127.5) < radius;
    let pixels: Vec<u8> = (0..256 * 256).map(|i| if inside(i) { 255 } else { 0 }).collect();
    for sample in 1..=samples {
        let path = folder.join(format!("sample-0{sample}-capture-1.png"));
        image::save_buffer(path, &pixels, 256, 256, image::ColorType::L8).expect("written");
    }
}

#[test]
fn discs_are_compared_with_pictures() {
    let home = home();
    write_photos(&home.path().join("photos"), 1, 90.0);
    let args =
        ["measure", "cusick", "--describe", "denim", "--density", "0.3", "--silhouettes", "photos", "--side", "17"];
    let run = succeeds(home.path(), &[&args[..], &["--drapes", "2", "--json", "out.json"]].concat());
    assert!(run.stdout.contains("taut") && run.stdout.contains("real") && run.stdout.contains("from the words"));
    let json = fs::read_to_string(home.path().join("out.json")).expect("written");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let dc = &json["drape_coefficient"];
    // (90^2 - 64.4^2) / (107.4^2 - 64.4^2) in pixels
    assert!((dc["real_mean"].as_f64().expect("a number") - 0.534).abs() < 0.005, "{dc}");
    assert_eq!((dc["real_std"].as_f64(), json["nodes"]["real_mean"].as_f64()), (Some(0.0), Some(0.0)));
    assert!((0.0..1.0).contains(&dc["taut_mean"].as_f64().expect("a number")), "{dc}");
    assert!(dc["taut_std"].as_f64().expect("a number") > 0.0 && json["nodes"]["taut_mean"].is_number());

    let line = refuses(home.path(), &[&args[..], &["--fit"]].concat());
    assert!(line.contains("photos") && line.contains("two samples"), "{line}");
    let line = refuses(home.path(), &[&args[..], &["--fit", "--rigidity", "1e-5"]].concat());
    assert!(line.contains("--rigidity"), "{line}");
    fs::write(home.path().join("photos/bad.png"), "no picture").expect("written");
    let line = refuses(home.path(), &args);
    assert!(line.contains("bad.png") && line.contains("no picture"), "{line}");
}
