//! A level sheet that falls on two pinned corners: the cheapest way to step it that stretches no more than so much.
//!
//! 1 m x 1 m, 0.2 kg/m^2, N x N particles, four channels of stiffness at each, gravity, damping of 2/s, 60 frames a second,
//! 5 s, nothing to touch: the scene on which other engines were measured.

mod capes;
mod report;
mod run;
mod search;
mod setting;

pub use capes::{CAPES, Capes, capes};
pub use report::{Row, cost_chart, peak_chart, target_ms, zen5_once_ns};
pub use run::{Fall, Quality, SECONDS, fall};
pub use search::{Criterion, MOST_COM_ERROR_MM, REST_P99_PCT, Trial, candidates, cheapest, search};
pub use setting::{DAMPING_PER_S, Family, Guard, Kind, PASSES, RATE_HZ, SIDE_M, Setting, families};
