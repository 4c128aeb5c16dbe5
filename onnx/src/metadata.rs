//! The metadata of a generator file, format 1: every key is required, every value is checked.

use taut::field::CHANNELS;

use crate::Error;
use crate::vocabulary::Vocabulary;
use crate::wire::Entry;

/// What the generator tells of the fabric, in its order, `taut.fabric`: area density, hinge
/// rigidity, and the stretch limits along warp, weft and diagonal as fractions.
pub const FABRIC: [&str; 5] = ["density_kg_m2", "hinge_rigidity_n_m", "limit_warp", "limit_weft", "limit_diagonal"];

/// Sides of the field that the network writes. Beyond 256 a file is hostile, not detailed.
const GRID: std::ops::RangeInclusive<usize> = 2..=256;
const NOISE: std::ops::RangeInclusive<usize> = 1..=4096;
const TOKENS: std::ops::RangeInclusive<usize> = 1..=256;
/// Bounds of every physical range: within them nothing over- or underflows in f32.
const SMALLEST: f32 = 1e-12;
const LARGEST: f32 = 1e12;
const MAX_NAME: usize = 128;

/// What tanh is decoded to: -1 is `low`, 1 is `high`, geometric in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Smallest value, above 0.
    pub low: f32,
    /// Largest value, above `low`.
    pub high: f32,
}

/// What a generator file says of itself.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Info {
    /// `taut.model_name`: 1 to 128 printable characters.
    pub model_name: String,
    /// `taut.training_digest`: hexadecimal digest of the training configuration.
    pub training_digest: String,
    /// `taut.grid`: particles per side of the field that the network writes, 2 to 256.
    pub grid: usize,
    /// `taut.noise`: Gaussian numbers that the network takes, 1 to 4096.
    pub noise: usize,
    /// `taut.tokens`: most words of a description, 1 to 256.
    pub tokens: usize,
    /// Words of the vocabulary, the padding not counted.
    pub words: usize,
    /// `taut.channel_ranges_n_per_m`, in the order of [`taut::field::CHANNELS`], N/m.
    pub channel_ranges: [Range; 4],
    /// `taut.fabric_ranges`, in the order of [`FABRIC`], SI units.
    pub fabric_ranges: [Range; 5],
    /// Numbers in the file: weights and word vectors.
    pub parameters: usize,
    /// Size of the file in bytes.
    pub file_bytes: usize,
}

