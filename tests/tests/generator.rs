//! The generator that ships: words matter, and its field keeps the cloth from over-stretching.

use std::sync::LazyLock;

use taut::Budget;
use taut_lab::compare::{Case, Outcome, Setting, run};
use taut_lab::fabric::Fabric;
use taut_lab::metrics::median;
use taut_lab::scene::Scene;
use taut_onnx::{Correction, Generator, Request};

static GENERATOR: LazyLock<Generator> =
    LazyLock::new(|| Generator::from_bytes(include_bytes!("../../onnx/generator.onnx")).expect("the file that ships"));

fn ask(description: &str, scene: Scene, seed: u64) -> Correction {
    let pins: Vec<(usize, usize)> = scene.pins(32, 32).into_iter().map(|p| (p / 32, p % 32)).collect();
    GENERATOR.correct(&Request { seed, pins: &pins, ..Request::new(description) }).expect(description)
}

/// Medians of warp, weft and shear in N/m.
fn medians(c: &Correction) -> [f32; 3] {
    [0, 1, 2].map(|channel| median(&c.field.index_axis(ndarray::Axis(0), channel).iter().copied().collect::<Vec<_>>()))
}

fn hang(description: &str, scene: Scene, substeps: u32) -> [Outcome; 3] {
    let correction = ask(description, scene, 0);
    let case = Case {
        scene,
        rows: 32,
        columns: 32,
        size_m: [1.0, 1.0],
        rate_hz: 60.0,
        substeps,
        budget: Budget::Tuned,
        density_kg_m2: correction.density_kg_m2,
        seconds: 8.0,
        hinge_rigidity_n_m: correction.hinge_rigidity_n_m,
        seed: 0,
    };
    let fabric = Fabric::named(description).expect("a fabric that the tables know");
    [Setting::Reference(fabric), Setting::Uniform, Setting::Generated(correction.field.iter().copied().collect())]
        .map(|setting| run(&case, &setting, |_| ()).expect("a good case"))
}

#[test]
fn stiffness_and_density_stand_in_the_order_of_the_fabrics() {
    let [denim, silk, jersey] = ["denim", "silk", "jersey knit"].map(|d| ask(d, Scene::Hang2, 0));
    let (a, b, c) = (medians(&denim), medians(&silk), medians(&jersey));
    for (channel, name) in ["warp", "weft"].into_iter().enumerate() {
        assert!(a[channel] > b[channel] && b[channel] > c[channel], "{name}: {a:?} {b:?} {c:?}");
    }
    let density = [silk.density_kg_m2, jersey.density_kg_m2, denim.density_kg_m2];
    assert!(density[0] < density[1] && density[1] < density[2], "{density:?}");
}

#[test]
fn one_word_says_the_measured_density() {
    // a description of one word once was a longer vector than others, and denim was told too heavy by 40 %
    let (told, measured) = (ask("denim", Scene::Hang2, 0).density_kg_m2, 0.324);
    assert!((told / measured - 1.0f32).abs() < 0.15, "{told}");
}

#[test]
fn words_that_modify_act() {
    let [heavy, plain, light] = ["heavy denim", "denim", "light denim"].map(|d| ask(d, Scene::Hang2, 0));
    assert!(heavy.density_kg_m2 > plain.density_kg_m2 && plain.density_kg_m2 > light.density_kg_m2);
}

#[test]
fn a_seed_gives_a_field_and_the_same_seed_the_same_bytes() {
    let [first, again, other] = [3, 3, 4].map(|seed| ask("heavy blue denim", Scene::Hang2, seed));
    assert_eq!(first.to_baked().expect("a field"), again.to_baked().expect("a field"));
    assert_ne!(first.field, other.field);
    let (a, b) = (medians(&first), medians(&other));
    for (a, b) in a.iter().zip(b) {
        assert!((a / b).ln().abs() < 0.7, "another seed is the same fabric: {a} against {b}");
    }
}

#[test]
fn the_field_keeps_the_cloth_from_over_stretching() {
    for description in ["denim", "cotton jersey t-shirt", "rib knit", "sweatshirt", "swimsuit"] {
        let [reference, uniform, generated] = hang(description, Scene::Hang2, 16).map(|o| o.stretch_pct);
        println!("{description}: reference {reference:?} uniform {uniform:?} generated {generated:?}");
        assert!((14.0..=17.0).contains(&uniform.max), "uniform {}", uniform.max);
        assert!(generated.max <= 1.25 * reference.max + 1.0, "{description}: {} of {}", generated.max, reference.max);
        assert!(generated.ex_pin_max <= uniform.ex_pin_max + 2.0, "{description}: {}", generated.ex_pin_max);
    }
    // stiff wovens
    for description in ["polyester tablecloth", "cotton", "linen", "canvas"] {
        for (substeps, most) in [(16, 4.0), (32, 2.2)] {
            let [_, uniform, generated] = hang(description, Scene::Hang2, substeps).map(|o| o.stretch_pct);
            println!("{description} x {substeps}: {generated:?}");
            assert!(generated.max <= most, "{description} at {substeps} substeps: {}", generated.max);
            assert!(generated.ex_pin_max <= uniform.ex_pin_max + 2.0, "{description}: {}", generated.ex_pin_max);
        }
    }
}

#[test]
fn a_cloth_on_its_edge_stretches_less_than_uniform_k() {
    // uniform K has 2.0 % and, with the inertia field, 1.1 %
    for description in ["denim", "polyester tablecloth", "cotton jersey t-shirt"] {
        let [_, _, edge] = hang(description, Scene::Edge, 16).map(|o| o.stretch_pct);
        println!("{description}: {edge:?}");
        assert!(edge.max <= 1.3, "{description}: {}", edge.max);
    }
}

#[test]
fn on_one_corner_soft_fabrics_stretch_as_the_reference_and_stiff_ones_as_the_step_allows() {
    for description in ["denim", "cotton jersey t-shirt", "rib knit", "swimsuit"] {
        let [reference, _, generated] = hang(description, Scene::Hang1, 16).map(|o| o.stretch_pct);
        println!("{description}: reference {reference:?} generated {generated:?}");
        assert!(generated.max <= 2.0 * reference.max, "{description}: {} of {}", generated.max, reference.max);
    }
    // 0.5 % cannot be had at this step: uniform K with the inertia field has 5.2 %
    let [_, _, generated] = hang("polyester tablecloth", Scene::Hang1, 16).map(|o| o.stretch_pct);
    assert!(generated.max <= 5.2, "tablecloth: {}", generated.max);
}

#[test]
fn drapes_differ_after_the_budget() {
    let ends = ["denim", "silk", "jersey knit"].map(|d| {
        let [_, _, generated] = hang(d, Scene::Hang2, 16);
        assert!(generated.finite);
        generated.positions
    });
    for (a, b) in [(0, 1), (0, 2), (1, 2)] {
        let distance = |(p, q): (&[f32; 3], &[f32; 3])| (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f32>().sqrt();
        let mean = ends[a].iter().zip(&ends[b]).map(distance).sum::<f32>() / ends[a].len() as f32;
        assert!(mean > 0.001, "drapes {a} and {b} differ by {mean} m on average");
    }
}
