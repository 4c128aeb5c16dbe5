//! The front: what a setting costs and how wrong it is, for every scene.
//!
//! [`Spec::list`] says which rows there are, [`Bench`] measures one, [`pareto`] and [`Scoreboard`] say what the rows tell,
//! [`chart`] draws them.

mod bench;
pub mod fit;
mod pareto;
mod picture;
mod rounds;
mod row;
mod scoreboard;
mod spec;
mod trace;
mod yardstick;

pub use bench::{Bench, Generate};
pub use pareto::pareto;
pub use picture::{SERIES, chart};
pub use rounds::{least, rounds};
pub use row::{Row, csv};
pub use scoreboard::{Cell, Scoreboard};
pub use spec::{Correction, FABRICS, NO_BEND, SIDE, Set, Spec};
pub use trace::{Trace, swing_period};
pub use yardstick::plain_ns;
