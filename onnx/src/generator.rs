use std::fmt;
use std::io::Read;
use std::path::Path;

use ndarray::{Array3, ArrayView3};
use taut::baked::{self, Fabric};
use taut::field::CHANNELS;

use crate::metadata::{self, Info};
use crate::plan::{Feed, Plan};
use crate::tokens::Tokens;
use crate::{Error, Vocabulary};
use crate::{field, graph, scene, wire};

/// Largest generator file in bytes. The largest that training writes has 16 MB.
pub const MAX_FILE_BYTES: usize = 64 << 20;

/// What a field is wanted for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request<'a> {
    /// The fabric in words, for example "heavy blue denim"; at most 16 kB.
    pub description: &'a str,
    /// Another seed gives another field of the same fabric. Default 0.
    pub seed: u64,
    /// Particles along v, 2 to 4096. Default 32.
    pub rows: usize,
    /// Particles along u, 2 to 4096. Default 32.
    pub columns: usize,
    /// Side length along u in m, above 0, at most 10,000. Default 1.
    pub width_m: f32,
    /// Side length along v in m, above 0, at most 10,000. Default 1.
    pub height_m: f32,
    /// Pinned particles as (row, column); row 0 is the top row. Default none.
    pub pins: &'a [(usize, usize)],
}

impl<'a> Request<'a> {
    /// The fabric of a description on 32 x 32 particles, 1 m x 1 m, nothing pinned, seed 0.
    pub fn new(description: &'a str) -> Self {
        Request { description, seed: 0, rows: 32, columns: 32, width_m: 1.0, height_m: 1.0, pins: &[] }
    }
}

/// What the generator answers.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Correction {
    /// Stiffness `[warp, weft, shear, bend][row][column]` at the particles in N/m: the target, before
    /// the budget. Bend is at most 2 % of the mean of warp and weft.
    pub field: Array3<f32>,
    /// Area density in kg/m^2.
    pub density_kg_m2: f32,
    /// Bending rigidity D of a hinge in N m.
    pub hinge_rigidity_n_m: f32,
    /// How far the fabric stretches along warp, weft and diagonal, as fractions of the rest length.
    pub stretch_limits: [f32; 3],
    /// Words of the description that the vocabulary lacks, each once. They were skipped.
    pub unknown_words: Vec<String>,
    /// Known words beyond those that the generator takes. They were skipped too.
    pub dropped_words: Vec<String>,
    /// The words that counted, as they stand in the vocabulary.
    pub tokens: Vec<String>,
    /// The description that it was asked for.
    pub description: String,
    /// The seed that it was asked for.
    pub seed: u64,
}

impl Correction {
    /// What the words tell beside the field, as the cloth takes it.
    pub fn fabric(&self) -> Fabric {
        Fabric {
            density_kg_m2: self.density_kg_m2,
            hinge_rigidity_n_m: self.hinge_rigidity_n_m,
            stretch_limits: self.stretch_limits,
        }
    }

    /// The bytes of a baked field file ([`taut::baked`]): small, exact, and read by the cloth
    /// without the generator. Errors: [`Error::Baked`] if the field or a number was changed to
    /// something that no cloth takes.
    pub fn to_baked(&self) -> Result<Vec<u8>, Error> {
        let (_, rows, columns) = self.field.dim();
        let mut bytes = vec![0; baked::size(rows, columns).map_err(Error::Baked)?];
        // a field that was put together anew may lie in another order
        let numbers = self.field.as_standard_layout();
        let numbers = numbers.as_slice().unwrap_or_default();
        let fabric = self.fabric();
        baked::write(rows, columns, numbers, &fabric, self.seed, &self.description, &mut bytes)
            .map_err(Error::Baked)?;
        Ok(bytes)
    }
}

/// A generator file, checked and ready to run. It can be shared by threads.
pub struct Generator {
    info: Info,
    vocabulary: Vocabulary,
    plan: Plan,
}

