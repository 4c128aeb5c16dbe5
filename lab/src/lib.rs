//! lab

pub mod picture;
