// taut's generator: a fabric in words to a stiffness field, offline or while a level is loaded.
//
// Generated from ffi/ by cbindgen; do not edit.
//
// These functions are in a library that was built with them:
//
//     cargo build --release -p taut-ffi --features generator
//
// Unlike taut.h they take memory from the heap and need the standard library of the system; link libtaut.a with -lpthread
// -ldl -lm where the linker asks for them. A game that ships baked field files (taut correct, taut_generator_bake) needs
// none of this.
//
// Results, pointers and units are as in taut.h. A call that fails says why in one line: taut_generator_last_error.


#ifndef TAUT_GENERATOR_H
#define TAUT_GENERATOR_H

#include "taut.h"

// A generator that was read: words in, a stiffness field out. It never changes, and any number of threads may use it at a
// time.
typedef struct taut_generator taut_generator;

// What a generator file says of itself.
typedef struct {
    // Words that it knows.
    uint64_t words;
    // Weights of the network.
    uint64_t parameters;
    // Bytes of the file.
    uint64_t file_bytes;
    // Particles along each side of its own field, before it is resampled.
    uint32_t grid;
    // Words of a description that count at most.
    uint32_t tokens;
} taut_generator_info_t;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Reads a generator from the bytes of its file (generator.onnx), which are not kept. Takes memory from the system's heap,
// unlike everything in taut.h; free it with taut_generator_free.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_TRUNCATED, TAUT_ERROR_WRONG_KIND (not a generator
// file), TAUT_ERROR_NOT_FINITE (a weight), TAUT_ERROR_OUT_OF_RANGE (above 64 MiB), TAUT_ERROR_INFERENCE.
// Threads: any.
TAUT_API
taut_result taut_generator_load(const void *data,
                                size_t size,
                                taut_generator **out_generator);

// The same from a file of this path (UTF-8).
//
// Errors: those of taut_generator_load, TAUT_ERROR_FILE.
// Threads: any.
TAUT_API taut_result taut_generator_load_file(const char *path, taut_generator **out_generator);

// Tells what a generator is.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: any.
TAUT_API taut_result taut_generator_info(const taut_generator *generator, taut_generator_info_t *out);

// The stiffness field of a fabric in words (UTF-8) for a grid and its pins, pin_count particles: 4 x rows x columns numbers
// in N/m, channels warp, weft, shear, bend, as taut_cloth_set_stiffness_field takes them. Another seed is another piece of
// the same fabric. What the words tell of the fabric goes to out_fabric, which may be NULL. The same arguments give the same
// bytes on one machine, and fields within 1e-5 on another: where machines must agree, ship what taut_generator_bake writes.
// Takes some milliseconds and memory of the heap: call it while a level is loaded. Words that the generator does not know
// are skipped; taut_generator_last_error names them.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (count is not
// 4 rows columns), TAUT_ERROR_WRONG_KIND (not UTF-8), TAUT_ERROR_NO_KNOWN_WORD, TAUT_ERROR_OUT_OF_RANGE (above 16 kB),
// TAUT_ERROR_NO_SUCH_PARTICLE, TAUT_ERROR_INFERENCE.
// Threads: any.
TAUT_API
taut_result taut_generator_correct(const taut_generator *generator,
                                   const char *description,
                                   uint64_t seed,
                                   const taut_grid *grid,
                                   const uint32_t *pins,
                                   size_t pin_count,
                                   float *out_field,
                                   size_t count,
                                   taut_fabric *out_fabric);

// The same as the bytes of a baked field file, which taut_cloth_load_stiffness reads: small, exact, the same everywhere.
// Writes at most capacity bytes; out_size is told how many it has, and may be asked for alone with data NULL and capacity 0.
//
// Errors: those of taut_generator_correct without TAUT_ERROR_SHAPE, TAUT_ERROR_BLOCK_TOO_SMALL (more than capacity; then
// out_size is told nothing).
// Threads: any.
TAUT_API
taut_result taut_generator_bake(const taut_generator *generator,
                                const char *description,
                                uint64_t seed,
                                const taut_grid *grid,
                                const uint32_t *pins,
                                size_t pin_count,
                                void *data,
                                size_t capacity,
                                size_t *out_size);

// One line about the last call of this thread to a function of this header: why it failed; where it answered TAUT_OK, the
// words that it skipped, or nothing. Writes at most size bytes with the NUL, cut where that is too few, and gives the bytes
// that the whole line has without it. buffer may be NULL with size 0.
//
// Threads: any; each has its own line.
TAUT_API
size_t taut_generator_last_error(char *buffer,
                                 size_t size);

// Frees a generator. NULL is nothing to free.
//
// Threads: needs the generator for itself.
TAUT_API void taut_generator_free(taut_generator *generator);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* TAUT_GENERATOR_H */
