//! The training set: fabrics with their words, how the reference cloth of each hangs, and what the net shall say.

use std::sync::Arc;

use taut::noise;
use taut_lab::compare::{self, Case, Setting};
use taut_lab::fabric::{self, Fabric, KINDS};

use super::{Reference, TrainConfig, TrainError};
use crate::cloth::{self, SceneDef, Springs};
use crate::data::{Scene, Split, piece, settled};
use crate::export::ExportMeta;
use crate::image::Renderer;
use crate::nets::{CHANNELS, DESCRIPTION, FABRIC, GRID, NOISE};
use crate::own::OwnFabric;
use crate::words::WordTable;
use crate::words::tokens::{resolve, tokenize};

/// Seconds after which the reference cloth is at rest (damping 2 1/s).
const REFERENCE_SECONDS: f32 = 8.0;

/// Seeds of the training set, the evaluation set and the stream of the first stage differ by these.
const EVALUATION: u64 = 0x6576_616c;
const STREAM: u64 = 0x7374_7265;
/// Seeds of the pins of a fabric, and of what is drawn again.
const PINS: u64 = 0x7069_6e73;
const AGAIN: u64 = 0x6167_6169;

/// One of so many draws of the stream is a fabric of one's own, where there are some.
const OWN_EVERY: u32 = 4;

/// Least share of shear in the mean structural stiffness. A game's step cuts every family alike, and then a weak shear takes
/// the strain. More than this costs the warp its budget, and knits their own stretch (table in docs/training.md).
const LEAST_SHEAR: f32 = 0.15;

/// The stiffness that the net shall say for a fabric, in N/m: the physical one, with shear raised to 0.15 of the mean
/// structural stiffness where it is below.
pub fn corrected_stiffness(fabric: &Fabric) -> [f32; 4] {
    let [warp, weft, shear, bend] = fabric.stiffness;
    let mean = 0.5 * (warp + weft);
    [warp, weft, shear.max(LEAST_SHEAR * mean), bend.min(taut::BEND_SHARE * mean)]
}

/// How numbers are written in tanh's range: -1 and 1 are the ends of a range, logarithmic in between.
#[derive(Clone, Copy, Debug)]
pub struct Coding {
    low: f64,
    high: f64,
}

impl Coding {
    /// The codings of the field's channels and of the fabric's numbers, as the file's metadata says.
    pub fn of(meta: &ExportMeta) -> ([Coding; CHANNELS], [Coding; FABRIC]) {
        let coding = |(low, high): (f64, f64)| Coding { low: low.ln(), high: high.ln() };
        (meta.channel_ranges_n_per_m.map(coding), meta.fabric_ranges.map(coding))
    }

    /// To -1..1, clipped.
    pub fn encode(&self, value: f64) -> f64 {
        (2.0 * (value.ln() - self.low) / (self.high - self.low) - 1.0).clamp(-0.999, 0.999)
    }

    /// From -1..1.
    pub fn decode(&self, t: f64) -> f64 {
        let (offset, slope) = self.line();
        (offset + slope * t).exp()
    }

    /// ln(value) = offset + slope t.
    pub fn line(&self) -> (f64, f64) {
        (0.5 * (self.low + self.high), 0.5 * (self.high - self.low))
    }
}

/// A fabric in a scene with its reference.
#[derive(Clone, Debug)]
pub struct Example {
    /// What it is described as.
    pub words: String,
    /// Its constants.
    pub fabric: Fabric,
    /// How it hangs.
    pub scene: Scene,
    /// What the pins of [`Scene::Pins`] follow from.
    pub draw: u64,
    /// The reference at rest: positions of the training grid, `[particle][axis]`, m.
    pub reference: Vec<f32>,
    /// Its picture, `[channel][64][64]`.
    pub picture: Vec<f32>,
    /// The cloth at each of the configuration's substeps; each starts at the reference.
    pub cloths: Vec<cloth::Scene>,
}

