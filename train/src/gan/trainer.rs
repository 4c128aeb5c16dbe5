use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use burn::Tensor;
use burn::grad_clipping::GradientClippingConfig;
use burn::module::{Module, Param};
use burn::optim::{AdamConfig, GradientsParams, ModuleOptimizer};
use burn::tensor::{Device, TensorData};
use serde::Serialize;
use taut::noise;

use super::gradient::gradient_norm;
use super::measure::{resampling, roughness, strains};
use super::pins::{pin_map, random_pins};
use super::{Adversary, Checkpoint, Dataset, Example, Ratings, TrainConfig, TrainError};
use super::{head, weight_penalty};
use crate::cloth::{self, equilibrium};
use crate::image::{
    AugmentBatch, AugmentConfig, Renderer, SheetLayout, augment_images, nmse, render_images, write_sheet,
};
use crate::nets::{
    CHANNELS, DESCRIPTION, Discriminator, DiscriminatorConfig, FABRIC, GRID, Generator, GeneratorOutput, NOISE,
};

/// Share of the first weights of the last layer that is left where levels are there from the start.
const PATTERN_START: f64 = 0.1;

/// What a step trains on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// The field.
    Matching,
    /// Positions and stretch.
    Positions,
    /// The paper's game.
    Adversarial,
}

/// The losses of a step; what a stage does not have is 0.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Losses {
    /// What the generator minimised.
    pub generator: f64,
    /// Of the discriminator (eq. 15).
    pub discriminator: f64,
    /// Adversarial (eq. 20), before alpha.
    pub adversarial: f64,
    /// L2 (eq. 18), before beta.
    pub weights: f64,
    /// Field against what the words mean, in tanh's range.
    pub field: f64,
    /// Fabric numbers, likewise.
    pub fabric: f64,
    /// Mean square of what ln(K) differs more between neighbours than the words say.
    pub roughness: f64,
    /// Positions: mean squared distance in mm^2.
    pub position_mm2: f64,
    /// Stretch: root mean square difference in percent.
    pub stretch_pct: f64,
    /// Pictures: mean squared difference.
    pub picture: f64,
    /// Length of the generator's gradient before it is clipped.
    pub gradient_norm: f64,
    /// Length of the discriminator's gradient.
    pub discriminator_gradient_norm: f64,
}

/// How near the generated pictures of the evaluation set are.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    /// Mean NMSE.
    pub nmse: f64,
    /// That of each scene.
    pub by_scene: BTreeMap<&'static str, f64>,
}

/// A training run in memory.
pub struct Trainer {
    config: TrainConfig,
    data: Dataset,
    renderer: Arc<Renderer>,
    device: Device,
    generator: Generator,
    discriminator: Discriminator,
    generator_optimizer: ModuleOptimizer,
    discriminator_optimizer: ModuleOptimizer,
    /// Steps done.
    pub step: usize,
}

/// The inputs of a batch as tensors.
struct Batch {
    words: Tensor<2>,
    noise: Tensor<2>,
    pins: Tensor<4>,
    field: Tensor<4>,
    fabric: Tensor<2>,
}

impl Trainer {
    /// A run at its start.
    pub fn new(config: &TrainConfig, data: Dataset, renderer: Arc<Renderer>) -> Result<Trainer, TrainError> {
        config.check()?;
        let device = Device::flex().autodiff();
        let adam = AdamConfig::new().with_beta_1(config.beta1).with_epsilon(1e-8);
        let clip = (config.gradient_clip > 0.0).then_some(GradientClippingConfig::Norm(config.gradient_clip));
        let clipped = adam.clone().with_grad_clipping(clip);
        let generator = config.generator().init(config.seed, &device);
        let discriminator = DiscriminatorConfig {
            width: config.discriminator_width,
            picture_channels: config.picture.len(),
            conditional: config.conditional,
            ..DiscriminatorConfig::default()
        }
        .init(config.seed ^ 0xd15c, &device);
        let mut generator = generator.map_err(TrainError::part)?;
        if config.steps.matching > 0 {
            let [fabric, level] = head::fit(&data)?;
            fabric.set(&mut generator.fabric, &device);
            if let Some(head) = &mut generator.level {
                level.set(head, &device);
                // the pattern begins small beside the levels
                let pattern = &mut generator.sixth.deconvolution;
                // as data, so that the product is no part of the gradient
                pattern.weight = Param::from_data((pattern.weight.val() * PATTERN_START).into_data(), &device);
                pattern.bias =
                    pattern.bias.take().map(|b| Param::from_data((b.val() * PATTERN_START).into_data(), &device));
            }
        }
        Ok(Trainer {
            config: config.clone(),
            data,
            renderer,
            device,
            generator,
            discriminator: discriminator.map_err(TrainError::part)?,
            generator_optimizer: clipped.init(),
            discriminator_optimizer: adam.init(),
            step: 0,
        })
    }

