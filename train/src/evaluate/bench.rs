//! What the figures share: the folder, its ledgers, the nets that are trained in it.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;
use serde::de::DeserializeOwned;
use taut::Hash64;
use taut_lab::ledger::Ledger;

use super::EvaluateError;
use super::held::{SCENES, TestSet};
use super::net::Net;
use crate::Shard;
use crate::gan::{AdversarialLoss, Checkpoint, Dataset, StageSteps, TrainConfig, bar, renderer, train_in};
use crate::words::WordTable;

/// What an evaluation is made with.
pub struct Bench<'a> {
    /// The folder.
    pub out: PathBuf,
    /// The part of the work that is done here.
    pub shard: Shard,
    /// Minutes of training of each net.
    pub minutes: f64,
    /// Whether everything is as small as it can be.
    pub quick: bool,
    /// The generator file that stands for ours.
    pub model: PathBuf,
    /// Folder of a data set whose test pictures the nets are judged by; without, test fabrics with the core's own reference.
    pub data_set: Option<PathBuf>,
    /// Set when all shall end.
    pub stop: &'a AtomicBool,
    /// The last training set, with what it was made by.
    data: Option<(String, Dataset)>,
    /// The last test set, likewise.
    test: Option<(String, Arc<TestSet>)>,
}

/// What the rows of a ledger belong to.
#[derive(Serialize)]
struct Header<'a, T: Serialize> {
    evaluation: u32,
    figure: &'a str,
    made_with: &'a T,
}

/// Fabrics of the test pictures, each in two scenes: 32 pictures.
const FABRICS: usize = 16;

/// Version of the rows.
const VERSION: u32 = 2;