/// Everything that the stages draw from.
#[derive(Clone)]
pub struct Dataset {
    /// Examples of training.
    pub training: Vec<Example>,
    /// Examples of evaluation: other fabrics.
    pub evaluation: Vec<Example>,
    words: WordTable,
    seed: u64,
    held_out: bool,
    own: Vec<OwnFabric>,
    variation: f64,
    codings: ([Coding; CHANNELS], [Coding; FABRIC]),
}

impl Dataset {
    /// Makes the reference cloths. `progress` hears the share that is done.
    pub fn new(
        config: &TrainConfig,
        words: WordTable,
        meta: &ExportMeta,
        renderer: &Renderer,
        mut progress: impl FnMut(f32),
    ) -> Result<Dataset, TrainError> {
        let words = weighted(words);
        if let Some(own) = config.own.iter().find(|own| known(&words, &own.words).is_empty()) {
            return Err(TrainError::Config(format!("own: no word of `{}` is in the word table", own.words)));
        }
        let total = (config.fabrics + config.own.len() + config.evaluation_fabrics) * config.scenes.len();
        let mut done = 0;
        let mut set = |seed: u64, count: usize, split: Split| -> Result<Vec<Example>, TrainError> {
            let mut out = Vec::new();
            let own: &[OwnFabric] = if split == Split::Training { &config.own } else { &[] };
            for i in 0..count + own.len() {
                let (fabric, words) = match i.checked_sub(count).and_then(|i| own.get(i)) {
                    Some(own) => (own.fabric(), own.words.clone()),
                    None => draw(seed, i as u32, config.held_out.then_some(split)),
                };
                let real = config.reference.of(i);
                // the core knows no sheet that is pinned anywhere
                let scenes = config.scenes.iter().filter(|s| real != Reference::Core || **s != Scene::Pins);
                for scene in scenes {
                    let pins = noise::bits(seed ^ PINS, i as u32);
                    // a cloth that does not come to rest tells nothing of rest
                    out.extend(example((config, real), &fabric, &words, *scene, pins, renderer)?);
                    done += 1;
                    progress(done as f32 / total as f32);
                }
            }
            match out.is_empty() {
                true => Err(TrainError::Part("no reference cloth came to rest".into())),
                false => Ok(out),
            }
        };
        Ok(Dataset {
            training: set(config.seed, config.fabrics, Split::Training)?,
            evaluation: set(config.seed ^ EVALUATION, config.evaluation_fabrics, Split::Evaluation)?,
            words,
            own: config.own.clone(),
            seed: config.seed,
            held_out: config.held_out,
            variation: config.variation,
            codings: Coding::of(meta),
        })
    }

    /// The codings of the outputs.
    pub fn codings(&self) -> &([Coding; CHANNELS], [Coding; FABRIC]) {
        &self.codings
    }

    /// The word table.
    pub fn words(&self) -> &WordTable {
        &self.words
    }

    /// A fabric and its words for the first stage: number `index` of an endless stream.
    pub fn streamed(&self, index: u32) -> (Fabric, String) {
        let seed = self.seed ^ STREAM;
        match self.own.get((index / OWN_EVERY) as usize % self.own.len().max(1)) {
            Some(own) if index.is_multiple_of(OWN_EVERY) => (piece(&own.fabric(), seed, index), own.words.clone()),
            _ => draw(seed, index, self.held_out.then_some(Split::Training)),
        }
    }

    /// The description vector of some words: the sum of their vectors, [1024].
    pub fn describe(&self, words: &str) -> Vec<f32> {
        described(&self.words, &self.indices(words))
    }

    /// The known words of a text, at most 16, as the runtime takes them.
    pub fn indices(&self, words: &str) -> Vec<usize> {
        known(&self.words, words)
    }

    /// The noise of a draw, [128].
    pub fn noise(&self, draw: u64) -> Vec<f32> {
        (0..NOISE as u32).map(|i| noise::gaussian(self.seed.wrapping_add(draw), i)).collect()
    }

