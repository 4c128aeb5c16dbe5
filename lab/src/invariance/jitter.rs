//! Frame times that jitter, through the accumulator of a game's loop.

use serde::Serialize;
use taut::{ClothDef, Error, GridDef, noise};

use super::with_cloth;
use crate::scene::Scene;

/// Time that has passed and is not stepped yet. It counts in nanoseconds, so that nothing is rounded away.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Accumulator {
    step_ns: u64,
    owed_ns: u64,
}

impl Accumulator {
    /// Steps of a length in ns, at least 1.
    pub fn new(step_ns: u64) -> Accumulator {
        Accumulator { step_ns: step_ns.max(1), owed_ns: 0 }
    }

    /// A frame took so long: how many steps are due now.
    pub fn steps(&mut self, frame_ns: u64) -> u64 {
        let owed = self.owed_ns.saturating_add(frame_ns);
        self.owed_ns = owed % self.step_ns;
        owed / self.step_ns
    }
}

/// The state after the same simulated time under some frame times.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Jitter {
    /// What the frame times were.
    pub frames: String,
    /// Frames rendered.
    pub rendered: u64,
    /// Steps taken.
    pub steps: u64,
    /// Hash of the state at the end, 16 hexadecimal digits.
    pub state_hash: String,
}

const STEP_NS: u64 = 16_666_667;
const SIDE: u32 = 16;

/// Runs the scene curtain, whose pins move, for some steps: once step by step, once with steady frames of 144 Hz, and with
/// frames of 1 to 100 ms at random. The pins are where the number of the step says, as a game has it.
pub fn jitter(steps: u64) -> Result<Vec<Jitter>, Error> {
    let grid = GridDef { rows: SIDE, columns: SIDE, ..GridDef::default() };
    let scene = Scene::Curtain;
    let def = scene.fit(&ClothDef::default(), SIDE as usize, SIDE as usize);
    let run = |frames: String, frame_ns: &dyn Fn(u32) -> u64| {
        with_cloth(&grid, &def, |cloth| {
            cloth.set_stiffness_uniform([1000.0, 1000.0, 400.0, 10.0])?;
            scene.set_up(cloth, 0)?;
            let mut accumulator = Accumulator::new(STEP_NS);
            let (mut rendered, mut stepped) = (0, 0);
            while stepped < steps {
                for _ in 0..accumulator.steps(frame_ns(rendered as u32)).min(steps - stepped) {
                    stepped += 1;
                    scene.drive(cloth, stepped as f64 / 60.0, 0)?;
                    cloth.step()?;
                }
                rendered += 1;
            }
            let state_hash = format!("{:016x}", cloth.state_hash());
            Ok(Jitter { frames: frames.clone(), rendered, steps: stepped, state_hash })
        })
    };
    let mut all = vec![run("a step each".into(), &|_| STEP_NS)?, run("steady 144 Hz".into(), &|_| 6_944_444)?];
    for seed in 1..=3 {
        let random = |frame: u32| 1_000_000 + (f64::from(noise::uniform(seed, frame)) * 99e6) as u64;
        all.push(run(format!("1 to 100 ms, seed {seed}"), &random)?);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_time_is_lost() {
        let mut a = Accumulator::new(10);
        assert_eq!([3, 3, 3, 3, 25, 0, 13].map(|t| a.steps(t)), [0, 0, 0, 1, 2, 0, 2]);
    }

    /// Bit for bit, though the frames are others.
    #[test]
    fn frame_times_change_nothing() {
        let all = jitter(300).unwrap();
        assert!(all.iter().all(|j| j.state_hash == all[0].state_hash && j.steps == 300), "{all:?}");
        let rendered: Vec<u64> = all.iter().map(|j| j.rendered).collect();
        assert!(rendered[0] == 300 && rendered[1] > 700 && rendered[2..].iter().all(|n| *n < 120), "{rendered:?}");
        // the hash is one of the motion: a step more is another
        assert_ne!(jitter(301).unwrap()[0].state_hash, all[0].state_hash);
    }
}
