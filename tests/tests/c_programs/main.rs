//! taut from C and C++: the library is built as its users build it, programs are compiled against the committed header
//! with every warning an error, linked statically and dynamically, and run.

// ffi/src/types.rs names core so, since the library of ffi has core's name.
extern crate taut as taut_core;

mod contact;
mod drape;
mod examples;
mod headers;
mod layout;
mod library;
mod memory;
mod refusals;
mod sanitizers;
mod snippet;
mod symbols;
