//! What a good file gives.

use std::io::Write;

use taut::baked::Baked;
use taut_onnx::{Correction, Error, Generator, Request, pin_distance};

use crate::miniature::{NOISE, Weights, bytes};
use crate::reference;

fn generator() -> Generator {
    Generator::from_bytes(&bytes()).unwrap()
}

fn hang2(description: &str) -> Request<'_> {
    Request { pins: &[(0, 0), (0, 31)], ..Request::new(description) }
}

/// Every number of a correction as bits.
fn bits(c: &Correction) -> Vec<u32> {
    let told = [c.density_kg_m2, c.hinge_rigidity_n_m];
    c.field.iter().chain(&told).chain(&c.stretch_limits).map(|x| x.to_bits()).collect()
}

#[test]
fn tells_what_it_is() {
    let g = generator();
    let info = g.info();
    assert_eq!((info.grid, info.noise, info.tokens, info.words), (32, 128, 16, 9));
    assert_eq!(info.model_name, "miniature");
    assert_eq!(info.file_bytes, bytes().len());
    // words, head, first layer, normalisation, scales of the resize, last layer and its bias
    assert_eq!(info.parameters, 80 + 40 + 136 * 6 * 25 + 24 + 4 + 7 * 4 * 9 + 4);
    assert_eq!(g.vocabulary().index("denim"), Some(3));
    fn shared<T: Send + Sync>(_: &T) {}
    shared(&g);
}

#[test]
fn agrees_with_plain_loops() {
    let request = Request { seed: 42, ..hang2("heavy blue denim") };
    let c = generator().correct(&request).unwrap();
    let noise: Vec<f32> = (0..NOISE as u32).map(|i| taut::noise::gaussian(42, i)).collect();
    let pins = pin_distance(32, request.pins, [32, 32], [1.0, 1.0]).unwrap();
    let pins: Vec<f32> = pins.iter().copied().collect();
    let (field, fabric) = reference::run(&Weights::new(), &["heavy", "blue", "denim"], &noise, &pins);

    let decode = |t: f32, low: f32, high: f32| low * (high / low).powf((t + 1.0) / 2.0);
    let ranges = [(5.0, 20_000.0), (5.0, 20_000.0), (1.0, 8000.0), (0.02, 400.0)];
    let mut spread = (f32::MAX, f32::MIN);
    for (at, (&got, &t)) in c.field.iter().zip(&field).enumerate() {
        let (channel, place) = (at / 1024, at % 1024);
        let mut expected = decode(t, ranges[channel].0, ranges[channel].1);
        if channel == 3 {
            let structural = decode(field[place], 5.0, 20_000.0) + decode(field[1024 + place], 5.0, 20_000.0);
            expected = expected.min(0.02 * 0.5 * structural);
        }
        assert!((got / expected - 1.0).abs() < 1e-4, "channel {channel} at {place}: {got}, {expected}");
        spread = (spread.0.min(t), spread.1.max(t));
    }
    assert!(spread.1 - spread.0 > 0.5, "the field must not be flat to mean something: {spread:?}");
    assert!((c.density_kg_m2 / decode(fabric[0], 0.03, 0.8) - 1.0).abs() < 1e-4);
    assert!((c.hinge_rigidity_n_m / decode(fabric[1], 1e-7, 1e-3) - 1.0).abs() < 1e-4);
    for (limit, t) in c.stretch_limits.iter().zip(&fabric[2..]) {
        assert!((limit / decode(*t, 0.0005, 0.3) - 1.0).abs() < 1e-4);
    }
}

#[test]
fn the_same_request_gives_the_same_bits() {
    let (a, b) = (generator(), generator());
    let request = Request { seed: 7, rows: 48, columns: 40, ..hang2("stretch denim") };
    let first = bits(&a.correct(&request).unwrap());
    for _ in 0..3 {
        a.correct(&Request { seed: 8, ..hang2("silk") }).unwrap();
        assert_eq!(bits(&a.correct(&request).unwrap()), first);
        assert_eq!(bits(&b.correct(&request).unwrap()), first);
    }
}

#[test]
fn threads_share_a_generator() {
    let g = generator();
    let alone = bits(&g.correct(&hang2("cotton knit")).unwrap());
    std::thread::scope(|s| {
        let threads: Vec<_> = (0..4).map(|_| s.spawn(|| bits(&g.correct(&hang2("cotton knit")).unwrap()))).collect();
        assert!(threads.into_iter().all(|t| t.join().unwrap() == alone));
    });
}

#[test]
fn words_seed_and_pins_matter() {
    let g = generator();
    let denim = g.correct(&hang2("denim")).unwrap();
    let silk = g.correct(&hang2("silk")).unwrap();
    assert_ne!(denim.field, silk.field);
    assert_ne!(denim.density_kg_m2, silk.density_kg_m2);
    let other = g.correct(&Request { seed: 1, ..hang2("denim") }).unwrap();
    assert_ne!(denim.field, other.field);
    assert_eq!(denim.density_kg_m2, other.density_kg_m2, "a seed is no other fabric");
    assert_eq!(denim.stretch_limits, other.stretch_limits);
    let free = g.correct(&Request::new("denim")).unwrap();
    assert_ne!(denim.field, free.field);
    // the order of words does not matter but for the last bit of a sum
    let ab = g.correct(&hang2("blue denim")).unwrap();
    let ba = g.correct(&hang2("denim, blue")).unwrap();
    assert!(ab.field.iter().zip(&ba.field).all(|(a, b)| (a / b - 1.0).abs() < 1e-4));
}

