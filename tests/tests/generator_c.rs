//! The functions of taut_generator.h, called as C calls them: pointers in, codes out.

// ffi names core so, since its library has core's name.
extern crate taut as taut_core;

use std::ffi::{CStr, CString, c_char};
use std::ptr::{null, null_mut};

use taut_onnx::{Generator, Request};

#[path = "../../ffi/src/generator.rs"]
mod generator;
#[allow(dead_code, reason = "the generator needs a part of it")]
#[path = "../../ffi/src/grid.rs"]
mod grid;
#[allow(dead_code, reason = "the generator needs a part of it")]
#[path = "../../ffi/src/handle.rs"]
mod handle;
#[allow(dead_code, reason = "the generator needs a part of it")]
#[path = "../../ffi/src/pointer.rs"]
mod pointer;
#[allow(dead_code, reason = "the generator needs a part of it")]
#[path = "../../ffi/src/result.rs"]
mod result;
#[allow(dead_code, reason = "the generator needs a part of it")]
#[path = "../../ffi/src/types.rs"]
mod types;

use generator::*;
use handle::GridHandle;
use result::Code::{self, *};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../onnx/generator.onnx");

/// A grid's block.
#[repr(align(64))]
struct Block([u8; handle::TAUT_GRID_BYTES]);

fn grid(block: &mut Block, rows: u32, columns: u32) -> *const GridHandle {
    let def = types::GridDef { rows, columns, ..grid::taut_grid_def_default() };
    let mut out = null_mut();
    // SAFETY: the block is ours and large enough.
    let code = unsafe { grid::taut_grid_create(&def, block.0.as_mut_ptr().cast(), block.0.len(), &mut out) };
    assert_eq!(code, TAUT_OK);
    out
}

fn said() -> String {
    let mut line = [0x7f as c_char; 400];
    // SAFETY: the buffer is ours; the call ends it with NUL.
    let (whole, text) =
        unsafe { (taut_generator_last_error(line.as_mut_ptr(), line.len()), CStr::from_ptr(line.as_ptr())) };
    let text = text.to_str().expect("UTF-8").to_string();
    assert!(text.len() == whole.min(399), "{text}");
    text
}

fn load(bytes: &[u8]) -> Result<*mut GeneratorHandle, Code> {
    let mut out = null_mut();
    // SAFETY: the bytes are ours.
    match unsafe { taut_generator_load(bytes.as_ptr().cast(), bytes.len(), &mut out) } {
        TAUT_OK => Ok(out),
        code => {
            assert!(out.is_null(), "nothing is written");
            Err(code)
        }
    }
}

#[test]
fn words_to_a_field_as_in_rust() {
    let mut block = Block([0; 64]);
    let grid = grid(&mut block, 24, 16);
    let path = CString::new(FILE).expect("no NUL");
    let mut g = null_mut();
    // SAFETY: all of it is ours.
    unsafe {
        assert_eq!(taut_generator_load_file(path.as_ptr(), &mut g), TAUT_OK, "{}", said());
        let mut info = std::mem::zeroed();
        assert_eq!(taut_generator_info(g, &mut info), TAUT_OK);
        assert!(info.words > 100 && info.grid == 32 && info.tokens == 16 && info.parameters > 1_000_000);

        let pins = [0u32, 15];
        let mut field = vec![f32::NAN; 4 * 24 * 16];
        let mut fabric = std::mem::zeroed();
        let words = c"heavy blue zorgon denim";
        let code = taut_generator_correct(
            g,
            words.as_ptr(),
            7,
            grid,
            pins.as_ptr(),
            2,
            field.as_mut_ptr(),
            field.len(),
            &mut fabric,
        );
        assert_eq!(code, TAUT_OK, "{}", said());
        assert_eq!(said(), "words that do not count: zorgon");

        let rust = Generator::load(FILE).expect("the file");
        let request = Request {
            seed: 7,
            rows: 24,
            columns: 16,
            pins: &[(0, 0), (0, 15)],
            ..Request::new("heavy blue zorgon denim")
        };
        let expected = rust.correct(&request).expect("a field");
        assert!(field.iter().eq(expected.field.iter()));
        assert_eq!(fabric.density_kg_m2, expected.density_kg_m2);
        assert_eq!([fabric.limit_warp, fabric.limit_weft, fabric.limit_diagonal], expected.stretch_limits);

        let baked = expected.to_baked().expect("bytes");
        let mut size = 0;
        let bake = |data: *mut u8, room, size: &mut usize| {
            taut_generator_bake(g, words.as_ptr(), 7, grid, pins.as_ptr(), 2, data.cast(), room, size)
        };
        assert_eq!(bake(null_mut(), 0, &mut size), TAUT_OK);
        assert_eq!(size, baked.len());
        let mut bytes = vec![0u8; size];
        size = 99;
        assert_eq!(bake(bytes.as_mut_ptr(), baked.len() - 1, &mut size), TAUT_ERROR_BLOCK_TOO_SMALL);
        assert!(size == 99 && bytes.iter().all(|b| *b == 0), "nothing is written");
        assert_eq!(bake(bytes.as_mut_ptr(), baked.len(), &mut size), TAUT_OK);
        assert_eq!((&bytes, size), (&baked, baked.len()));
        taut_generator_free(g);
        taut_generator_free(null_mut());
    }
}

