use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use super::command::run_until;
use super::*;
use crate::Shard;

fn args(out: &Path) -> DataArgs {
    DataArgs { out: out.into(), seed: 3, shard: None, quick: true, threads: Some(2) }
}

fn make(args: &DataArgs) -> Result<(), DataError> {
    run_until(args, &AtomicBool::new(false))
}

/// Every file of a folder with its bytes.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|f| f.unwrap().path())
        .map(|p| (p.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&p).unwrap()))
        .collect();
    all.sort();
    all
}

#[test]
fn the_plan_has_the_pictures_of_the_paper() {
    let plan = Plan { seed: 1, quick: false };
    for (split, images) in
        [(Split::Training, 4615), (Split::Evaluation, 1680), (Split::Test, 1023), (Split::Comparison, 20)]
    {
        let all = plan.trajectories(split);
        assert_eq!(all.iter().map(|t| t.frames).sum::<usize>(), images, "{split:?}");
        assert_eq!(plan.images(split), images);
        assert_eq!(plan.parts(split).concat(), all, "{split:?}: the parts are the whole");
        for scene in Scene::ALL {
            let share = all.iter().filter(|t| t.scene == scene).count() as f64 / all.len() as f64;
            assert!((share - 0.2).abs() < 0.01, "{split:?} {scene}: {share}");
        }
        assert!(all.iter().all(|t| t.frames > 0 && t.pins().iter().all(|p| *p < GRID)));
    }
}

#[test]
fn splits_share_no_fabric() {
    let mut kinds = BTreeSet::new();
    let mut of: Vec<BTreeSet<(String, Vec<u32>)>> = Vec::new();
    for split in Split::ALL {
        // two seeds: a generator that was trained on one set is judged by another
        let all = [1, 2].map(|seed| Plan { seed, quick: false }.trajectories(split)).concat();
        assert!(all.iter().all(|t| Split::of(&t.fabric, &t.words) == split));
        kinds.extend(all.iter().map(|t| t.fabric.kind));
        of.push(all.iter().map(|t| (t.words.clone(), t.fabric.stiffness.map(f32::to_bits).to_vec())).collect());
    }
    assert_eq!(kinds.len(), taut_lab::fabric::KINDS.len(), "every kind is somewhere");
    for (i, a) in of.iter().enumerate() {
        for b in &of[..i] {
            let words = |s: &BTreeSet<(String, Vec<u32>)>| s.iter().map(|f| f.0.clone()).collect::<BTreeSet<_>>();
            let pieces = |s: &BTreeSet<(String, Vec<u32>)>| s.iter().map(|f| f.1.clone()).collect::<BTreeSet<_>>();
            assert!(words(a).is_disjoint(&words(b)) && pieces(a).is_disjoint(&pieces(b)));
        }
    }
    let piece = |words: &str| Split::of(&taut_lab::fabric::KINDS[0].fabric(), words);
    assert_eq!(piece("heavy blue denim"), piece("striped heavy cotton jeans"), "colours and names do not act");
}

#[test]
fn shares_and_an_interrupted_run_are_the_whole() {
    let home = tempfile::tempdir().unwrap();
    let [whole, shares, cut] = ["whole", "shares", "cut"].map(|n| home.path().join(n));
    make(&args(&whole)).unwrap();
    let expected = files(&whole);
    assert_eq!(expected.len(), 1 + 3 * 4, "{:?}", expected.iter().map(|f| &f.0).collect::<Vec<_>>());

    // shares of the parts, in another order and by one thread
    for share in ["3/4", "2/4"] {
        make(&DataArgs { shard: Some(share.parse().unwrap()), threads: Some(1), ..args(&shares) }).unwrap();
    }
    let made = files(&shares);
    assert_eq!(made.len(), 1 + 2 * 3);
    assert!(made.iter().all(|f| expected.contains(f)), "shares differ from the whole");
    assert!(matches!(load(&shares, Split::Training), Err(DataError::Incomplete { missing: 1, of: 1, .. })));

    // stopped before the first picture; then merged with what another machine made, and killed between a part's two files
    let stopped = run_until(&args(&cut), &AtomicBool::new(true));
    assert!(matches!(stopped, Err(DataError::Interrupted)));
    for (name, bytes) in expected.iter().filter(|(name, _)| !name.starts_with("evaluation")) {
        fs::write(cut.join(name), bytes).unwrap();
    }
    fs::write(cut.join("evaluation-000.npz"), b"half").unwrap();
    fs::write(cut.join("evaluation-000.npz.new"), b"half").unwrap();
    make(&args(&cut)).unwrap();
    assert!(files(&cut) == expected, "a resumed run differs");

    // a folder that is complete is left alone; another set is refused
    let before = fs::metadata(cut.join("training-000.npz")).unwrap().modified().unwrap();
    make(&args(&cut)).unwrap();
    assert_eq!(fs::metadata(cut.join("training-000.npz")).unwrap().modified().unwrap(), before);
    let other = make(&DataArgs { seed: 4, ..args(&cut) }).unwrap_err().to_string();
    assert!(other.contains("another set"), "{other}");

    what_is_read_is_what_was_made(&whole);
    what_is_wrong_is_named(&whole);
}