impl<'a> Bench<'a> {
    /// A bench in a folder, which is made where it is not.
    pub fn new(out: &Path, stop: &'a AtomicBool) -> Result<Bench<'a>, EvaluateError> {
        fs::create_dir_all(out).map_err(|e| EvaluateError::Part(format!("{}: {e}", out.display())))?;
        Ok(Bench {
            out: out.into(),
            shard: Shard::WHOLE,
            minutes: 2.0,
            quick: false,
            model: "onnx/generator.onnx".into(),
            data_set: None,
            stop,
            data: None,
            test: None,
        })
    }

    /// The rows of all jobs of a figure, those of this shard measured where they are missing. None stands for rows of other
    /// shards whose ledgers are not in the folder. `made_with` is what the rows depend on beside their keys.
    pub fn rows<J, R: Serialize + DeserializeOwned + Clone>(
        &mut self,
        figure: &str,
        made_with: &impl Serialize,
        jobs: &[J],
        key: impl Fn(&J) -> String,
        mut measure: impl FnMut(&mut Bench<'a>, &J) -> Result<R, EvaluateError>,
    ) -> Result<Vec<Option<R>>, EvaluateError> {
        let header = Header { evaluation: VERSION, figure, made_with };
        let open = |path: &Path| Ledger::<R>::open(path, &header).map_err(EvaluateError::part);
        let own = self.out.join(self.shard.file(figure));
        let mut ledger = open(&own)?;
        let others = self.ledgers(figure)?.into_iter().filter(|p| *p != own);
        let others: Vec<Ledger<R>> = others.map(|p| open(&p)).collect::<Result<_, _>>()?;
        let bar = bar(&format!("figure {figure}"), jobs.len() as u64);
        let mut rows = Vec::with_capacity(jobs.len());
        for (i, job) in jobs.iter().enumerate() {
            let key = key(job);
            let known = others.iter().chain([&ledger]).find_map(|l| l.get(&key)).cloned();
            let row = match known {
                None if self.shard.has(i) => {
                    if self.stop.load(Ordering::SeqCst) {
                        bar.abandon();
                        return Err(EvaluateError::Interrupted);
                    }
                    bar.set_message(key.clone());
                    let row = measure(self, job)?;
                    ledger.add(&key, row.clone()).map_err(EvaluateError::part)?;
                    Some(row)
                }
                known => known,
            };
            bar.inc(1);
            rows.push(row);
        }
        bar.finish_and_clear();
        Ok(rows)
    }

    /// What the generator file holds, in hexadecimal: rows of another one are others, wherever it lies.
    pub fn model_digest(&self) -> Result<String, EvaluateError> {
        let named = |e: std::io::Error| EvaluateError::Part(format!("{}: {e}", self.model.display()));
        let mut hash = Hash64::new();
        hash.bytes(&fs::read(&self.model).map_err(named)?);
        Ok(format!("{:016x}", hash.finish()))
    }

    /// The files of a figure's ledgers, in the order of their names.
    fn ledgers(&self, figure: &str) -> Result<Vec<PathBuf>, EvaluateError> {
        let named = |e: std::io::Error| EvaluateError::Part(format!("{}: {e}", self.out.display()));
        let mut found = Vec::new();
        for entry in fs::read_dir(&self.out).map_err(named)? {
            let path = entry.map_err(named)?.path();
            let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
            if name.starts_with(&format!("figure-{figure}.")) && name.ends_with(".jsonl") {
                found.push(path);
            }
        }
        found.sort();
        Ok(found)
    }

    /// The net of a configuration: trained in a folder of its own, or read from there. Training that was interrupted goes on.
    pub fn net(&mut self, config: &TrainConfig, name: &str) -> Result<Net, EvaluateError> {
        let folder = self.out.join("nets").join(config.digest()?);
        let weights = folder.join("best.bpk");
        let done = Checkpoint::read(&folder)?.is_some_and(|c| c.step >= config.steps.total());
        if !(done && weights.exists()) {
            fs::create_dir_all(&folder).map_err(|e| EvaluateError::Part(format!("{}: {e}", folder.display())))?;
            let data = self.data(config)?;
            train_in(&folder, config, data, Arc::new(renderer(config)?), name, self.stop)?;
        }
        Net::trained(&weights, config)
    }

    fn data(&mut self, config: &TrainConfig) -> Result<Dataset, EvaluateError> {
        let key = source(config)?;
        if let Some((of, data)) = &self.data
            && *of == key
        {
            return Ok(data.clone());
        }
        let words = WordTable::committed().map_err(EvaluateError::part)?;
        let bar = bar("reference cloths", 1000);
        let data = Dataset::new(config, words, &config.meta()?, &renderer(config)?, |share| {
            bar.set_position((1000.0 * share) as u64);
        })?;
        bar.finish_and_clear();
        self.data = Some((key, data.clone()));
        Ok(data)
    }

    /// The pictures that nets of a configuration are judged by.
    pub fn test(&mut self, config: &TrainConfig) -> Result<Arc<TestSet>, EvaluateError> {
        let key = format!("{} {:?} {:?}", config.grid, config.substeps, config.picture);
        if let Some((of, set)) = &self.test
            && *of == key
        {
            return Ok(set.clone());
        }
        let (renderer, fabrics) = (Arc::new(renderer(config)?), if self.quick { 1 } else { FABRICS });
        let set = Arc::new(match &self.data_set {
            Some(folder) => TestSet::load(folder, config, renderer, fabrics * SCENES.len())?,
            None => TestSet::new(config, renderer, fabrics)?,
        });
        self.test = Some((key, set.clone()));
        Ok(set)
    }
}

/// What the training set of a configuration follows from: the configuration without what weighs losses.
fn source(config: &TrainConfig) -> Result<String, EvaluateError> {
    let like = TrainConfig {
        conditional: false,
        adversarial_loss: AdversarialLoss::LeastSquares,
        beta: 0.0,
        paired: 0.0,
        prior: 0.0,
        shape: 0.0,
        picture_noise: [0.0; 2],
        steps: StageSteps { matching: 0, positions: 0, adversarial: 1 },
        report_every: 1,
        ..config.clone()
    };
    Ok(like.digest()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of ten jobs and how many were measured.
    fn rows(bench: &mut Bench<'_>, fail_at: Option<usize>) -> (Result<Vec<Option<usize>>, EvaluateError>, usize) {
        let mut measured = 0;
        let jobs: Vec<usize> = (0..10).collect();
        let rows = bench.rows("8", &"made so", &jobs, usize::to_string, |_, job| {
            measured += 1;
            if fail_at == Some(*job) { Err(EvaluateError::Interrupted) } else { Ok(job * job) }
        });
        (rows, measured)
    }

    #[test]
    fn an_interrupted_figure_goes_on() {
        let (home, stop) = (tempfile::tempdir().unwrap(), AtomicBool::new(false));
        let mut bench = Bench::new(home.path(), &stop).unwrap();
        let (cut, measured) = rows(&mut bench, Some(6));
        assert!(matches!(cut, Err(EvaluateError::Interrupted)) && measured == 7);
        let mut again = Bench::new(home.path(), &stop).unwrap();
        let (whole, measured) = rows(&mut again, None);
        assert_eq!((whole.unwrap(), measured), ((0..10).map(|i| Some(i * i)).collect(), 4));
        // Ctrl-C is heard before the next job, and rows that are known need none
        assert_eq!(rows(&mut again, None).1, 0);
        stop.store(true, Ordering::SeqCst);
        assert!(rows(&mut again, None).0.is_ok());
        fs::remove_file(home.path().join("figure-8.jsonl")).unwrap();
        let (stopped, measured) = rows(&mut again, None);
        assert!(matches!(stopped, Err(EvaluateError::Interrupted)) && measured == 0);
    }

    #[test]
    fn shards_together_are_the_whole() {
        let (home, stop) = (tempfile::tempdir().unwrap(), AtomicBool::new(false));
        let mut total = 0;
        for i in 1..=3 {
            let mut bench = Bench::new(home.path(), &stop).unwrap();
            bench.shard = format!("{i}/3").parse().unwrap();
            let (rows, measured) = rows(&mut bench, None);
            total += measured;
            assert_eq!(rows.unwrap().iter().all(Option::is_some), i == 3);
        }
        assert_eq!(total, 10);
        let (whole, measured) = rows(&mut Bench::new(home.path(), &stop).unwrap(), None);
        assert_eq!((whole.unwrap(), measured), ((0..10).map(|i| Some(i * i)).collect(), 0));
    }

    #[test]
    fn nets_that_differ_in_their_losses_share_their_training_set() {
        let rungs = super::super::ladder::rungs(5, true);
        let first = source(&rungs[0].config).unwrap();
        assert!(rungs.iter().all(|r| source(&r.config).unwrap() == first));
        let other = TrainConfig { seed: 2, ..rungs[0].config.clone() };
        assert_ne!(source(&other).unwrap(), first);
    }
}