    /// The generator as it stands.
    pub fn generator(&self) -> &Generator {
        &self.generator
    }

    /// The data.
    pub fn data(&self) -> &Dataset {
        &self.data
    }

    /// The stage of the next step.
    pub fn stage(&self) -> Stage {
        let s = &self.config.steps;
        match self.step {
            n if n < s.matching => Stage::Matching,
            n if n < s.matching + s.positions => Stage::Positions,
            _ => Stage::Adversarial,
        }
    }

    /// Step size of the next step: constant in the first stage; then halved every few epochs from its end on.
    pub fn rate(&self) -> f64 {
        if self.stage() == Stage::Matching {
            // down over the stage, so that the next one starts calm
            let share = self.step as f64 / self.config.steps.matching.max(1) as f64;
            return self.config.matching_rate * self.config.matching_end.powf(share);
        }
        let pictures = (self.step - self.config.steps.matching) * self.config.batch;
        let halvings = pictures / (self.config.epoch_pictures * self.config.halve_every_epochs);
        self.config.learning_rate * 0.5f64.powi(halvings as i32)
    }

    /// Weight of the smoothness: grows over the first stage. In full from the start it would be all that the net learns,
    /// since Adam scales its steps by the gradients of the last thousand.
    fn smoothness(&self) -> f64 {
        let share = self.step as f64 / self.config.steps.matching.max(1) as f64;
        self.config.smoothness * share.min(1.0)
    }

    /// One step.
    pub fn advance(&mut self) -> Result<Losses, TrainError> {
        let losses = match self.stage() {
            Stage::Matching => self.match_fields()?,
            Stage::Positions => self.match_positions()?,
            Stage::Adversarial => self.play()?,
        };
        for (loss, name) in [(losses.generator, "generator"), (losses.discriminator, "discriminator")] {
            if !loss.is_finite() {
                return Err(TrainError::Diverged { step: self.step, loss: name });
            }
        }
        self.step += 1;
        Ok(losses)
    }

    /// A number in 0..n for this step.
    fn draw(&self, stream: u64, i: usize, n: usize) -> usize {
        let seed = self.config.seed ^ (stream << 32) ^ self.step as u64;
        (noise::bits(seed, i as u32) % n as u64) as usize
    }