    /// What the net shall say of a fabric: field `[4][32][32]` and fabric [5] in tanh's range. The noise varies the field
    /// smoothly, as two pieces of one fabric differ.
    pub fn target(&self, fabric: &Fabric, noise: &[f32]) -> (Vec<f32>, Vec<f32>) {
        let mut field = Vec::with_capacity(CHANNELS * GRID * GRID);
        let factors: Vec<f64> =
            (0..GRID * GRID).map(|i| (self.variation * pattern(noise, i / GRID, i % GRID)).exp()).collect();
        let k = corrected_stiffness(fabric);
        for (k, coding) in k.iter().zip(&self.codings.0) {
            field.extend(factors.iter().map(|f| coding.encode(f64::from(*k) * f) as f32));
        }
        (field, self.numbers(fabric).map(|t| t as f32).to_vec())
    }

    /// The levels of the field in tanh's range: what it is where the noise varies nothing.
    pub fn levels(&self, fabric: &Fabric) -> [f64; CHANNELS] {
        let k = corrected_stiffness(fabric);
        std::array::from_fn(|i| self.codings.0[i].encode(f64::from(k[i])))
    }

    /// The fabric's own numbers, the second part of [`Dataset::target`].
    pub fn numbers(&self, fabric: &Fabric) -> [f64; FABRIC] {
        let limits = fabric.stretch_limits();
        let numbers = [fabric.density_kg_m2, fabric.hinge_rigidity_n_m, limits[0], limits[1], limits[2]];
        std::array::from_fn(|i| self.codings.1[i].encode(f64::from(numbers[i])))
    }
}

/// The description vector of words of a table: the sum of their vectors, [1024].
pub(crate) fn described(table: &WordTable, words: &[usize]) -> Vec<f32> {
    let mut sum = vec![0.0f32; DESCRIPTION];
    for word in words {
        for (s, x) in sum.iter_mut().zip(table.vector(*word)) {
            *s += x;
        }
    }
    sum
}

/// The known words of a text, at most 16.
pub(crate) fn known(table: &WordTable, words: &str) -> Vec<usize> {
    let look = |w: &str| table.index(w);
    let mut out: Vec<usize> = tokenize(words).iter().flat_map(|w| resolve(w, &look).0).collect();
    out.truncate(crate::export::TOKENS);
    out
}

/// A smooth pattern of deviation about 1 over the field from the first numbers of the noise.
fn pattern(noise: &[f32], row: usize, column: usize) -> f64 {
    use std::f64::consts::PI;
    let (u, v) = (column as f64 / (GRID - 1) as f64, row as f64 / (GRID - 1) as f64);
    let cos = |n: f64, x: f64| (n * PI * x).cos();
    let modes = [1.0, cos(1.0, u), cos(1.0, v), cos(1.0, u) * cos(1.0, v), cos(2.0, u), cos(2.0, v)];
    modes.iter().zip(noise).map(|(m, z)| m * f64::from(*z)).sum::<f64>() / 6f64.sqrt()
}

/// How much a word counts in the direction of a description: names of fabrics most, so that "thin grey jersey" points where
/// "jersey" does, and "jersey t-shirt" too. Arora, Liang, Ma 2017 weight words for the same end, by their frequency.
pub fn salience(word: &str) -> f32 {
    let names = KINDS.iter().any(|k| k.names.contains(&word));
    let goes_with = KINDS.iter().any(|k| k.words.contains(&word));
    match (names, goes_with) {
        (true, false) => 1.0,
        (true, true) => 0.5,
        _ => 0.25,
    }
}

/// The table with every vector as long as its word is salient.
pub(crate) fn weighted(mut words: WordTable) -> WordTable {
    let dimensions = words.dimensions();
    for (token, vector) in words.tokens.iter().zip(words.vectors.chunks_exact_mut(dimensions)) {
        let weight = salience(token);
        vector.iter_mut().for_each(|x| *x *= weight);
    }
    words
}

