//! The two networks: shapes, seeds, statistics, gradients.

use burn::Tensor;
use burn::module::Module;
use burn::tensor::{Device, TensorData};
use taut_train::nets::init::SplitMix64;
use taut_train::nets::{
    Discriminator, DiscriminatorConfig, Generator, GeneratorConfig, GeneratorOutput, head_input, normalise,
};

fn random<const D: usize>(shape: [usize; D], seed: u64, device: &Device) -> Tensor<D> {
    let mut s = SplitMix64::new(seed);
    let values: Vec<f32> = (0..shape.iter().product()).map(|_| s.uniform()).collect();
    Tensor::from_data(TensorData::new(values, shape), device)
}

fn host<const D: usize>(t: Tensor<D>) -> Vec<f32> {
    t.into_data().try_into_vec().expect("f32")
}

fn generate(g: &Generator, batch: usize, seed: u64, device: &Device) -> GeneratorOutput {
    let pins = random([batch, 1, 32, 32], seed + 2, device).abs();
    g.forward(random([batch, 1024], seed, device), random([batch, 128], seed + 1, device), pins)
}

fn judge(d: &Discriminator, channels: usize, batch: usize, seed: u64, device: &Device) -> Tensor<2> {
    d.forward(random([batch, channels, 64, 64], seed, device), random([batch, 1024], seed + 1, device))
}

#[test]
fn the_generator_gives_a_field_and_a_fabric_in_tanh_range() {
    let device = Device::flex();
    for width in [1, 4, 16] {
        let g = GeneratorConfig { width, ..GeneratorConfig::default() }.init(3, &device).expect("width");
        let out = generate(&g, 3, 1, &device);
        assert_eq!((out.field.dims(), out.fabric.dims()), ([3, 4, 32, 32], [3, 5]));
        for v in host(out.field).into_iter().chain(host(out.fabric)) {
            assert!((-1.0..=1.0).contains(&v), "{v}");
        }
    }
    let g = GeneratorConfig::default().init(3, &device).expect("width");
    println!("generator parameters at width 16: {}", g.num_params());
    // 1152*128*25 + 128 of the first layer, and so on down the table of the module.
    assert_eq!(g.num_params(), GENERATOR_PARAMETERS);
}

/// Running statistics included, as burn counts them.
const GENERATOR_PARAMETERS: usize = {
    let w = 16;
    let first = 1152 * 8 * w * 25 + 8 * w;
    let skip = 8 * w * w + w;
    let second = 8 * w * 4 * w * 9 + 4 * w + 4 * 8 * w;
    let third = 5 * w * 2 * w * 9 + 2 * w + 4 * 5 * w;
    let fourth = 3 * w * w * 9 + w + 4 * 3 * w;
    let fifth = (2 * w + 1) * w * 9 + w + 4 * 2 * w;
    let sixth = (w + 1) * 4 * 9 + 4 + 4 * w;
    let fabric = 2048 * 5 + 5;
    let level = 2048 * 4 + 4;
    first + skip + second + third + fourth + fifth + sixth + fabric + level
};

#[test]
fn the_fabric_hears_the_words_and_not_the_noise() {
    let device = Device::flex();
    let g = GeneratorConfig::default().init(5, &device).expect("width");
    let (words, pins) = (random([1, 1024], 1, &device), random([1, 1, 32, 32], 2, &device).abs());
    let a = g.forward(words.clone(), random([1, 128], 3, &device), pins.clone());
    let b = g.forward(words, random([1, 128], 4, &device), pins.clone());
    let c = g.forward(random([1, 1024], 9, &device), random([1, 128], 4, &device), pins.clone());
    assert_eq!(host(a.fabric.clone()), host(b.fabric));
    assert_ne!(host(a.fabric), host(c.fabric));
    assert_ne!(host(a.field), host(b.field.clone()));
    let d = g.forward(random([1, 1024], 9, &device), random([1, 128], 4, &device), pins.mul_scalar(0.5));
    assert_ne!(host(c.field), host(d.field), "the pins matter");
}

#[test]
fn the_fabric_hears_the_sum_of_the_words_too_and_the_pattern_only_where_it_points() {
    let device = Device::flex();
    let g = GeneratorConfig { width: 4, levels: false, ..GeneratorConfig::default() }.init(5, &device).expect("width");
    let (words, noise) = (random([1, 1024], 1, &device), random([1, 128], 3, &device));
    let pins = random([1, 1, 32, 32], 2, &device).abs();
    let once = g.forward(words.clone(), noise.clone(), pins.clone());
    let twice = g.forward(words.clone().mul_scalar(2.0), noise, pins);
    for (a, b) in host(once.field).into_iter().zip(host(twice.field)) {
        assert!((a - b).abs() < 1e-5, "{a} {b}");
    }
    // in front of tanh: head(2 x) - head(x) is what the sum adds
    let part = g.fabric.weight.val().slice([1024..2048, 0..5]);
    let added = host(words.matmul(part));
    for ((a, b), added) in host(once.fabric).into_iter().zip(host(twice.fabric)).zip(added) {
        assert!((b.atanh() - a.atanh() - added).abs() < 1e-3, "{a} {b}");
    }
}

