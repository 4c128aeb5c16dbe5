//! The C ABI of taut.
