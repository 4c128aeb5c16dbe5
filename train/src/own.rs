//! One's own fabric: what tension tests of it say of its constants, for [`crate::gan::TrainConfig::own`].
//!
//! A strip is pulled along the warp, the weft and the bias (45 degrees), free to narrow. With the stiffness matrix of the
//! lattice, C11 (weft), C22 (warp) and C12 = C66 = s (`taut_lab::fabric`), a strip has the moduli C22 - s^2/C11 and C11 - s^2/C22,
//! and on the bias 4/(S11 + S22 + 2 S12 + 1/s), S being the inverse of C. These three are solved for C11, C22 and s.

use std::fmt;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::{Deserialize, Serialize};
use taut_lab::fabric::{Fabric, RIGIDITY_EXPONENT, rigidity_at};

use crate::files::write_whole;
use crate::gan::TrainConfig;

/// Columns of the file.
const COLUMNS: [&str; 5] = ["strain", "warp_n_per_m", "weft_n_per_m", "bias_n_per_m", "mass_kg_per_m2"];

/// Fewest rows, and the largest strain that is taken.
const LEAST_ROWS: usize = 3;
const MOST_STRAIN: f64 = 0.5;

/// Strains up to this share of the largest tell the stiffness at small strain.
const SMALL: f64 = 0.34;

const GRAVITY_M_S2: f64 = 9.81;

/// The constants of one's own fabric from a CSV of tension tests.
#[derive(Debug, Args)]
pub struct FabricArgs {
    /// The tests: columns strain, warp_n_per_m, weft_n_per_m, bias_n_per_m (force over the width), mass_kg_per_m2
    #[arg(long)]
    pub csv: PathBuf,
    /// How the fabric will be described, in words that the word table knows
    #[arg(long)]
    pub words: String,
    /// Its bending length in m (Peirce 1930); without it the rigidity is that of what the words name at this mass
    #[arg(long)]
    pub bending_length_m: Option<f64>,
    /// Configuration of `taut-train run` to write; one that is there keeps its values and gets the fabric added
    #[arg(long)]
    pub out: PathBuf,
}

/// A fabric of one's own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OwnFabric {
    /// How it is described.
    pub words: String,
    /// Warp, weft, shear, bend in N/m, as [`Fabric`] has them.
    pub stiffness_n_per_m: [f32; 4],
    /// Mass per area in kg/m^2.
    pub density_kg_m2: f32,
    /// Bending rigidity in N m.
    pub hinge_rigidity_n_m: f32,
    /// Stiffness at small strain over that above, of warp and weft, above 0 and at most 1.
    pub softness: [f32; 2],
}

/// What is wrong with tests or constants.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnError(String);

impl fmt::Display for OwnError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for OwnError {}

fn wrong<T>(what: impl Into<String>) -> Result<T, OwnError> {
    Err(OwnError(what.into()))
}

/// Writes the constants into a configuration.
///
/// # Errors
/// [`OwnError`] names the file, the line or the number.
pub fn run(args: &FabricArgs) -> Result<(), OwnError> {
    let file = |path: &Path, e: &dyn fmt::Display| OwnError(format!("{}: {e}", path.display()));
    let text = std::fs::read_to_string(&args.csv).map_err(|e| file(&args.csv, &e))?;
    let tests = Tests::parse(&text).map_err(|e| file(&args.csv, &e))?;
    let fabric = tests.fabric(&args.words, args.bending_length_m).map_err(|e| file(&args.csv, &e))?;
    let mut config = match std::fs::read_to_string(&args.out) {
        Ok(text) => serde_json::from_str(&text).map_err(|e| file(&args.out, &e))?,
        Err(e) if e.kind() == ErrorKind::NotFound => TrainConfig::default(),
        Err(e) => return Err(file(&args.out, &e)),
    };
    config.own.retain(|own| own.words != fabric.words);
    config.own.push(fabric.clone());
    let json = |e: serde_json::Error| file(&args.out, &e);
    let text = serde_json::to_string_pretty(&config).map_err(json)?;
    write_whole(&args.out, text.as_bytes()).map_err(|e| file(&args.out, &e))?;
    let [warp, weft, diagonal] = fabric.fabric().stretch_limits().map(|l| 100.0 * l);
    println!("{}", serde_json::to_string_pretty(&fabric).map_err(json)?);
    println!("limits in percent: warp {warp:.2}, weft {weft:.2}, diagonal {diagonal:.2}");
    println!("taut-train run --config {} --out DIR", args.out.display());
    Ok(())
}

