//! The C ABI of taut: `include/taut.h` is generated from this crate, so the comments of the public items are written for
//! a reader of the header.
//!
//! Nothing here computes: every function checks its pointers, calls core and translates the answer. It is the only crate
//! that holds unsafe code, all of it about memory that the caller hands in.
//!
//! In release builds (`panic = "abort"`) it links neither std nor alloc. Where panics unwind (tests, development) std
//! brings the panic handler. The feature `generator` brings std, the inference engine and `include/taut_generator.h`.
#![no_std]
#![allow(
    clippy::missing_safety_doc,
    reason = "what a C caller must keep to is told once, in the chapter at the top of taut.h"
)]

#[cfg(any(panic = "unwind", feature = "generator"))]
extern crate std;

#[cfg(all(panic = "abort", not(test), not(feature = "generator")))]
mod panic;

mod pointer;

// The rest in the order of the header, hence the gaps: rustfmt sorts what stands together.

mod version;

mod result;

mod types;

mod handle;

mod grid;

mod plan;
mod plan_types;

mod cloth;

mod field;

mod stiffness;

mod matter;

mod surroundings;

mod pins;

mod colliders;

mod targets;

mod particle;

mod air;
mod frame;

mod step;

mod step_all;

mod bands;

mod width;

mod read;

mod mesh;
mod sleep;

mod pin_force;

mod rollback;

#[cfg(feature = "generator")]
mod generator;