fn what_is_read_is_what_was_made(folder: &Path) {
    let plan = Plan { seed: 3, quick: true };
    for split in Split::ALL {
        let all = load(folder, split).unwrap();
        assert_eq!(all.len(), plan.images(split));
        let planned = plan.trajectories(split);
        let mut rest = all.iter();
        for t in &planned {
            let frames: Vec<&Sample> = rest.by_ref().take(t.frames).collect();
            assert!(frames.iter().all(|s| s.fabric == t.fabric && s.words == t.words && s.scene == t.scene));
            assert!(frames.windows(2).all(|w| w[0].time_s <= w[1].time_s && !w[0].at_rest));
            // a picture is the picture of its positions, but for its 256 levels
            let last = frames[t.frames - 1];
            // the motion of a quick set ends before the cloth lies on the ball
            assert!(last.at_rest || t.scene == Scene::Drape, "{} {}", t.words, t.scene);
            let config = crate::image::RenderConfig { channels: CHANNELS.to_vec(), ..Default::default() };
            let renderer = crate::image::Renderer::new(config, GRID, GRID).unwrap();
            let drawn = renderer.render(&t.scene.view().of(&last.positions)).unwrap();
            assert!(drawn.iter().zip(&last.image).all(|(a, b)| (a - b).abs() <= 0.5 / 127.5 + 1e-6));
            assert_eq!(last.picture(&[Channel::Silhouette]), last.image[2 * PIXELS..]);
            let cloth = last.image[2 * PIXELS..].iter().filter(|v| **v > 0.0).count();
            assert!((100..3000).contains(&cloth), "{}: {cloth} pixels of cloth", t.scene);
            let border = (0..64).map(|i| last.image[2 * PIXELS + 63 * 64 + i]).fold(-1.0, f32::max);
            assert!(border < 0.0 || t.scene == Scene::Hang1, "{} {}: out of the picture", t.words, t.scene);
        }
    }
}

fn what_is_wrong_is_named(folder: &Path) {
    let spoil = |name: &str, change: &dyn Fn(Vec<u8>) -> Vec<u8>, named: &str| {
        let path = folder.join(name);
        let whole = fs::read(&path).unwrap();
        fs::write(&path, change(whole.clone())).unwrap();
        let e = load(folder, Split::Comparison).unwrap_err().to_string();
        assert!(e.contains(name) && e.contains(named), "{name}: {e}");
        fs::write(&path, whole).unwrap();
    };
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    spoil("comparison-000.npz", &|b| b[..b.len() / 2].to_vec(), "");
    spoil("comparison-000.npz", &|_| b"hello".to_vec(), "no .npz");
    spoil("comparison-000.npz", &|_| fs::read(folder.join("test-000.npz")).unwrap(), "shape");
    spoil("comparison-000.jsonl", &|b| b[..b.len() / 2].to_vec(), "line");
    spoil(
        "comparison-000.jsonl",
        &|b| text(b).lines().take(2).flat_map(|l| [l, "\n"]).collect::<String>().into(),
        "cut off",
    );
    spoil("comparison-000.jsonl", &|b| [b.clone(), b].concat(), "there should be 5 lines");
    spoil("comparison-000.jsonl", &|b| text(b).replace("\"hang2\"", "\"edge\"").into(), "line 1: is not the picture");
    spoil("comparison-000.jsonl", &|b| text(b).replacen("\"pins\":[0", "\"pins\":[-1", 1).into(), "line 1");
    spoil("comparison-000.jsonl", &|b| text(b).replacen("\"kind\":\"", "\"kind\":\"x", 1).into(), "no kind is named");
    spoil("data.json", &|b| text(b).replace("16", "17").into(), "another version");
    spoil("data.json", &|b| b[..20].to_vec(), "data.json");
    assert!(load(&folder.join("nowhere"), Split::Test).is_err());
    for bad in ["0/2", "3/2", "1", "a/b", "1/0"] {
        assert!(bad.parse::<Shard>().is_err(), "{bad}");
    }
}