impl OwnFabric {
    /// Names the first number that is out of range.
    pub fn check(&self) -> Result<(), OwnError> {
        let [warp, weft, shear, bend] = self.stiffness_n_per_m;
        for (what, value, low, high) in [
            ("warp stiffness in N/m", warp, 1.0, 1e6),
            ("weft stiffness in N/m", weft, 1.0, 1e6),
            ("shear stiffness in N/m", shear, 0.01, 1e6),
            ("bend stiffness in N/m", bend, 1e-6, 1e4),
            ("mass in kg/m^2", self.density_kg_m2, 0.005, 5.0),
            ("bending rigidity in N m", self.hinge_rigidity_n_m, 1e-8, 1.0),
            ("softness of the warp", self.softness[0], 1e-3, 1.0),
            ("softness of the weft", self.softness[1], 1e-3, 1.0),
        ] {
            if !(low..=high).contains(&value) {
                return wrong(format!("{what} of `{}` is {value}, not {low} to {high}", self.words));
            }
        }
        Ok(())
    }

    /// As the lab has it.
    pub fn fabric(&self) -> Fabric {
        Fabric {
            kind: "own",
            stiffness: self.stiffness_n_per_m,
            density_kg_m2: self.density_kg_m2,
            hinge_rigidity_n_m: self.hinge_rigidity_n_m,
            measured: true,
            softness: self.softness,
        }
    }
}

/// Tension tests of one fabric.
#[derive(Clone, Debug, PartialEq)]
pub struct Tests {
    /// Strain, then force over width in N/m along warp, weft, bias.
    rows: Vec<[f64; 4]>,
    mass_kg_m2: f64,
}

impl Tests {
    /// Reads a CSV with a head line; lines that begin with # are left out. Errors: columns, numbers, ranges, by line.
    pub fn parse(text: &str) -> Result<Tests, OwnError> {
        let mut lines = (text.lines().enumerate()).filter(|(_, l)| !l.trim().is_empty() && !l.starts_with('#'));
        let (_, head) = lines.next().ok_or_else(|| OwnError("holds no line".into()))?;
        let names: Vec<&str> = head.split(',').map(str::trim).collect();
        let mut places = [0; 5];
        for (place, column) in places.iter_mut().zip(COLUMNS) {
            let found = names.iter().position(|n| *n == column);
            *place =
                found.ok_or_else(|| OwnError(format!("has no column `{column}`: {} expected", COLUMNS.join(","))))?;
        }
        let (mut rows, mut masses) = (Vec::new(), Vec::new());
        for (i, line) in lines {
            let cells: Vec<&str> = line.split(',').map(str::trim).collect();
            let mut row = [0.0; 5];
            for ((cell, place), column) in row.iter_mut().zip(places).zip(COLUMNS) {
                let text = cells.get(place).copied().unwrap_or("");
                let most = if column == "strain" { MOST_STRAIN } else { 1e6 };
                match text.parse::<f64>() {
                    Ok(x) if x > 0.0 && x <= most => *cell = x,
                    _ => return wrong(format!("line {}: `{column}` is `{text}`, above 0 to {most} expected", i + 1)),
                }
            }
            let [strain, warp, weft, bias, mass] = row;
            rows.push([strain, warp, weft, bias]);
            masses.push(mass);
        }
        if rows.len() < LEAST_ROWS {
            return wrong(format!("has {} rows, {LEAST_ROWS} or more expected", rows.len()));
        }
        let mean = masses.iter().sum::<f64>() / masses.len() as f64;
        if let Some(other) = masses.iter().find(|m| (*m / mean - 1.0).abs() > 0.1) {
            return wrong(format!("tests of fabrics of {other} and {mean:.3} kg/m^2 in one file: one fabric a file"));
        }
        Ok(Tests { rows, mass_kg_m2: mean })
    }

    /// The slope in N/m of the line through 0 that is nearest to a column's forces up to a strain.
    fn secant(&self, column: usize, most: f64) -> f64 {
        let sum = |f: &dyn Fn(&[f64; 4]) -> f64| self.rows.iter().filter(|r| r[0] <= most).map(f).sum::<f64>();
        sum(&|r| r[0] * r[column]) / sum(&|r| r[0] * r[0])
    }

