//! Numbers on the command line: each is checked where it is read, so that the message names the option.

use std::ops::RangeInclusive;

/// Particles of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GridSize {
    /// Particles along v, 2 to 4096.
    pub rows: u32,
    /// Particles along u, 2 to 4096.
    pub columns: u32,
}

/// Side lengths of a sheet in m, each 0.001 to 10,000.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides {
    /// Along u.
    pub width_m: f32,
    /// Along v.
    pub height_m: f32,
}

/// A number within bounds; NaN and infinity are outside of any.
fn within(text: &str, bounds: RangeInclusive<f32>, unit: &str) -> Result<f32, String> {
    let wrong = || format!("must be {} to {}{unit}", bounds.start(), bounds.end());
    let number: f32 = text.trim().parse().map_err(|_| wrong())?;
    if bounds.contains(&number) { Ok(number) } else { Err(wrong()) }
}

/// The two halves of `AxB`.
fn pair<'a>(text: &'a str, example: &str) -> Result<(&'a str, &'a str), String> {
    text.split_once(['x', 'X', '\u{d7}']).ok_or_else(|| format!("give two numbers, for example {example}"))
}

/// `ROWSxCOLUMNS`.
pub fn grid(text: &str) -> Result<GridSize, String> {
    let (rows, columns) = pair(text, "32x32")?;
    let side = |s: &str| {
        let number = s.trim().parse::<u32>().ok();
        number.filter(|n| (2..=taut::Grid::MAX_SIDE).contains(n)).ok_or("each side needs 2 to 4096 particles")
    };
    Ok(GridSize { rows: side(rows)?, columns: side(columns)? })
}

/// `WIDTHxHEIGHT` in m.
pub fn sides(text: &str) -> Result<Sides, String> {
    let (width, height) = pair(text, "1x1.5")?;
    let side = |s| within(s, 0.001..=10_000.0, " m").map_err(|e| format!("each side {e}"));
    Ok(Sides { width_m: side(width)?, height_m: side(height)? })
}

/// Frames per second.
pub fn rate(text: &str) -> Result<f32, String> {
    within(text, 1.0..=10_000.0, " Hz")
}

/// Substeps of a frame.
pub fn substeps(text: &str) -> Result<u32, String> {
    let number = text.trim().parse::<u32>().ok();
    number.filter(|n| (1..=1024).contains(n)).ok_or("must be a whole number, 1 to 1024".into())
}

/// Simulated time in s: above 0, at most an hour.
pub fn seconds(text: &str) -> Result<f32, String> {
    within(text, f32::MIN_POSITIVE..=3600.0, "").map_err(|_| "must be above 0, at most 3600 s".into())
}

/// Simulated time of a film in s.
pub fn short_seconds(text: &str) -> Result<f32, String> {
    within(text, f32::MIN_POSITIVE..=30.0, "").map_err(|_| "must be above 0, at most 30 s".into())
}

/// A share in percent: above 0, at most 100.
pub fn percent(text: &str) -> Result<f32, String> {
    within(text, f32::MIN_POSITIVE..=100.0, "").map_err(|_| "must be above 0, at most 100 %".into())
}

/// A number above 0, at most a million.
pub fn positive(text: &str) -> Result<f32, String> {
    within(text, f32::MIN_POSITIVE..=1e6, "").map_err(|_| "must be above 0, at most 1000000".into())
}

/// Mass per area in kg/m^2: from a soap film to a lead apron.
pub fn density(text: &str) -> Result<f32, String> {
    within(text, 0.0001..=1000.0, " kg/m^2")
}

/// A stability budget by its name.
pub fn budget(text: &str) -> Result<taut::Budget, String> {
    match text {
        "tuned" => Ok(taut::Budget::Tuned),
        "certified" => Ok(taut::Budget::Certified),
        _ => Err("choose tuned or certified".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids() {
        let size = |rows, columns| Ok(GridSize { rows, columns });
        assert_eq!(grid("32x48"), size(32, 48));
        assert_eq!(grid("2X4096"), size(2, 4096));
        assert_eq!(grid("8 \u{d7} 9"), size(8, 9));
        for bad in ["1x1", "70000x2", "2x4097", "0x0", "-3x4", "3.5x4", "x", "3x", "3x4x5", "nanx4"] {
            let e = grid(bad).expect_err(bad);
            assert!(e.contains("2 to 4096"), "{bad}: {e}");
        }
        for bad in ["", "32", "32,32"] {
            assert!(grid(bad).expect_err(bad).contains("32x32"), "{bad}");
        }
    }

    #[test]
    fn side_lengths() {
        let s = sides("1.5x2").expect("two sides");
        assert_eq!((s.width_m, s.height_m), (1.5, 2.0));
        for bad in ["0x1", "1x-1", "1xNaN", "infx1", "1e-30x1", "20000x1", "1", "ax1"] {
            assert!(sides(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn single_numbers() {
        assert_eq!(rate("59.94"), Ok(59.94));
        assert_eq!(substeps("16"), Ok(16));
        assert_eq!(seconds("0.5"), Ok(0.5));
        assert_eq!(density("0.32"), Ok(0.32));
        for bad in ["0", "-1", "NaN", "inf", "", "x", "1e9"] {
            assert!(rate(bad).is_err(), "rate {bad}");
            assert!(substeps(bad).is_err(), "substeps {bad}");
            assert!(seconds(bad).is_err(), "seconds {bad}");
            assert!(density(bad).is_err(), "density {bad}");
        }
        assert!(substeps("1.5").is_err() && substeps("1025").is_err());
        assert!(seconds("3600.1").is_err());
        assert_eq!(budget("tuned"), Ok(taut::Budget::Tuned));
        assert!(budget("Tuned ").is_err());
    }
}