    /// The inputs for some fabrics, words and pins; `draws` number the noise.
    fn batch<'a>(
        &self,
        items: impl Iterator<Item = (&'a taut_lab::fabric::Fabric, &'a str, Vec<usize>)>,
        draws: impl Fn(usize) -> Vec<f32>,
        device: &Device,
    ) -> Batch {
        let (mut words, mut noises, mut pins, mut fields, mut fabrics) = (vec![], vec![], vec![], vec![], vec![]);
        let mut n = 0;
        for (fabric, text, pinned) in items {
            let z = draws(n);
            let (field, numbers) = self.data.target(fabric, &z);
            words.extend(self.data.describe(text));
            noises.extend(z);
            pins.extend(pin_map(&pinned));
            fields.extend(field);
            fabrics.extend(numbers);
            n += 1;
        }
        let two = |v, m| Tensor::<2>::from_data(TensorData::new(v, [n, m]), device);
        Batch {
            words: two(words, DESCRIPTION),
            noise: two(noises, NOISE),
            pins: Tensor::from_data(TensorData::new(pins, [n, 1, GRID, GRID]), device),
            field: Tensor::from_data(TensorData::new(fields, [n, CHANNELS, GRID, GRID]), device),
            fabric: two(fabrics, FABRIC),
        }
    }

    /// Steps down the loss; the length of its gradient.
    fn update_generator(&mut self, loss: &Tensor<1>) -> f64 {
        let gradients = GradientsParams::from_grads(loss.backward(), &self.generator);
        let norm = gradient_norm(&self.generator, &gradients);
        self.generator = self.generator_optimizer.step(self.rate(), self.generator.clone(), gradients);
        norm
    }

    fn match_fields(&mut self) -> Result<Losses, TrainError> {
        let b = self.config.batch;
        let drawn: Vec<_> = (0..b).map(|i| self.data.streamed((self.step * b + i) as u32)).collect();
        let scenes: Vec<_> = (0..b).map(|i| random_pins(self.draw(1, i, usize::MAX) as u64)).collect();
        let first = (self.step * b) as u64;
        let items = drawn.iter().zip(scenes).map(|((f, w), pins)| (f, w.as_str(), pins));
        let batch = self.batch(items, |i| self.data.noise(first + i as u64), &self.device);
        let out = self.generator.forward(batch.words, batch.noise, batch.pins);
        let told = self.told(out, &batch.field, &batch.fabric);
        let gradient_norm = self.update_generator(&told.loss);
        Ok(Losses { generator: scalar(&told.loss), gradient_norm, ..told.losses() })
    }

    /// How far what the net tells is from what the words mean: the loss of the first stage, the prior of the others.
    fn told(&self, out: GeneratorOutput, field: &Tensor<4>, fabric: &Tensor<2>) -> Told {
        let slopes = self.data.codings().0.map(|c| c.line().1 as f32);
        let slopes = Tensor::<4>::from_data(TensorData::new(slopes.to_vec(), [1, CHANNELS, 1, 1]), &self.device);
        let off = out.field - field.clone();
        let roughness = roughness(off.clone() * slopes);
        let field = off.square().mean();
        let fabric = (out.fabric - fabric.clone()).square().mean();
        let loss = field.clone() + fabric.clone() + roughness.clone() * self.smoothness();
        Told { field, fabric, roughness, loss }
    }

    /// Examples of this step, of scenes that fold too or not; the cloth of each at one of the substeps, and the noise's numbers.
    fn examples(&self, folds: bool) -> (Vec<&Example>, Vec<cloth::Scene>) {
        let of: Vec<&Example> = self.data.training.iter().filter(|e| folds || !e.scene.folds()).collect();
        let chosen: Vec<&Example> = (0..self.config.batch).map(|i| of[self.draw(2, i, of.len())]).collect();
        let cloths =
            chosen.iter().enumerate().map(|(i, e)| e.cloths[self.draw(3, i, e.cloths.len())].clone()).collect();
        (chosen, cloths)
    }

    /// Positions at rest [batch, particles, 3] of generated fields in tanh's range.
    fn hang(&self, field: Tensor<4>, cloths: &mut [cloth::Scene]) -> Result<Tensor<3>, TrainError> {
        let device = field.device();
        let [b, channels, _, _] = field.dims();
        let g = self.config.grid;
        let (offsets, slopes): (Vec<f32>, Vec<f32>) =
            self.data.codings().0.iter().map(|c| c.line()).map(|(offset, slope)| (offset as f32, slope as f32)).unzip();
        let column = |v: Vec<f32>| Tensor::<4>::from_data(TensorData::new(v, [1, CHANNELS, 1, 1]), &device);
        let k = (field * column(slopes) + column(offsets)).exp();
        let m = resampling(g);
        let left = Tensor::<3>::from_data(TensorData::new(m.clone(), [1, g, GRID]), &device);
        let right = left.clone().swap_dims(1, 2);
        let flat = k.reshape([b * channels, GRID, GRID]);
        let small = left.expand([b * channels, g, GRID]).matmul(flat);
        let small = small.matmul(right.expand([b * channels, GRID, g]));
        equilibrium(small.reshape([b, channels, g, g]), cloths).map_err(TrainError::part)
    }

    fn references(&self, chosen: &[&Example], device: &Device) -> Tensor<3> {
        let all: Vec<f32> = chosen.iter().flat_map(|e| e.reference.iter().copied()).collect();
        let shape = [chosen.len(), self.config.grid * self.config.grid, 3];
        Tensor::from_data(TensorData::new(all, shape), device)
    }

    /// Mean square of the distances in m^2 and of the differences of strains, of shapes against the references.
    fn shape(&self, x: Tensor<3>, chosen: &[&Example]) -> [Tensor<1>; 2] {
        let g = self.config.grid;
        let reference = self.references(chosen, &self.device);
        let position = (x.clone() - reference.clone()).square().sum_dim(2).mean();
        [position, (strains(x, g) - strains(reference, g)).square().mean()]
    }

    fn match_positions(&mut self) -> Result<Losses, TrainError> {
        let (chosen, mut cloths) = self.examples(false);
        let first = (self.step * self.config.batch) as u64;
        let items = chosen.iter().map(|e| (&e.fabric, e.words.as_str(), pins_of(e)));
        let batch = self.batch(items, |i| self.data.noise(first + i as u64), &self.device);
        let out = self.generator.forward(batch.words, batch.noise, batch.pins);
        let x = self.hang(out.field.clone(), &mut cloths)?;
        let [position, stretch] = self.shape(x, &chosen);
        let told = self.told(out, &batch.field, &batch.fabric);
        let loss = position.clone() * self.config.position_weight
            + stretch.clone() * self.config.stretch_weight
            + told.loss.clone() * self.config.prior;
        let gradient_norm = self.update_generator(&loss);
        Ok(Losses {
            generator: scalar(&loss),
            gradient_norm,
            position_mm2: 1e6 * scalar(&position),
            stretch_pct: 100.0 * scalar(&stretch).sqrt(),
            ..told.losses()
        })
    }

    fn play(&mut self) -> Result<Losses, TrainError> {
        let (chosen, mut cloths) = self.examples(true);
        let b = self.config.batch;
        let first = (self.step * b) as u64;
        let items = chosen.iter().map(|e| (&e.fabric, e.words.as_str(), pins_of(e)));
        let batch = self.batch(items, |i| self.data.noise(first + i as u64), &self.device);
        let out = self.generator.forward(batch.words.clone(), batch.noise, batch.pins);
        let x = self.hang(out.field.clone(), &mut cloths)?;
        // the distances mean nothing where folds bifurcate
        let off = (self.config.shape > 0.0).then(|| self.shape(x.clone(), &chosen));
        let fake = render_images(&self.renderer, seen(x, &chosen)).map_err(TrainError::part)?;

        // the same augmentations and noise for both sides, drawn anew for each
        let config = AugmentConfig { noise: self.config.picture_noise, ..AugmentConfig::default() };
        let draw = |side: u64| {
            AugmentBatch::draw(&config, &self.config.picture, self.config.seed ^ side, first, b)
                .map_err(TrainError::part)
        };
        let real: Vec<f32> = chosen.iter().flat_map(|e| e.picture.iter().copied()).collect();
        let shape = [b, self.config.picture.len(), crate::image::SIDE, crate::image::SIDE];
        let plain = Tensor::<4>::from_data(TensorData::new(real, shape), &self.device);
        let real = augment_images(&Arc::new(draw(0x5ea1)?), plain.clone()).map_err(TrainError::part)?;
        let shown = augment_images(&Arc::new(draw(0xfa4e)?), fake.clone()).map_err(TrainError::part)?;

        let ratings = Ratings {
            real: self.discriminator.forward(real, batch.words.clone()),
            generated: self.discriminator.forward(shown.clone().detach(), batch.words.clone()),
        };
        let adversary = Adversary { loss: self.config.adversarial_loss, labels: self.config.labels };
        let judged = adversary.discriminator(&ratings);
        let gradients = GradientsParams::from_grads(judged.backward(), &self.discriminator);
        let discriminator_gradient_norm = gradient_norm(&self.discriminator, &gradients);
        self.discriminator = self.discriminator_optimizer.step(self.rate(), self.discriminator.clone(), gradients);

        let adversarial = adversary.generator(self.discriminator.forward(shown, batch.words));
        let samples = self.data.training.len();
        let weights = weight_penalty(self.generator.squared_weights(), self.config.phi, samples);
        let picture = (fake - plain).square().mean();
        let told = self.told(out, &batch.field, &batch.fabric);
        let mut loss = adversarial.clone() * self.config.alpha
            + weights.clone() * self.config.beta
            + picture.clone() * self.config.paired
            + told.loss.clone() * self.config.prior;
        if let Some([position, stretch]) = &off {
            let [p, s] = [self.config.position_weight, self.config.stretch_weight].map(|w| w * self.config.shape);
            loss = loss + position.clone() * p + stretch.clone() * s;
        }
        let [position, stretch] = off.map_or([0.0; 2], |both| both.map(|x| scalar(&x)));
        let gradient_norm = self.update_generator(&loss);
        Ok(Losses {
            generator: scalar(&loss),
            gradient_norm,
            discriminator_gradient_norm,
            position_mm2: 1e6 * position,
            stretch_pct: 100.0 * stretch.sqrt(),
            discriminator: scalar(&judged),
            adversarial: scalar(&adversarial),
            weights: scalar(&weights),
            picture: scalar(&picture),
            ..told.losses()
        })
    }

    /// Brings the running statistics of the normalisations, which inference uses, up to the weights as they are: passes over
    /// fabrics of the stream that change no weight. The running mean of training lags behind the weights and, in the last
    /// stages, comes from a few fabrics only.
    pub fn calibrate(&mut self) {
        const PASSES: u32 = 64;
        let b = self.config.batch as u32;
        for pass in 0..PASSES {
            // the last numbers of the stream: training takes the first
            let first = u32::MAX - (pass + 1) * b;
            let drawn: Vec<_> = (0..b).map(|i| self.data.streamed(first + i)).collect();
            let pins = |i: u32| random_pins(noise::bits(self.config.seed ^ 0xca1b, first + i));
            let items = drawn.iter().zip(0..).map(|((f, w), i)| (f, w.as_str(), pins(i)));
            let batch = self.batch(items, |i| self.data.noise(u64::from(first) + i as u64), &self.device);
            self.generator.forward(batch.words, batch.noise, batch.pins);
        }
        // `valid` is what takes the statistics over
        self.generator = self.generator.valid().train();
    }

    /// Root mean square error of ln(K) of warp, weft and shear over the evaluation fabrics as inference has it, each
    /// without noise and pins.
    pub fn field_error(&self) -> Result<f64, TrainError> {
        let device = Device::flex();
        let items = self.data.evaluation.iter().map(|e| (&e.fabric, e.words.as_str(), vec![]));
        let batch = self.batch(items, |_| vec![0.0; NOISE], &device);
        let out = self.generator.valid().forward(batch.words, batch.noise, batch.pins);
        let off = (out.field - batch.field).square().mean_dim(0).mean_dim(2).mean_dim(3);
        let off: Vec<f32> = off.into_data().try_into_vec().map_err(|e| TrainError::Part(format!("{e:?}")))?;
        let slopes = self.data.codings().0.map(|c| c.line().1);
        Ok((off.iter().zip(slopes).take(3).map(|(o, s)| f64::from(*o) * s * s).sum::<f64>() / 3.0).sqrt())
    }

    /// Score of the evaluation set: mean NMSE of the generated pictures against the references (paper, VI.B, 9), with the
    /// noise at zero; writes a sheet of real and generated pictures if a path is given.
    pub fn evaluate(&self, sheet: Option<&Path>) -> Result<Score, TrainError> {
        let device = Device::flex();
        let chosen: Vec<&Example> = self.data.evaluation.iter().collect();
        let items = chosen.iter().map(|e| (&e.fabric, e.words.as_str(), pins_of(e)));
        let batch = self.batch(items, |_| vec![0.0; NOISE], &device);
        let out = self.generator.valid().forward(batch.words, batch.noise, batch.pins);
        // the middle of the substeps: a game's step
        let mut cloths: Vec<_> = chosen.iter().map(|e| e.cloths[e.cloths.len() / 2].clone()).collect();
        let x = self.hang(out.field, &mut cloths)?;
        let generated = render_images(&self.renderer, seen(x, &chosen)).map_err(TrainError::part)?;
        let generated: Vec<f32> =
            generated.into_data().try_into_vec().map_err(|e| TrainError::Part(format!("{e:?}")))?;
        let real: Vec<f32> = chosen.iter().flat_map(|e| e.picture.iter().copied()).collect();
        let len = self.renderer.image_len();
        let mut by_scene: BTreeMap<&'static str, Vec<f64>> = BTreeMap::new();
        for ((real, generated), e) in real.chunks_exact(len).zip(generated.chunks_exact(len)).zip(&chosen) {
            by_scene.entry(e.scene.name()).or_default().push(nmse(real, generated).map_err(TrainError::part)?);
        }
        if let Some(path) = sheet {
            let layout = SheetLayout { channels: self.config.picture.len(), pairs_per_row: 4, zoom: 2 };
            write_sheet(path, &real, &generated, layout).map_err(TrainError::part)?;
        }
        let mean = by_scene.values().flatten().sum::<f64>() / chosen.len() as f64;
        let of = |all: &Vec<f64>| all.iter().sum::<f64>() / all.len() as f64;
        Ok(Score { nmse: mean, by_scene: by_scene.iter().map(|(name, all)| (*name, of(all))).collect() })
    }

    /// Writes everything that a resumed run needs.
    pub fn save(&self, run: &Path, best: Option<(f64, usize)>) -> Result<(), TrainError> {
        let state = Checkpoint { step: self.step, best, digest: self.config.digest()? };
        state.write(run, |folder| {
            let file = |name: &str| folder.join(name);
            let part = |e: burn::store::RecordError| TrainError::file(folder, format!("{e:?}"));
            // `valid` first: it brings the running statistics up to the last step, which a clone does not
            self.generator.valid().save_file(file("generator.bpk")).map_err(part)?;
            self.discriminator.valid().save_file(file("discriminator.bpk")).map_err(part)?;
            self.generator_optimizer.save(file("generator_adam.bpk")).map_err(part)?;
            self.discriminator_optimizer.save(file("discriminator_adam.bpk")).map_err(part)
        })
    }

    /// Goes on from a checkpoint of the run. `state` was read by [`Checkpoint::read`].
    pub fn resume(&mut self, run: &Path, state: &Checkpoint) -> Result<(), TrainError> {
        if state.digest != self.config.digest()? {
            return Err(TrainError::Config(format!(
                "{} holds a run of another configuration; choose another folder",
                run.display()
            )));
        }
        let folder = Checkpoint::folder(run);
        let file = |name: &str| folder.join(name);
        let part = |e: burn::store::RecordError| TrainError::file(&folder, format!("{e:?}"));
        self.generator = self.generator.clone().try_load_file(file("generator.bpk")).map_err(part)?;
        self.discriminator = self.discriminator.clone().try_load_file(file("discriminator.bpk")).map_err(part)?;
        self.generator_optimizer = self.generator_optimizer.clone().load(file("generator_adam.bpk")).map_err(part)?;
        self.discriminator_optimizer =
            self.discriminator_optimizer.clone().load(file("discriminator_adam.bpk")).map_err(part)?;
        self.step = state.step;
        Ok(())
    }

    /// Writes the weights of the generator alone.
    pub fn save_generator(&self, path: &Path) -> Result<(), TrainError> {
        self.generator.valid().save_file(path).map_err(|e| TrainError::file(path, format!("{e:?}")))
    }

    /// Reads weights of the generator.
    pub fn load_generator(&mut self, path: &Path) -> Result<(), TrainError> {
        let loaded = self.generator.clone().try_load_file(path);
        self.generator = loaded.map_err(|e| TrainError::file(path, format!("{e:?}")))?;
        Ok(())
    }
}