#[test]
fn the_level_of_the_field_hears_the_words_and_their_sum() {
    let device = Device::flex();
    let with = GeneratorConfig { width: 4, ..GeneratorConfig::default() }.init(5, &device).expect("width");
    let without = without_levels(&with);
    let (words, noise) = (random([1, 1024], 1, &device), random([1, 128], 3, &device));
    let pins = random([1, 1, 32, 32], 2, &device).abs();
    let pattern = host(without.forward(words.clone(), noise.clone(), pins.clone()).field);
    let heard = head_input(normalise(words.clone()), words.clone());
    assert_eq!(heard.dims(), [1, 2048]);
    let level = host(with.level.as_ref().expect("levels").forward(heard));
    let field = host(with.forward(words, noise, pins).field);
    for (i, (p, f)) in pattern.iter().zip(&field).enumerate() {
        let sum = (p.atanh() + level[i / 1024]).tanh();
        assert!((sum - f).abs() < 1e-4, "{i}: {sum} {f}");
    }
}

fn without_levels(g: &Generator) -> Generator {
    Generator { level: None, ..g.clone() }
}

#[test]
fn one_matrix_stands_for_all_and_the_whole_network_answers_the_same() {
    let device = Device::flex();
    let inputs = |seed| {
        let pins = random([2, 1, 32, 32], seed + 2, &device).abs();
        (random([2, 1024], seed, &device), random([2, 128], seed + 1, &device), pins)
    };
    for (one_matrix, pins) in [(true, false), (true, true), (false, false)] {
        let config = GeneratorConfig { width: 4, levels: false, one_matrix, pins };
        let g = config.init(7, &device).expect("width");
        let answer = |g: &Generator, distance: Tensor<4>| {
            let (words, noise, _) = inputs(3);
            host(g.forward(words, noise, distance).field)
        };
        let (_, _, distance) = inputs(3);
        let field = answer(&g, distance.clone());
        let same = |i: usize| field[i] == field[i % 1024 + i / 4096 * 4096];
        assert_eq!((0..field.len()).all(same), one_matrix, "{config:?}");
        assert_eq!(answer(&g, distance.clone() * 0.5) == field, !pins, "{config:?}");
        let whole = g.whole();
        assert_eq!(whole.sixth.deconvolution.weight.dims(), [5, 4, 3, 3]);
        for (a, b) in answer(&whole, distance).iter().zip(&field) {
            assert!((a - b).abs() < 1e-6, "{config:?}: {a} {b}");
        }
    }
}

#[test]
fn a_seed_is_a_network() {
    let device = Device::flex();
    let outputs = |seed| {
        let g = GeneratorConfig { width: 4, ..GeneratorConfig::default() }.init(seed, &device).expect("width");
        let d = DiscriminatorConfig { width: 4, ..Default::default() }.init(seed, &device).expect("width");
        (host(generate(&g, 2, 8, &device).field), host(judge(&d, 1, 2, 8, &device)))
    };
    let (a, b) = (outputs(11), std::thread::scope(|s| s.spawn(|| outputs(11)).join().expect("thread")));
    assert_eq!(a, b, "the same seed, another thread");
    let c = outputs(12);
    assert_ne!(a.0, c.0);
    assert_ne!(a.1, c.1);
}

#[test]
fn the_discriminator_judges_in_every_configuration() {
    let device = Device::flex();
    for (conditional, picture_channels) in [(false, 1), (false, 3), (true, 1)] {
        let config = DiscriminatorConfig { conditional, picture_channels, ..Default::default() };
        let d = config.init(1, &device).expect("configuration");
        println!("discriminator parameters, {config:?}: {}", d.num_params());
        let p = judge(&d, picture_channels, 3, 4, &device);
        assert_eq!(p.dims(), [3, 1]);
        assert!(host(p).iter().all(|p| *p > 0.0 && *p < 1.0));
    }
}

#[test]
fn only_a_conditional_discriminator_hears_the_words_and_it_weighs_them_against_the_picture() {
    let device = Device::flex();
    let (a, b) = (random([1, 1024], 5, &device), random([1, 1024], 6, &device));
    let (x, y) = (random([1, 1, 64, 64], 7, &device), random([1, 1, 64, 64], 8, &device));
    let plain = DiscriminatorConfig::default().init(1, &device).expect("configuration");
    assert_eq!(host(plain.forward(x.clone(), a.clone())), host(plain.forward(x.clone(), b.clone())));
    let d = DiscriminatorConfig { conditional: true, ..Default::default() }.init(1, &device).expect("configuration");
    let logit = |p: &Tensor<4>, w: &Tensor<2>| {
        let p = f64::from(host(d.forward(p.clone(), w.clone()))[0]);
        (p / (1.0 - p)).ln()
    };
    // Were picture and words only added, changing the words would move the logit alike for both pictures.
    let (on_x, on_y) = (logit(&x, &a) - logit(&x, &b), logit(&y, &a) - logit(&y, &b));
    assert!(on_x.abs() > 1e-5, "the words matter: {on_x}");
    assert!((on_x - on_y).abs() > 1e-3 * on_x.abs(), "{on_x} against {on_y}");
}

