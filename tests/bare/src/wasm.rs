//! WebAssembly: `wasm.mjs` brings the two functions that it needs.

/// Whether the machine is fast enough for the long runs.
pub const FAST: bool = false;

mod host {
    #[link(wasm_import_module = "host")]
    unsafe extern "C" {
        pub safe fn write(text: *const u8, bytes: usize);
        pub safe fn exit(code: i32) -> !;
    }
}

/// What the host calls.
#[unsafe(no_mangle)]
extern "C" fn run() {
    crate::main()
}

/// Writes a text that ends with a zero byte.
pub fn write(text: &[u8]) {
    host::write(text.as_ptr(), text.len().saturating_sub(1));
}

/// WebAssembly has no floating-point modes.
pub fn set_modes_of_an_engine() -> bool {
    false
}

/// Ends the program.
pub fn exit(code: i32) -> ! {
    host::exit(code)
}
