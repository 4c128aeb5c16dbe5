//! A generator as it is asked here: words in, stiffness and limits out.

use std::fs;
use std::path::Path;

use burn::Tensor;
use burn::module::Module;
use burn::tensor::{Device, TensorData};
use taut::{field, noise};

use super::EvaluateError;
use crate::export::{self, ExportMeta};
use crate::gan::{Coding, TrainConfig, described, known, pin_map, weighted};
use crate::nets::{CHANNELS, FABRIC, GRID, Generator, NOISE};
use crate::words::WordTable;

/// A generator for inference with its words.
pub struct Net {
    generator: Generator,
    words: WordTable,
    codings: ([Coding; CHANNELS], [Coding; FABRIC]),
}

/// What a generator tells of a description.
#[derive(Clone, Debug)]
pub struct Told {
    /// Stiffness in N/m, `[4][32][32]`.
    field: Vec<f32>,
    /// Mass per area in kg/m^2.
    pub density_kg_m2: f32,
    /// Bending rigidity of a hinge in N m.
    pub rigidity_n_m: f32,
    /// Strain limits of warp, weft and diagonal.
    pub limits: [f32; 3],
}

impl Told {
    /// The field on a grid, as the runtime moves it.
    pub fn on(&self, rows: usize, columns: usize) -> Vec<f32> {
        let channel = |c: usize| &self.field[c * GRID * GRID..][..GRID * GRID];
        let places = (0..CHANNELS).flat_map(|c| (0..rows * columns).map(move |i| (c, i)));
        let value = |(c, i): (usize, usize)| {
            let of = |row: usize, column: usize| channel(c)[row * GRID + column];
            field::bilinear((GRID, GRID), of, (i / columns, i % columns), (rows, columns))
        };
        places.map(value).collect()
    }
}

impl Net {
    /// That of a configuration with the weights that a run saved.
    pub fn trained(weights: &Path, config: &TrainConfig) -> Result<Net, EvaluateError> {
        let words = weighted(WordTable::committed().map_err(EvaluateError::part)?);
        let first = config.generator().init(config.seed, &Device::flex()).map_err(EvaluateError::part)?;
        let generator = first.try_load_file(weights);
        let generator = generator.map_err(|e| EvaluateError::Part(format!("{}: {e:?}", weights.display())))?;
        Ok(Net { generator, words, codings: Coding::of(&config.meta()?) })
    }

    /// That of a generator file.
    pub fn load(path: &Path) -> Result<Net, EvaluateError> {
        let named = |e: &dyn std::fmt::Display| EvaluateError::Part(format!("{}: {e}", path.display()));
        let bytes = fs::read(path).map_err(|e| named(&e))?;
        let (generator, words, meta): (Generator, WordTable, ExportMeta) =
            export::import(&bytes).map_err(|e| named(&e))?;
        Ok(Net { generator, words, codings: Coding::of(&meta) })
    }

    /// What it tells of a description; `pins` are particles of its own 32 x 32 grid, another seed is another piece of the
    /// fabric.
    pub fn tell(&self, description: &str, pins: &[usize], seed: u64) -> Result<Told, EvaluateError> {
        let indices = known(&self.words, description);
        if indices.is_empty() {
            return Err(EvaluateError::Part(format!("the generator knows no word of `{description}`")));
        }
        let device = Device::flex();
        let row = |v: Vec<f32>| {
            let n = v.len();
            Tensor::<2>::from_data(TensorData::new(v, [1, n]), &device)
        };
        let z = (0..NOISE as u32).map(|i| noise::gaussian(seed, i)).collect();
        let pins = row(pin_map(pins)).reshape([1, 1, GRID, GRID]);
        let out = self.generator.forward(row(described(&self.words, &indices)), row(z), pins);
        let read = |data: TensorData| data.try_into_vec::<f32>().map_err(|e| EvaluateError::Part(format!("{e:?}")));
        let decode = |t: f32, coding: &Coding| coding.decode(f64::from(t)) as f32;
        let field = read(out.field.into_data())?;
        let of_channel = |(i, t): (usize, &f32)| decode(*t, &self.codings.0[i / (GRID * GRID)]);
        let fabric = read(out.fabric.into_data())?;
        let of_fabric = |i: usize| decode(fabric[i], &self.codings.1[i]);
        Ok(Told {
            field: field.iter().enumerate().map(of_channel).collect(),
            density_kg_m2: of_fabric(0),
            rigidity_n_m: of_fabric(1),
            limits: std::array::from_fn(|i| of_fabric(2 + i)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use taut_lab::scene::Scene;

    #[test]
    fn the_file_that_ships_tells_what_words_mean() {
        let net = Net::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../onnx/generator.onnx")).unwrap();
        let warp = |words: &str| {
            let told = net.tell(words, &Scene::Hang2.pins(GRID, GRID), 3).unwrap();
            let mut k = told.on(16, 20);
            assert_eq!(k.len(), 4 * 320);
            k.truncate(320);
            k.sort_by(f32::total_cmp);
            (k[160], told.limits)
        };
        let ((denim, stiff), (jersey, soft)) = (warp("denim"), warp("cotton jersey"));
        assert!((1500.0..2600.0).contains(&denim) && (250.0..900.0).contains(&jersey), "{denim} {jersey}");
        assert!(soft.iter().zip(&stiff).all(|(soft, stiff)| soft > stiff), "{soft:?} {stiff:?}");
        // its own size is what it says
        let told = net.tell("denim", &[], 0).unwrap();
        assert_eq!(told.on(GRID, GRID), told.field);
        assert!(net.tell("qqq", &[], 0).is_err());
        assert!(Net::load(Path::new("none.onnx")).is_err());
    }
}
