//! The program as it is built, run as a user runs it.

mod bad_input;
mod correct;
mod drape;
mod front;
mod info;
mod interrupt;
mod measure;
mod pictures;
mod plan;
mod run;