#[test]
fn what_is_wrong_has_its_code_and_a_line() {
    let file = std::fs::read(FILE).expect("the file");
    assert_eq!(load(&file[..file.len() / 2]).expect_err("half"), TAUT_ERROR_TRUNCATED);
    assert!(said().contains("bytes"), "{}", said());
    assert_eq!(load(b"not a generator at all").expect_err("text"), TAUT_ERROR_WRONG_KIND);
    assert!(!said().is_empty());
    assert_eq!(load(&[]).expect_err("nothing"), TAUT_ERROR_WRONG_KIND);

    let mut block = Block([0; 64]);
    let grid = grid(&mut block, 8, 8);
    let g = load(&file).expect("a generator");
    let mut field = vec![1.0f32; 256];
    // SAFETY: what is not ours is NULL or misaligned, which is answered and not followed.
    unsafe {
        let mut other = null_mut();
        assert_eq!(taut_generator_load(null(), 3, &mut other), TAUT_ERROR_NULL_POINTER);
        assert_eq!(taut_generator_load(file.as_ptr().cast(), file.len(), null_mut()), TAUT_ERROR_NULL_POINTER);
        assert_eq!(taut_generator_load_file(null(), &mut other), TAUT_ERROR_NULL_POINTER);
        assert_eq!(taut_generator_load_file(c"/no/such/file.onnx".as_ptr(), &mut other), TAUT_ERROR_FILE);
        assert!(said().contains("/no/such/file.onnx"), "{}", said());

        let mut correct = |words: &CStr, pins: &[u32], count: usize| {
            let field = field.as_mut_ptr();
            taut_generator_correct(g, words.as_ptr(), 0, grid, pins.as_ptr(), pins.len(), field, count, null_mut())
        };
        assert_eq!(correct(c"zorgon blarf", &[], 256), TAUT_ERROR_NO_KNOWN_WORD);
        assert!(said().contains("zorgon"), "{}", said());
        assert_eq!(correct(c"", &[], 256), TAUT_ERROR_NO_KNOWN_WORD);
        assert_eq!(correct(c"denim \xff", &[], 256), TAUT_ERROR_WRONG_KIND);
        assert_eq!(correct(c"denim", &[64], 256), TAUT_ERROR_NO_SUCH_PARTICLE);
        assert_eq!(correct(c"denim", &[u32::MAX], 256), TAUT_ERROR_NO_SUCH_PARTICLE);
        assert_eq!(correct(c"denim", &[], 255), TAUT_ERROR_SHAPE);
        let long = CString::new("denim ".repeat(4000)).expect("no NUL");
        assert_eq!(correct(&long, &[], 256), TAUT_ERROR_OUT_OF_RANGE);
        assert_eq!(
            taut_generator_correct(g, null(), 0, grid, null(), 0, field.as_mut_ptr(), 256, null_mut()),
            TAUT_ERROR_NULL_POINTER
        );
        assert_eq!(said(), "a pointer is NULL");
        let nothing = [0u64; 4];
        assert_eq!(taut_generator_info(nothing.as_ptr().cast(), null_mut()), TAUT_ERROR_BAD_HANDLE);
        assert!(field.iter().all(|k| *k == 1.0), "an error writes nothing");
        // a line that does not fit is cut, and no room is no crash
        assert_eq!(taut_generator_last_error(null_mut(), 0), said().len());
        let mut short = [1 as c_char; 4];
        taut_generator_last_error(short.as_mut_ptr(), 4);
        assert_eq!(short[3], 0);
    }

    // any number of threads
    let shared = g.expose_provenance();
    std::thread::scope(|scope| {
        for seed in 0..3u64 {
            let grid = grid.expose_provenance();
            scope.spawn(move || {
                let mut field = vec![0.0f32; 256];
                // SAFETY: generator and grid live on in the outer thread and never change.
                let code = unsafe {
                    taut_generator_correct(
                        std::ptr::with_exposed_provenance(shared),
                        c"denim".as_ptr(),
                        seed,
                        std::ptr::with_exposed_provenance(grid),
                        null(),
                        0,
                        field.as_mut_ptr(),
                        256,
                        null_mut(),
                    )
                };
                assert_eq!(code, TAUT_OK);
                assert!(field.iter().all(|k| k.is_finite() && *k > 0.0));
            });
        }
    });
    // SAFETY: made above and used by nobody else now.
    unsafe { taut_generator_free(g) };
}