/// What the net tells against what the words mean.
struct Told {
    /// Field, in tanh's range.
    field: Tensor<1>,
    /// Fabric numbers, in tanh's range.
    fabric: Tensor<1>,
    /// See [`Losses::roughness`].
    roughness: Tensor<1>,
    /// Their weighted sum.
    loss: Tensor<1>,
}

impl Told {
    fn losses(&self) -> Losses {
        Losses {
            field: scalar(&self.field),
            fabric: scalar(&self.fabric),
            roughness: scalar(&self.roughness),
            ..Losses::default()
        }
    }
}

fn scalar(t: &Tensor<1>) -> f64 {
    f64::from(t.clone().into_scalar::<f32>())
}

fn pins_of(e: &Example) -> Vec<usize> {
    // at the net's own resolution
    e.scene.pins(GRID, e.draw)
}

/// Positions [batch, particles, 3] as the camera has them.
fn seen(x: Tensor<3>, examples: &[&Example]) -> Tensor<3> {
    let views: Vec<_> = examples.iter().map(|e| e.scene.view()).collect();
    let (device, b) = (x.device(), views.len());
    let scales = TensorData::new(views.iter().map(|v| v.scale).collect::<Vec<f32>>(), [b, 1, 1]);
    let shifts = TensorData::new(views.iter().flat_map(|v| v.shift_m).collect::<Vec<f32>>(), [b, 1, 3]);
    x * Tensor::from_data(scales, &device) + Tensor::from_data(shifts, &device)
}