    /// The constants. Errors: tests that no fabric of this kind has; no bending length and no known word.
    pub fn fabric(&self, words: &str, bending_length_m: Option<f64>) -> Result<OwnFabric, OwnError> {
        let [warp, weft, bias] = [1, 2, 3].map(|column| self.secant(column, MOST_STRAIN));
        let (c11, c22, s) = solve(warp, weft, bias)?;
        let mean = 0.5 * (c11 + c22) - s;
        let bend = (0.5 * f64::from(taut::BEND_SHARE) * mean).clamp(0.01, 1.0);
        let rest = |c: f64| (c - s - 4.0 * bend).max(0.25 * c);
        let largest = self.rows.iter().map(|r| r[0]).fold(0.0, f64::max);
        let least = self.rows.iter().map(|r| r[0]).fold(f64::INFINITY, f64::min);
        let soft = |column, all: f64| (self.secant(column, (SMALL * largest).max(least)) / all).clamp(0.05, 1.0) as f32;
        let rigidity = match (bending_length_m, Fabric::named(words)) {
            (Some(c), _) if (1e-3..=0.5).contains(&c) => self.mass_kg_m2 * GRAVITY_M_S2 * c.powi(3),
            (Some(c), _) => return wrong(format!("a bending length of {c} m, 0.001 to 0.5 expected")),
            (None, Some(like)) => {
                f64::from(rigidity_at(like.hinge_rigidity_n_m, like.density_kg_m2, self.mass_kg_m2 as f32))
            }
            (None, None) => {
                return wrong(format!(
                    "`{words}` names no kind of fabric whose rigidity (mass to the power {RIGIDITY_EXPONENT}) could stand in: \
                     give the bending length"
                ));
            }
        };
        let own = OwnFabric {
            words: words.into(),
            stiffness_n_per_m: [rest(c22), rest(c11), s, bend].map(|k| k as f32),
            density_kg_m2: self.mass_kg_m2 as f32,
            hinge_rigidity_n_m: rigidity as f32,
            softness: [soft(1, warp), soft(2, weft)],
        };
        own.check()?;
        Ok(own)
    }
}