#[test]
fn batch_norm_follows_the_batches_in_training_and_rests_in_inference() {
    let device = Device::flex().autodiff();
    let g = GeneratorConfig { width: 4, ..GeneratorConfig::default() }.init(2, &device).expect("width");
    let statistics = |g: &Generator| {
        let g = g.valid();
        (host(g.second.norm.running_mean.value()), host(g.fifth.norm.running_var.value()))
    };
    let before = statistics(&g);
    assert!(before.0.iter().all(|m| *m == 0.0) && before.1.iter().all(|v| *v == 1.0));
    generate(&g, 8, 1, &device);
    // The input of the second layer's normalisation, by hand: the running mean moves a tenth of the way to its mean.
    let v = Tensor::cat(vec![normalise(random([8, 1024], 1, &device)), random([8, 128], 2, &device)], 1);
    let a1 = burn::tensor::activation::relu(g.first.forward(v.reshape([8, 1152, 1, 1])));
    let expected = host(a1.mean_dims(&[0, 2, 3]).reshape([32]));
    let after = statistics(&g);
    for (m, e) in after.0.iter().zip(&expected) {
        assert!((m - 0.1 * e).abs() < 1e-6, "{m} against a tenth of {e}");
    }
    assert_ne!(before.1, after.1);

    let (inference, plain) = (g.valid(), Device::flex());
    let one = host(generate(&inference, 1, 3, &plain).field);
    let again = host(generate(&inference, 1, 3, &plain).field);
    assert_eq!(one, again);
    assert_eq!(statistics(&inference), after, "inference leaves the statistics alone");
    // In inference a sample does not depend on its company.
    let pins = Tensor::cat(vec![random([1, 1, 32, 32], 5, &plain).abs(); 2], 0);
    let words = Tensor::cat(vec![random([1, 1024], 3, &plain), random([1, 1024], 77, &plain)], 0);
    let noise = Tensor::cat(vec![random([1, 128], 4, &plain); 2], 0);
    let both = host(inference.forward(words, noise, pins).field);
    for (a, b) in one.iter().zip(&both) {
        assert!((a - b).abs() < 1e-5, "{a} against {b}");
    }
}

#[test]
fn every_weight_of_both_networks_gets_a_gradient() {
    let device = Device::flex().autodiff();
    let g = GeneratorConfig { width: 4, ..GeneratorConfig::default() }.init(2, &device).expect("width");
    let out = generate(&g, 4, 1, &device);
    let loss = out.field.square().mean() + out.fabric.square().mean() + g.squared_weights().mul_scalar(1e-4);
    let grads = loss.backward();
    let some = |name: &str, grad: Option<Vec<f32>>| {
        let grad = grad.unwrap_or_else(|| panic!("{name} has no gradient"));
        assert!(grad.iter().any(|x| *x != 0.0) && grad.iter().all(|x| x.is_finite()), "{name}");
    };
    some("first", g.first.weight.val().grad(&grads).map(host));
    some("skip", g.skip.weight.val().grad(&grads).map(host));
    some("fabric", g.fabric.weight.val().grad(&grads).map(host));
    let layers = [&g.second, &g.third, &g.fourth, &g.fifth, &g.sixth];
    for (name, layer) in ["second", "third", "fourth", "fifth", "sixth"].into_iter().zip(layers) {
        some(name, layer.deconvolution.weight.val().grad(&grads).map(host));
        some(name, layer.norm.gamma.val().grad(&grads).map(host));
    }
    let config = DiscriminatorConfig { width: 4, conditional: true, ..Default::default() };
    let d = config.init(2, &device).expect("configuration");
    let grads = judge(&d, 1, 4, 6, &device).sub_scalar(1.0).square().mean().backward();
    for (i, m) in d.modules.iter().enumerate() {
        some(&format!("module {i}"), m.convolution.weight.val().grad(&grads).map(host));
    }
    let c = d.condition.as_ref().expect("conditional");
    some("projection", c.projection.weight.val().grad(&grads).map(host));
    some("connected", d.connected.weight.val().grad(&grads).map(host));
}

#[test]
fn the_sum_of_squares_counts_kernels_and_matrices() {
    let device = Device::flex();
    let g = GeneratorConfig { width: 1, ..GeneratorConfig::default() }.init(2, &device).expect("width");
    let mut expected = 0.0f64;
    let mut add = |v: Vec<f32>| expected += v.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>();
    add(host(g.first.weight.val()));
    add(host(g.skip.weight.val()));
    add(host(g.fabric.weight.val()));
    add(host(g.level.as_ref().expect("levels").weight.val()));
    for l in [&g.second, &g.third, &g.fourth, &g.fifth, &g.sixth] {
        add(host(l.deconvolution.weight.val()));
    }
    let sum = f64::from(host(g.squared_weights())[0]);
    assert!((sum / expected - 1.0).abs() < 1e-5, "{sum} against {expected}");
}
