//! Tests of the generator against files that are written here: a miniature that keeps the contract
//! of a real one, and what hostile hands make of it. One binary, so that the engine is linked once.

mod hostile;
mod messages;
mod miniature;
mod operations;
mod reference;
mod round_trip;