impl fmt::Debug for Generator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Generator").field("info", &self.info).finish_non_exhaustive()
    }
}

impl Generator {
    /// Reads a generator from the bytes of its file. Nothing of the bytes is kept. Errors: every one
    /// that is about a file; see [`Error`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Generator, Error> {
        if bytes.len() > MAX_FILE_BYTES {
            return Err(Error::TooLarge { limit: MAX_FILE_BYTES });
        }
        let entries = wire::metadata(bytes)?;
        let (mut info, vocabulary) = metadata::parse(&entries)?;
        let checked = graph::check(bytes, &info)?;
        info.parameters = checked.parameters;
        info.file_bytes = bytes.len();
        let plan = Plan::build(&checked.model, &info)?;
        Ok(Generator { info, vocabulary, plan })
    }

    /// Reads a generator file. Errors: [`Error::Io`], and those of [`Generator::from_bytes`].
    pub fn load(path: impl AsRef<Path>) -> Result<Generator, Error> {
        let path = path.as_ref();
        let io = |e: std::io::Error| Error::Io { path: path.display().to_string(), reason: e.to_string() };
        let file = std::fs::File::open(path).map_err(io)?;
        let mut bytes = Vec::new();
        // one byte more than allowed tells a file that is too large, even one that never ends
        file.take(MAX_FILE_BYTES as u64 + 1).read_to_end(&mut bytes).map_err(io)?;
        Generator::from_bytes(&bytes)
    }

    /// What the file says of itself.
    pub fn info(&self) -> &Info {
        &self.info
    }

    /// The words that it knows.
    pub fn vocabulary(&self) -> &Vocabulary {
        &self.vocabulary
    }

    /// The field and the fabric for a request. The same request gives the same bits on one machine.
    /// Errors: [`Error::NoKnownWord`], [`Error::LongDescription`], [`Error::GridSize`],
    /// [`Error::SideLength`], [`Error::Pin`]; [`Error::Output`] and [`Error::Inference`] if the file
    /// is broken in a way that only running it shows.
    pub fn correct(&self, request: &Request<'_>) -> Result<Correction, Error> {
        let info = &self.info;
        let (rows, columns) = (request.rows, request.columns);
        let sides = [request.width_m, request.height_m];
        let pin_distance = scene::pin_distance(info.grid, request.pins, [rows, columns], sides)?;
        let tokens = Tokens::of(request.description, &self.vocabulary, info.tokens)?;
        // the description vector is the mean of its word vectors; the padding has weight 0
        let known = tokens.rows.len();
        let mut indices = vec![0; info.tokens];
        let mut weights = vec![0.0; info.tokens];
        for (i, &row) in tokens.rows.iter().enumerate() {
            indices[i] = row as i64;
            weights[i] = 1.0 / known as f32;
        }
        let noise: Vec<f32> = (0..info.noise).map(|i| taut::noise::gaussian(request.seed, i as u32)).collect();
        let pin_distance: Vec<f32> = pin_distance.iter().copied().collect();
        let [field, fabric] =
            self.plan.run(&Feed { tokens: &indices, weights: &weights, noise: &noise, pin_distance: &pin_distance })?;

        let shape = (CHANNELS.len(), info.grid, info.grid);
        let tanh = ArrayView3::from_shape(shape, &field)
            .map_err(|e| Error::Inference { stage: "run", reason: e.to_string() })?;
        let decoded = field::decode(&tanh, &info.channel_ranges);
        let mut field = field::resample(&decoded.view(), rows, columns)?;
        field::cap_bend(&mut field);
        let told = |i: usize| info.fabric_ranges[i].decode(fabric[i]);
        Ok(Correction {
            field,
            density_kg_m2: told(0),
            hinge_rigidity_n_m: told(1),
            stretch_limits: [told(2), told(3), told(4)],
            unknown_words: tokens.unknown,
            dropped_words: tokens.dropped,
            tokens: tokens.words,
            description: request.description.into(),
            seed: request.seed,
        })
    }
}