#[test]
fn unknown_and_dropped_words_are_told() {
    let c = generator().correct(&hang2("Heavy bleu Non-Wovens, quux-denims!")).unwrap();
    assert_eq!(c.tokens, ["heavy", "non-woven", "denim"]);
    assert_eq!(c.unknown_words, ["bleu", "quux"]);
    assert!(c.dropped_words.is_empty());
    let many = format!("{} silk cotton", "denim ".repeat(16));
    let c = generator().correct(&hang2(&many)).unwrap();
    assert_eq!(c.tokens, ["denim"; 16]);
    assert_eq!(c.dropped_words, ["silk", "cotton"]);
    assert_eq!(
        generator().correct(&hang2("linen tweed")),
        Err(Error::NoKnownWord { unknown: vec!["linen".into(), "tweed".into()] })
    );
    assert_eq!(generator().correct(&hang2(" ?! ")), Err(Error::NoKnownWord { unknown: vec![] }));
}

#[test]
fn every_size_is_within_the_ranges_and_bend_is_capped() {
    let g = generator();
    for (rows, columns) in [(2, 2), (2, 300), (31, 33), (32, 32), (129, 64), (4096, 2)] {
        let c = g.correct(&Request { rows, columns, pins: &[(0, 0)], ..Request::new("denim") }).unwrap();
        assert_eq!(c.field.dim(), (4, rows, columns));
        for i in 0..rows {
            for j in 0..columns {
                let [warp, weft, shear, bend] = [0, 1, 2, 3].map(|k| c.field[[k, i, j]]);
                let within = |k: f32, low: f32, high: f32| k >= low * 0.999_999 && k <= high * 1.000_001;
                assert!(within(warp, 5.0, 20_000.0) && within(weft, 5.0, 20_000.0));
                assert!(within(shear, 1.0, 8000.0));
                assert!(bend > 0.0 && bend <= 0.0100001 * (warp + weft));
            }
        }
    }
}

#[test]
fn bad_requests_are_refused() {
    let g = generator();
    let denim = Request::new("denim");
    for (rows, columns) in [(1, 1), (0, 0), (70_000, 2), (2, 4097), (usize::MAX, usize::MAX)] {
        let error = g.correct(&Request { rows, columns, ..denim }).unwrap_err();
        assert_eq!(error, Error::GridSize { rows, columns });
    }
    for side in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e30] {
        assert!(matches!(g.correct(&Request { width_m: side, ..denim }), Err(Error::SideLength { .. })));
        assert!(matches!(g.correct(&Request { height_m: side, ..denim }), Err(Error::SideLength { .. })));
    }
    let error = g.correct(&Request { pins: &[(32, 0)], ..denim }).unwrap_err();
    assert_eq!(error, Error::Pin { row: 32, column: 0, rows: 32, columns: 32 });
    let long = "denim ".repeat(100_000);
    assert!(matches!(g.correct(&Request::new(&long)), Err(Error::LongDescription { .. })));
}

#[test]
fn loads_from_a_path() {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(&bytes()).unwrap();
    let loaded = Generator::load(file.path()).unwrap();
    assert_eq!(bits(&loaded.correct(&hang2("denim")).unwrap()), bits(&generator().correct(&hang2("denim")).unwrap()));
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(Generator::load(folder.path()), Err(Error::Io { .. })));
    let missing = Generator::load(folder.path().join("missing.onnx")).unwrap_err();
    assert!(missing.to_string().contains("missing.onnx"), "{missing}");
    // 1 TB that takes no room on the disk
    file.as_file().set_len(1 << 40).unwrap();
    assert!(matches!(Generator::load(file.path()), Err(Error::TooLarge { .. })));
}

#[test]
fn bakes_what_the_cloth_reads() {
    let request = Request { seed: 9, rows: 12, columns: 17, ..hang2("silk") };
    let request = Request { pins: &[(0, 0)], ..request };
    let mut c = generator().correct(&request).unwrap();
    let bytes = c.to_baked().unwrap();
    let baked = Baked::parse(&bytes).unwrap();
    assert_eq!((baked.rows, baked.columns, baked.seed), (12, 17, 9));
    assert_eq!(baked.fabric, c.fabric());
    for ((channel, row, column), &k) in c.field.indexed_iter() {
        assert_eq!(baked.stiffness(channel, row, column).to_bits(), k.to_bits());
    }
    assert_eq!(generator().correct(&request).unwrap().to_baked().unwrap(), bytes);
    c.field[[0, 0, 0]] = f32::NAN;
    assert_eq!(c.to_baked(), Err(Error::Baked(taut::Error::NotFinite)));
    c.field = ndarray::Array3::zeros((3, 12, 17));
    assert_eq!(c.to_baked(), Err(Error::Baked(taut::Error::Shape)));
}