/// Fabric number `index`, of one split where one is asked for.
fn draw(seed: u64, index: u32, split: Option<Split>) -> (Fabric, String) {
    let mut drawn = fabric::sample(seed, index);
    let mut again = 0;
    while split.is_some_and(|s| Split::of(&drawn.0, &drawn.1) != s) {
        again += 1;
        drawn = fabric::sample(seed ^ noise::bits(AGAIN, again), index);
    }
    drawn
}

fn example(
    (config, real): (&TrainConfig, Reference),
    fabric: &Fabric,
    words: &str,
    scene: Scene,
    draw: u64,
    renderer: &Renderer,
) -> Result<Option<Example>, TrainError> {
    let reference = match real {
        Reference::Core => reference(config.grid, fabric, scene)?,
        _ => match settled(fabric, scene, config.grid, draw).map_err(TrainError::part)? {
            (positions, true) => positions,
            (_, false) => return Ok(None),
        },
    };
    let springs = Arc::new(Springs::new(config.grid, config.grid, 1.0, 1.0).map_err(TrainError::part)?);
    let cloths = config
        .substeps
        .iter()
        .map(|substeps| {
            hanging(&springs, fabric, (*substeps, config.inertia), &scene.pins(config.grid, draw), &reference)
        })
        .collect::<Result<Vec<_>, cloth::ClothError>>()
        .map_err(TrainError::part)?;
    let picture = renderer.render(&scene.view().of(&reference)).map_err(TrainError::part)?;
    Ok(Some(Example { words: words.to_string(), fabric: fabric.clone(), scene, draw, reference, picture, cloths }))
}

/// The differentiable cloth of a fabric at so many substeps of a 60 Hz frame, with the inertia field or without. The search for
/// its shape at rest begins at `start`, `[particle][axis]` in m.
pub(crate) fn hanging(
    springs: &Arc<Springs>,
    fabric: &Fabric,
    (substeps, inertia): (u32, bool),
    pins: &[usize],
    start: &[f32],
) -> Result<cloth::Scene, cloth::ClothError> {
    let hung = SceneDef::hung(springs, pins);
    let def = SceneDef {
        density_kg_m2: f64::from(fabric.density_kg_m2),
        dt_s: 1.0 / (60.0 * f64::from(substeps)),
        inertia_radius_m: if inertia { hung.inertia_radius_m } else { 0.0 },
        ..hung
    };
    let mut cloth = cloth::Scene::new(springs, def)?;
    cloth.set_start(Some(start.chunks_exact(3).map(|p| [p[0], p[1], p[2]].map(f64::from)).collect()))?;
    Ok(cloth)
}

/// The reference cloth: core itself at the physical stiffness, with as many substeps as the budget needs to cut nothing,
/// stepped to rest: the same that the program shows as the reference.
fn reference(n: usize, fabric: &Fabric, scene: Scene) -> Result<Vec<f32>, TrainError> {
    let case = Case::square(scene.lab(), fabric, n as u32, 16, REFERENCE_SECONDS);
    let outcome = compare::run(&case, &Setting::Reference(fabric.clone()), |_| ()).map_err(TrainError::part)?;
    Ok(outcome.positions.into_flattened())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_held_out_is_not_drawn() {
        let mut passed = 0;
        for i in 0..200 {
            let (fabric, words) = draw(1, i, Some(Split::Training));
            assert_eq!(Split::of(&fabric, &words), Split::Training);
            passed += usize::from(draw(1, i, None) == (fabric, words));
        }
        assert!((90..160).contains(&passed), "{passed} of 200 are drawn at once");
    }

    #[test]
    fn the_table_of_words_knows_every_word_of_the_samples() {
        let table = WordTable::committed().expect("the table that ships");
        let names = fabric::KINDS.iter().flat_map(|k| k.names.iter().chain(k.words));
        let modifiers = fabric::MODIFIERS.iter().map(|m| &m.0);
        for word in names.chain(modifiers).chain(&fabric::COLOURS) {
            let (known, unknown) = resolve(word, &|w| table.index(w));
            assert!(!known.is_empty() && unknown.is_empty(), "{word}: {unknown:?}");
        }
    }
}
