//! What the generator file says of itself.

use super::{ExportError, TOKENS, WordTable};
use crate::nets::{CHANNELS, FABRIC, GRID, NOISE};

/// The parts of the metadata that are not fixed by the format.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportMeta {
    /// A name for people; one line, not empty.
    pub model_name: String,
    /// Digest of the training configuration, in hexadecimal.
    pub training_digest: String,
    /// Range of each channel (warp, weft, shear, bend) in N/m: tanh -1 and 1 decode to its ends, logarithmically.
    pub channel_ranges_n_per_m: [(f64, f64); CHANNELS],
    /// Ranges of density (kg/m^2), hinge rigidity (N m), stretch limits of warp, weft, diagonal (fractions), decoded
    /// alike.
    pub fabric_ranges: [(f64, f64); FABRIC],
}

impl Default for ExportMeta {
    fn default() -> Self {
        let (structural, limit) = ((5.0, 20_000.0), (0.0005, 0.3));
        Self {
            model_name: "taut generator".into(),
            training_digest: "0".into(),
            channel_ranges_n_per_m: [structural, structural, (1.0, 8000.0), (0.02, 400.0)],
            fabric_ranges: [(0.03, 0.8), (1e-7, 1e-3), limit, limit, limit],
        }
    }
}

impl ExportMeta {
    /// The key-value pairs of the file, in a fixed order.
    ///
    /// # Errors
    /// [`ExportError::Meta`] for an empty or many-line name, a digest that is not hexadecimal, a range that is not
    /// 0 < lo < hi.
    pub fn properties(&self, words: &WordTable) -> Result<Vec<(&'static str, String)>, ExportError> {
        let bad = |what: String| Err(ExportError::Meta(what));
        if self.model_name.is_empty() || self.model_name.contains(char::is_control) {
            return bad("the model name is empty or holds a control character".into());
        }
        if self.training_digest.is_empty() || !self.training_digest.bytes().all(|b| b.is_ascii_hexdigit()) {
            return bad(format!("the training digest {:?} is not hexadecimal", self.training_digest));
        }
        for (lo, hi) in self.channel_ranges_n_per_m.iter().chain(&self.fabric_ranges) {
            if !(*lo > 0.0 && lo < hi && hi.is_finite()) {
                return bad(format!("the range {lo}:{hi} is not 0 < lo < hi"));
            }
        }
        Ok(vec![
            ("taut.format", "1".into()),
            ("taut.model_name", self.model_name.clone()),
            ("taut.vocabulary", words.tokens.join("\n")),
            ("taut.channels", "warp,weft,shear,bend".into()),
            ("taut.channel_ranges_n_per_m", join(&self.channel_ranges_n_per_m)),
            ("taut.fabric", "density_kg_m2,hinge_rigidity_n_m,limit_warp,limit_weft,limit_diagonal".into()),
            ("taut.fabric_ranges", join(&self.fabric_ranges)),
            ("taut.grid", GRID.to_string()),
            ("taut.noise", NOISE.to_string()),
            ("taut.tokens", TOKENS.to_string()),
            ("taut.training_digest", self.training_digest.clone()),
        ])
    }
}

/// `lo:hi,lo:hi,...` in plain decimals, which read back to the same f64.
fn join(ranges: &[(f64, f64)]) -> String {
    ranges.iter().map(|(lo, hi)| format!("{lo}:{hi}")).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_plain_decimals_that_read_back() {
        let m = ExportMeta::default();
        let text = join(&m.fabric_ranges);
        assert_eq!(text, "0.03:0.8,0.0000001:0.001,0.0005:0.3,0.0005:0.3,0.0005:0.3");
        for (part, (lo, hi)) in text.split(',').zip(m.fabric_ranges) {
            let (a, b) = part.split_once(':').expect("colon");
            assert_eq!((a.parse(), b.parse()), (Ok(lo), Ok(hi)));
        }
    }

    #[test]
    fn bad_metadata_is_named() {
        let words = WordTable { tokens: vec!["<pad>".into(), "silk".into()], vectors: vec![0.0; 2048] };
        let bad = |m: ExportMeta| m.properties(&words).expect_err("bad").to_string();
        let ok = ExportMeta::default;
        assert!(bad(ExportMeta { training_digest: "xyz".into(), ..ok() }).contains("xyz"));
        assert!(bad(ExportMeta { model_name: "a\nb".into(), ..ok() }).contains("name"));
        let mut m = ok();
        m.channel_ranges_n_per_m[2] = (9.0, 3.0);
        assert!(bad(m).contains("9:3"));
        let mut m = ok();
        m.fabric_ranges[0].1 = f64::NAN;
        assert!(bad(m).contains("NaN"));
    }
}