/// C11, C22 and s from the moduli of strips, by bisection on s.
fn solve(warp: f64, weft: f64, bias: f64) -> Result<(f64, f64, f64), OwnError> {
    // C11 C22 (C11 - weft) = s^2 C22 and likewise: the ratio of C to the modulus is the same for both
    let matrix = |s: f64| {
        let share = s * s / (warp * weft);
        let grown = 0.5 * (1.0 + (1.0 + 4.0 * share).sqrt());
        (weft * grown, warp * grown)
    };
    let of_strip = |s: f64| {
        let (c11, c22) = matrix(s);
        let det = c11 * c22 - s * s;
        4.0 / ((c11 + c22 - 2.0 * s) / det + 1.0 / s)
    };
    // beyond this the lattice would push along the threads
    let (mut low, mut high) = (1e-6 * bias, 0.75 * warp.min(weft));
    if of_strip(high) < bias {
        return wrong(format!("the bias ({bias:.0} N/m) is too stiff beside warp ({warp:.0}) and weft ({weft:.0})"));
    }
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if of_strip(middle) < bias { low = middle } else { high = middle }
    }
    let (c11, c22) = matrix(high);
    Ok((c11, c22, high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use taut_lab::fabric::KINDS;

    /// Moduli of strips of a lattice, by the inverse of its stiffness matrix turned by an angle.
    fn strip(c11: f64, c22: f64, s: f64, degrees: f64) -> f64 {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let det = c11 * c22 - s * s;
        let [s11, s22, s12] = [c22 / det, c11 / det, -s / det];
        1.0 / (cos.powi(4) * s11 + sin.powi(4) * s22 + sin.powi(2) * cos.powi(2) * (2.0 * s12 + 1.0 / s))
    }

    #[test]
    fn every_kind_is_found_again_in_its_own_strips() {
        for kind in KINDS.iter().filter(|k| k.membrane[2] < 0.8 * k.membrane[0].min(k.membrane[1])) {
            let [uu, vv, shear] = kind.membrane.map(f64::from);
            let s = 0.5 * shear;
            let (c11, c22, found) =
                solve(strip(uu, vv, s, 90.0), strip(uu, vv, s, 0.0), strip(uu, vv, s, 45.0)).unwrap();
            for (a, b) in [(c11, uu), (c22, vv), (found, s)] {
                assert!((a / b - 1.0).abs() < 1e-6, "{}: {a} {b}", kind.name);
            }
        }
        assert!(solve(100.0, 100.0, 300.0).unwrap_err().to_string().contains("too stiff"));
    }

    /// What the committed example was made from; see its head.
    #[test]
    fn the_example_gives_its_stiffness_back() {
        let tests = Tests::parse(include_str!("../../examples/own-fabric/poplin.csv")).unwrap();
        let own = tests.fabric("crisp poplin", Some(0.026)).unwrap();
        for (found, made_from) in own.stiffness_n_per_m.iter().zip([1900.0, 1200.0, 40.0]) {
            assert!((f64::from(*found) / made_from - 1.0).abs() < 0.02, "{found} {made_from}");
        }
        assert!((own.density_kg_m2 - 0.118).abs() < 1e-6);
        assert!((f64::from(own.hinge_rigidity_n_m) / (0.118 * 9.81 * 0.026f64.powi(3)) - 1.0).abs() < 1e-6);
        assert!(own.softness.iter().all(|s| (0.9..=1.0).contains(s)), "{:?}", own.softness);
        let by_words = tests.fabric("crisp poplin", None).unwrap().hinge_rigidity_n_m;
        assert!((1e-5..1e-4).contains(&by_words), "{by_words}");
    }

    #[test]
    fn a_fabric_that_stiffens_is_soft_at_small_strain() {
        let rows: String = (1..=10)
            .map(|i| {
                let e = 0.01 * f64::from(i);
                // tension = (100 + 4000 e) e
                format!("{e},{},{},{},0.2\n", (100.0 + 4000.0 * e) * e, 400.0 * e, 150.0 * e)
            })
            .collect();
        let tests = Tests::parse(&format!("{}\n{rows}", COLUMNS.join(","))).unwrap();
        let own = tests.fabric("stretchy jersey", None).unwrap();
        assert!((0.3..0.6).contains(&own.softness[0]) && (own.softness[1] - 1.0).abs() < 1e-6, "{:?}", own.softness);
    }

    #[test]
    fn bad_tests_are_named() {
        let head = COLUMNS.join(",");
        let e = |text: &str| Tests::parse(text).unwrap_err().to_string();
        assert!(e("").contains("no line"));
        assert!(e("strain,warp_n_per_m\n").contains("no column `weft_n_per_m`"));
        let rows = "0.01,10,8,2,0.1\n0.02,20,16,4,0.1\n";
        assert!(e(&format!("{head}\n{rows}")).contains("2 rows"));
        for (row, named) in [
            ("0.03,30,24", "line 4: `bias_n_per_m` is ``"),
            ("0.03,x,24,6,0.1", "`warp_n_per_m` is `x`"),
            ("0.03,NaN,24,6,0.1", "`warp_n_per_m` is `NaN`"),
            ("3,30,24,6,0.1", "`strain` is `3`"),
            ("-0.03,30,24,6,0.1", "`strain` is `-0.03`"),
            ("0.03,30,24,6,0", "`mass_kg_per_m2` is `0`"),
            ("0.03,30,24,6,0.3", "one fabric a file"),
        ] {
            let found = e(&format!("# tests\n{head}\n{rows}{row}\n").replacen("# tests\n", "", 1));
            assert!(found.contains(named), "{row}: {found}");
        }
        let tests = Tests::parse(&format!("{head}\n{rows}0.03,30,24,6,0.1\n")).unwrap();
        assert!(tests.fabric("quantum foam", None).unwrap_err().to_string().contains("bending length"));
        assert!(tests.fabric("poplin", Some(9.0)).unwrap_err().to_string().contains("9 m"));
        let own = tests.fabric("poplin", None).unwrap();
        assert!(own.check().is_ok());
        let bad = OwnFabric { density_kg_m2: f32::NAN, ..own };
        assert!(bad.check().unwrap_err().to_string().contains("mass in kg/m^2"));
    }

    #[test]
    fn the_command_adds_to_a_configuration() {
        let home = tempfile::tempdir().unwrap();
        let out = home.path().join("mine.json");
        let csv = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/own-fabric/poplin.csv");
        let args = |words: &str| FabricArgs {
            csv: csv.clone(),
            words: words.into(),
            bending_length_m: Some(0.03),
            out: out.clone(),
        };
        for words in ["crisp poplin", "white shirt", "crisp poplin"] {
            run(&args(words)).unwrap();
        }
        let config: TrainConfig = serde_json::from_str(&std::fs::read_to_string(&out).unwrap()).unwrap();
        assert_eq!(config.own.iter().map(|o| o.words.as_str()).collect::<Vec<_>>(), ["white shirt", "crisp poplin"]);
        assert!(config.check().is_ok());
        let none = FabricArgs { csv: home.path().join("none.csv"), ..args("x") };
        assert!(run(&none).unwrap_err().to_string().contains("none.csv"));
    }
}