/// Reads and checks all keys. `parameters` and `file_bytes` are left 0 for the caller.
/// Errors: [`Error::MetadataMissing`], [`Error::Metadata`].
pub(crate) fn parse(entries: &[Entry<'_>]) -> Result<(Info, Vocabulary), Error> {
    for (i, entry) in entries.iter().enumerate() {
        if entries[..i].iter().any(|e| e.key == entry.key) {
            return Err(bad(entry.key, "the key is there twice"));
        }
    }
    let get = |key| {
        let entry = entries.iter().find(|e| e.key == key);
        entry.map(|e| e.value).ok_or(Error::MetadataMissing { key })
    };
    exactly("taut.format", get("taut.format")?, "1")?;
    exactly("taut.channels", get("taut.channels")?, &CHANNELS.join(","))?;
    exactly("taut.fabric", get("taut.fabric")?, &FABRIC.join(","))?;
    let key = "taut.channel_ranges_n_per_m";
    let channel_ranges = ranges(key, get(key)?)?;
    let fabric_ranges = ranges("taut.fabric_ranges", get("taut.fabric_ranges")?)?;
    let grid = count("taut.grid", get("taut.grid")?, GRID)?;
    let noise = count("taut.noise", get("taut.noise")?, NOISE)?;
    let tokens = count("taut.tokens", get("taut.tokens")?, TOKENS)?;
    let training_digest = get("taut.training_digest")?;
    let hex = training_digest.bytes().all(|b| b.is_ascii_hexdigit());
    if !hex || !(1..=MAX_NAME).contains(&training_digest.len()) {
        return Err(bad("taut.training_digest", "not 1 to 128 hexadecimal digits"));
    }
    let model_name = get("taut.model_name")?;
    let printable = model_name.chars().all(|c| !c.is_control());
    if !printable || !(1..=MAX_NAME).contains(&model_name.chars().count()) {
        return Err(bad("taut.model_name", "not 1 to 128 printable characters"));
    }
    let vocabulary = Vocabulary::parse(get("taut.vocabulary")?)?;
    let info = Info {
        model_name: model_name.into(),
        training_digest: training_digest.into(),
        grid,
        noise,
        tokens,
        words: vocabulary.words(),
        channel_ranges,
        fabric_ranges,
        parameters: 0,
        file_bytes: 0,
    };
    Ok((info, vocabulary))
}

fn bad(key: &str, reason: impl Into<String>) -> Error {
    Error::Metadata { key: key.into(), reason: reason.into() }
}

fn exactly(key: &str, value: &str, expected: &str) -> Result<(), Error> {
    if value == expected {
        return Ok(());
    }
    let found: String = value.chars().take(80).collect();
    Err(bad(key, format!("\"{found}\", this build reads \"{expected}\"")))
}

fn count(key: &str, value: &str, bounds: std::ops::RangeInclusive<usize>) -> Result<usize, Error> {
    // only digits: parse would also take a sign
    let digits = !value.is_empty() && value.bytes().all(|b| b.is_ascii_digit());
    let number = if digits { value.parse().ok() } else { None };
    number.filter(|n| bounds.contains(n)).ok_or_else(|| {
        let found: String = value.chars().take(40).collect();
        bad(key, format!("\"{found}\" is not within {} to {}", bounds.start(), bounds.end()))
    })
}

/// `lo:hi,lo:hi,...`, exactly `N` of them.
fn ranges<const N: usize>(key: &str, value: &str) -> Result<[Range; N], Error> {
    let pairs: Vec<&str> = value.split(',').collect();
    if pairs.len() != N {
        return Err(bad(key, format!("{} ranges, expected {N}", pairs.len())));
    }
    let mut out = [Range { low: 1.0, high: 1.0 }; N];
    for (range, pair) in out.iter_mut().zip(pairs) {
        *range = parse_range(pair).ok_or_else(|| {
            let pair: String = pair.chars().take(60).collect();
            bad(key, format!("\"{pair}\" is not low:high with 1e-12 <= low < high <= 1e12"))
        })?;
    }
    Ok(out)
}

fn parse_range(pair: &str) -> Option<Range> {
    let (low, high) = pair.split_once(':')?;
    let (low, high): (f32, f32) = (low.parse().ok()?, high.parse().ok()?);
    // written so that NaN fails
    (low >= SMALLEST && low < high && high <= LARGEST).then_some(Range { low, high })
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: [(&str, &str); 11] = [
        ("taut.format", "1"),
        ("taut.vocabulary", "<pad>\ncotton\ndenim"),
        ("taut.channels", "warp,weft,shear,bend"),
        ("taut.channel_ranges_n_per_m", "5:20000,5:20000,1:8000,0.02:400"),
        ("taut.fabric", "density_kg_m2,hinge_rigidity_n_m,limit_warp,limit_weft,limit_diagonal"),
        ("taut.fabric_ranges", "0.03:0.8,1e-7:1e-3,0.0005:0.3,0.0005:0.3,0.0005:0.3"),
        ("taut.grid", "32"),
        ("taut.noise", "128"),
        ("taut.tokens", "16"),
        ("taut.training_digest", "0123456789abcdef"),
        ("taut.model_name", "generator"),
    ];

    fn with(key: &str, value: &'static str) -> Result<(Info, Vocabulary), Error> {
        let entries: Vec<_> =
            GOOD.iter().map(|&(k, v)| Entry { key: k, value: if k == key { value } else { v } }).collect();
        parse(&entries)
    }

    #[test]
    fn reads_every_key() {
        let (info, vocabulary) = with("", "").unwrap();
        assert_eq!((info.grid, info.noise, info.tokens, info.words), (32, 128, 16, 2));
        assert_eq!(info.channel_ranges[3], Range { low: 0.02, high: 400.0 });
        assert_eq!(info.fabric_ranges[1], Range { low: 1e-7, high: 1e-3 });
        assert_eq!(vocabulary.index("denim"), Some(2));
    }

    #[test]
    fn names_the_missing_key() {
        for missing in 0..GOOD.len() {
            let mut entries: Vec<_> = GOOD.iter().map(|&(key, value)| Entry { key, value }).collect();
            entries.remove(missing);
            assert_eq!(parse(&entries), Err(Error::MetadataMissing { key: GOOD[missing].0 }));
        }
    }

    #[test]
    fn refuses_a_key_that_is_there_twice() {
        let mut entries: Vec<_> = GOOD.iter().map(|&(key, value)| Entry { key, value }).collect();
        entries.push(Entry { key: "taut.grid", value: "64" });
        assert!(matches!(parse(&entries), Err(Error::Metadata { key, .. }) if key == "taut.grid"));
    }

    #[test]
    fn refuses_hostile_values() {
        let hostile = [
            ("taut.format", "2"),
            ("taut.format", ""),
            ("taut.channels", "weft,warp,shear,bend"),
            ("taut.channels", "warp,weft,shear"),
            ("taut.fabric", "density_kg_m2"),
            ("taut.channel_ranges_n_per_m", "5:20000,5:20000,1:8000"),
            ("taut.channel_ranges_n_per_m", "5:20000,5:20000,1:8000,0.02:400,1:2"),
            ("taut.channel_ranges_n_per_m", "5:20000,5:20000,1:8000,nan:400"),
            ("taut.channel_ranges_n_per_m", "5:20000,5:20000,1:8000,0.02:NaN"),
            ("taut.channel_ranges_n_per_m", "5:20000,5:20000,1:8000,0.02:inf"),
            ("taut.channel_ranges_n_per_m", "5:20000,5:20000,1:8000,-1:400"),
            ("taut.channel_ranges_n_per_m", "5:20000,5:20000,1:8000,0:400"),
            ("taut.channel_ranges_n_per_m", "20000:5,5:20000,1:8000,0.02:400"),
            ("taut.channel_ranges_n_per_m", "5:5,5:20000,1:8000,0.02:400"),
            ("taut.channel_ranges_n_per_m", "5:20000,5:20000,1:8000,0.02:1e39"),
            ("taut.channel_ranges_n_per_m", "5 20000,5:20000,1:8000,0.02:400"),
            ("taut.fabric_ranges", ""),
            ("taut.fabric_ranges", "a:b,c:d,e:f,g:h,i:j"),
            ("taut.grid", "1"),
            ("taut.grid", "-32"),
            ("taut.grid", "+32"),
            ("taut.grid", "32.0"),
            ("taut.grid", "4000000000"),
            ("taut.grid", "99999999999999999999999999"),
            ("taut.noise", "0"),
            ("taut.tokens", "1000000"),
            ("taut.training_digest", "xyz"),
            ("taut.training_digest", ""),
            ("taut.model_name", ""),
            ("taut.model_name", "two\nlines"),
            ("taut.vocabulary", ""),
        ];
        for (key, value) in hostile {
            match with(key, value) {
                Err(Error::Metadata { key: named, .. }) => assert_eq!(named, key),
                other => panic!("{key} = {value}: {other:?}"),
            }
        }
    }
}
