// taut: mass-spring cloth for games that does not stretch like rubber.
//
// Generated from ffi/ by cbindgen; do not edit.
//
// CONVENTIONS
//
// Memory. Nothing here allocates, and there are no globals. A grid and a cloth live in blocks that you hand in: ask
// taut_grid_memory and taut_cloth_memory how large and how aligned, or use TAUT_GRID_BYTES and TAUT_CLOTH_BYTES for static
// storage. The block is yours: keep it where it is while the handle is used; there is nothing to destroy. Arrays, files and
// snapshots that you lend are used during the call only, and must not overlap the block of the cloth.
//
// Definitions come from taut_*_def_default(); then change the fields that you need. They begin with their size and a
// cookie, by which a definition that was filled in otherwise or belongs to another version is found.
//
// Results. Every call that can fail answers with a taut_result: TAUT_OK is 0, everything else is negative and has changed
// and written nothing. Outputs come last and are only written on success. NULL and misaligned pointers are answered, never
// followed; so is a handle whose block does not hold (any more) what it should. A pointer to memory that is not yours
// cannot be found out. Nothing panics, aborts or calls back.
//
// Threads. One cloth belongs to one thread at a time. Calls with a `const taut_cloth *` only read and may run at the same
// time as each other; calls with a `taut_cloth *` need it for themselves. Different cloths are independent. A grid never
// changes and may be used by any number of threads.
//
// Determinism. The same calls give the same bits on every machine. A call that computes sets the default floating-point
// environment (no flush-to-zero, round to nearest) and gives back the one that it found.
//
// Units are SI: m, s, kg, N. World positions are double; inside a cloth positions are float in a local frame that starts at
// origin_m. No axis is "up". Particle (row, column) has the index row * columns + column; u runs along the columns, v along
// the rows; warp runs along v, weft along u.
//
// docs/c-api.md has the longer story, examples/c/drape.c a program; taut.hpp is this API for C++17.


#ifndef TAUT_H
#define TAUT_H

#include <stddef.h>
#include <stdint.h>

// The version of this header as one number, for taut_check_version.
#define TAUT_VERSION_ID \
    (((uint32_t)TAUT_VERSION_MAJOR << 24) | ((uint32_t)TAUT_VERSION_MINOR << 16) | (uint32_t)TAUT_VERSION_PATCH)

// TAUT_API is before every function. With the static library, and outside of Windows, there is nothing to set. A program for
// Windows that links taut.dll is compiled with TAUT_SHARED (the CMake target taut::shared sets it); who builds the functions
// into a library of his own that hands them on, with TAUT_EXPORTS.
#if defined(TAUT_API)
#elif defined(_WIN32) && defined(TAUT_EXPORTS)
#define TAUT_API __declspec(dllexport)
#elif defined(_WIN32) && defined(TAUT_SHARED)
#define TAUT_API __declspec(dllimport)
#elif defined(__GNUC__) && !defined(_WIN32)
#define TAUT_API __attribute__((visibility("default")))
#else
#define TAUT_API
#endif

// Triangles of a grid as a constant expression: what taut_grid_triangle_count gives.
#define TAUT_TRIANGLES(rows, columns) ((size_t)2 * ((size_t)(rows) - 1) * ((size_t)(columns) - 1))

// Bytes of a cloth's block as a constant expression, for static storage: the same number that taut_cloth_memory gives for a
// grid of rows x columns with these TAUT_FAMILY_* and a definition with these TAUT_FEATURE_* and max_pins, which is at most
// rows * columns.
#define TAUT_CLOTH_BYTES(rows, columns, families, features, max_pins)                                        \
    ((size_t)TAUT_CLOTH_HEADER_BYTES +                                                                       \
     (size_t)4 * (TAUT_CLOTH_PLANES_(families, features) * TAUT_CLOTH_PLANE_(rows, columns) +                \
                  18 * TAUT_CLOTH_STRIDE_(columns) + TAUT_CLOTH_LISTS_(rows, columns, features, max_pins)))

// Parts of TAUT_CLOTH_BYTES. A plane is one number per particle with its borders. This is the table of what takes memory:
// first the planes of every cloth, then a line for each family and each feature; and the lists with a capacity.
#define TAUT_CLOTH_PLANES_(families, features)                                                               \
    ((size_t)17 +                                                                                            \
     TAUT_IF_(families, TAUT_FAMILY_SHEAR, 3) +                                                              \
     TAUT_IF_(families, TAUT_FAMILY_BEND, 3) +                                                               \
     TAUT_IF_(features, TAUT_FEATURE_PULL, 3) +                                                              \
     TAUT_IF_(features, TAUT_FEATURE_AIR | TAUT_FEATURE_HINGE | TAUT_FEATURE_MASS, 3) +                      \
     TAUT_IF_(features, TAUT_FEATURE_MASS, 1) +                                                              \
     TAUT_IF_(features, TAUT_FEATURE_MASK, 1) +                                                              \
     TAUT_IF_(features, TAUT_FEATURE_TETHERS | TAUT_FEATURE_LEVELS, 4) +                                     \
     TAUT_IF_(features, TAUT_FEATURE_STRAIN_LIMIT | TAUT_FEATURE_LEVELS, 3) +                                \
     TAUT_IF_(features, TAUT_FEATURE_TARGETS, 15) +                                                          \
     TAUT_IF_(features, TAUT_FEATURE_IMPLICIT, TAUT_CLOTH_IMPLICIT_(families)))
#define TAUT_CLOTH_IMPLICIT_(families)                                                                       \
    (33 + TAUT_IF_(families, TAUT_FAMILY_SHEAR, 4) + TAUT_IF_(families, TAUT_FAMILY_BEND, 4))
#define TAUT_CLOTH_LISTS_(rows, columns, features, max_pins)                                                                \
    (TAUT_ROUND_16_((size_t)7 * (size_t)(max_pins)) +                                                        \
     TAUT_IF_(features, TAUT_FEATURE_TETHERS | TAUT_FEATURE_LEVELS,                                          \
              TAUT_CLOTH_TETHERS_(TAUT_CLOTH_PLANE_(rows, columns))) +                                       \
     TAUT_IF_(features, TAUT_FEATURE_LEVELS,                                                                 \
              TAUT_CLOTH_LEVELS_(rows, columns, 11 + TAUT_IF_(features, TAUT_FEATURE_MASK, 1))) +            \
     TAUT_IF_(features, TAUT_FEATURE_COLLIDERS, TAUT_MAX_COLLIDERS * 32) +                                   \
     TAUT_IF_(features, TAUT_FEATURE_IMPLICIT, 16 + TAUT_CLOTH_COARSE_(rows, columns)))
#define TAUT_CLOTH_COARSE_(m, n)                                                                             \
    (TAUT_CLOTH_LEVEL_(m, n, 1) + TAUT_CLOTH_LEVEL_(m, n, 2) + TAUT_CLOTH_LEVEL_(m, n, 3) +                  \
     TAUT_CLOTH_LEVEL_(m, n, 4) + TAUT_CLOTH_LEVEL_(m, n, 5) + TAUT_CLOTH_LEVEL_(m, n, 6) +                  \
     TAUT_CLOTH_LEVEL_(m, n, 7) + TAUT_CLOTH_LEVEL_(m, n, 8) + TAUT_CLOTH_LEVEL_(m, n, 9) +                  \
     TAUT_CLOTH_LEVEL_(m, n, 10) + TAUT_CLOTH_LEVEL_(m, n, 11))
#define TAUT_CLOTH_LEVEL_(m, n, i)                                                                           \
    (((((size_t)(m) - 2) >> ((i) - 1)) >= 2 && (((size_t)(n) - 2) >> ((i) - 1)) >= 2)                        \
         ? 13 * TAUT_ROUND_16_(((((size_t)(m) - 2) >> (i)) + 5) * ((((size_t)(n) - 2) >> (i)) + 5) + 2)      \
         : 0)
#define TAUT_CLOTH_TETHERS_(plane) (2 * TAUT_ROUND_16_(((plane) + 15) / 16))
#define TAUT_CLOTH_LEVELS_(m, n, planes)                                                                     \
    (TAUT_CLOTH_NODES_(m, n, 1, planes) + TAUT_CLOTH_NODES_(m, n, 2, planes) +                               \
     TAUT_CLOTH_NODES_(m, n, 3, planes) + TAUT_CLOTH_NODES_(m, n, 4, planes) +                               \
     TAUT_CLOTH_NODES_(m, n, 5, planes) + TAUT_CLOTH_NODES_(m, n, 6, planes) +                               \
     TAUT_CLOTH_NODES_(m, n, 7, planes) + TAUT_CLOTH_NODES_(m, n, 8, planes) +                               \
     TAUT_CLOTH_NODES_(m, n, 9, planes))
#define TAUT_CLOTH_NODES_(m, n, k, planes)                                                                   \
    ((TAUT_CLOTH_HALVINGS_(m) >= (k) || TAUT_CLOTH_HALVINGS_(n) >= (k))                                      \
         ? (planes) * TAUT_CLOTH_NODE_PLANE_(m, n, k) + TAUT_CLOTH_TETHERS_(TAUT_CLOTH_NODE_PLANE_(m, n, k)) \
         : 0)
#define TAUT_CLOTH_NODE_PLANE_(m, n, k)                                                                      \
    (TAUT_ROUND_16_(TAUT_CLOTH_NODE_COUNT_(n, k)) * TAUT_CLOTH_NODE_COUNT_(m, k) + 32)
#define TAUT_CLOTH_NODE_COUNT_(n, k)                                                                         \
    TAUT_CLOTH_SPANS_((size_t)(n) - 1, TAUT_CLOTH_HALVINGS_(n) < (k) ? TAUT_CLOTH_HALVINGS_(n) : (k))
#define TAUT_CLOTH_SPANS_(cells, halvings) ((((cells) + (((size_t)1 << (halvings)) >> 1)) >> (halvings)) + 1)
#define TAUT_CLOTH_HALVINGS_(n)                                                                              \
    (((n) > 8) + ((n) > 16) + ((n) > 32) + ((n) > 64) + ((n) > 128) + ((n) > 256) + ((n) > 512) +            \
     ((n) > 1024) + ((n) > 2048))
#define TAUT_CLOTH_STRIDE_(columns) (TAUT_ROUND_16_(columns) + 16)
#define TAUT_CLOTH_PLANE_(rows, columns) (TAUT_CLOTH_STRIDE_(columns) * ((size_t)(rows) + 4) + 32)
#define TAUT_ROUND_16_(n) (((size_t)(n) + 15) / 16 * 16)
#define TAUT_IF_(bits, bit, numbers) (((bits) & (bit)) ? (size_t)(numbers) : (size_t)0)


// Version of this header and library, as in 1.2.3.
#define TAUT_VERSION_MAJOR 0

// Second number of the version. While the first one is 0, a change of it may break programs.
#define TAUT_VERSION_MINOR 1

// Third number of the version.
#define TAUT_VERSION_PATCH 0

// Most particles of a grid side.
#define TAUT_MAX_SIDE 4096

// Structural springs to the four neighbours: warp along v, weft along u. Always on.
#define TAUT_FAMILY_STRUCTURAL 1

// Shear springs to the four diagonal neighbours.
#define TAUT_FAMILY_SHEAR 2

// Bend springs to the particles two cells away.
#define TAUT_FAMILY_BEND 4

// All spring families.
#define TAUT_FAMILY_ALL 7

// No optional parts.
#define TAUT_FEATURE_NONE 0

// Forces on single particles (taut_cloth_add_force).
#define TAUT_FEATURE_PULL 1

// Air: drag, lift and wind (taut_cloth_set_air).
#define TAUT_FEATURE_AIR 2

// Hinge bending of the rigidity taut_cloth_def.hinge_rigidity_n_m.
#define TAUT_FEATURE_HINGE 4

// Tethers to the nearest pins.
#define TAUT_FEATURE_TETHERS 8

// The strain limit.
#define TAUT_FEATURE_STRAIN_LIMIT 16

// The strain limit on levels, from coarse to fine.
#define TAUT_FEATURE_LEVELS 32

// Colliders, up to TAUT_MAX_COLLIDERS.
#define TAUT_FEATURE_COLLIDERS 64

// A skinned target of each particle with a largest distance and a backstop.
#define TAUT_FEATURE_TARGETS 128

// A mass of its own for each particle (taut_cloth_set_masses).
#define TAUT_FEATURE_MASS 256

// Absent particles (taut_cloth_set_mask).
#define TAUT_FEATURE_MASK 512

// Working memory of an implicit solver; taut_cloth_def.solver chooses it.
#define TAUT_FEATURE_IMPLICIT 1024

// Most colliders of a cloth.
#define TAUT_MAX_COLLIDERS 32

// A flag of taut_cloth_step: the frame would have ended with a number that is not finite. It was taken back whole:
// positions, velocities, pins and step index are those before the call; pin targets, forces and the ways of colliders and
// targets in the frame are dropped. One of the TAUT_STEP_NON_FINITE_* names the cause beside it.
#define TAUT_STEP_NON_FINITE 1

// A flag of taut_cloth_step: the cloth slept through the frame; only the step index has changed.
#define TAUT_STEP_ASLEEP 2

// A flag of taut_cloth_step: a pin is not finite, or without the ways of the pins the frame would have stayed finite.
#define TAUT_STEP_NON_FINITE_PIN 4

// A flag of taut_cloth_step: the air is not finite, or in still air the frame would have stayed finite.
#define TAUT_STEP_NON_FINITE_AIR 8

// A flag of taut_cloth_step: a force is not finite, or without the forces of taut_cloth_add_force the frame would have stayed
// finite.
#define TAUT_STEP_NON_FINITE_FORCE 16

// A flag of taut_cloth_step: a collider is not finite, or without the ways of the colliders the frame would have stayed
// finite.
#define TAUT_STEP_NON_FINITE_COLLIDER 32

// A flag of taut_cloth_step: a skinned target is not finite, or without the ways of the targets the frame would have stayed
// finite.
#define TAUT_STEP_NON_FINITE_TARGET 64

// A flag of taut_cloth_step: none of these; positions, velocities or springs themselves run away.
#define TAUT_STEP_NON_FINITE_STATE 128

// A flag of taut_budget_report: the predicted stretch is above 0.2. It is not within 15 % of what will be, and the cloth
// will look like rubber.
#define TAUT_BUDGET_ABOVE_RANGE 1

// A flag of taut_budget_report: there is no prediction. The cloth does not hang from a whole straight edge or from its two
// corners with nothing but its weight to bear, its warp is more than twice as stiff as its weft or the reverse (two corners),
// or its rest was not found. The bound holds.
#define TAUT_BUDGET_STRETCH_UNKNOWN 2

// A flag of taut_budget_report: limits were asked for that this cloth may exceed: tethers or the strain limit alone, levels
// with a mask or with level_cycles above 0, or levels with a strain_limit below 3 m/s times dt / the smallest rest length.
#define TAUT_BUDGET_LIMIT_NOT_KEPT 4

// Bytes of the block of a grid, on every target.
#define TAUT_GRID_BYTES 64

// Alignment of the block of a grid in bytes.
#define TAUT_GRID_ALIGN 8

// Bytes at the start of a cloth's block that its numbers follow, on every target.
#define TAUT_CLOTH_HEADER_BYTES 2048

// Alignment of the block of a cloth in bytes.
#define TAUT_CLOTH_ALIGN 64

// What a call answers: 0 is success, everything else is negative. A number keeps its meaning for good; new ones are only
// appended. A call that answers with an error has changed nothing and written nothing.
enum taut_result
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Done.
    TAUT_OK = 0,
    // A pointer is NULL.
    TAUT_ERROR_NULL_POINTER = -1,
    // A pointer or the block of memory is not aligned as was asked for.
    TAUT_ERROR_MISALIGNED = -2,
    // The block of memory is smaller than was asked for.
    TAUT_ERROR_BLOCK_TOO_SMALL = -3,
    // A definition was not made by its default function, or belongs to another version (its size or cookie is wrong).
    TAUT_ERROR_BAD_DEFINITION = -4,
    // A grid side has fewer than 2 or more than 4096 particles.
    TAUT_ERROR_GRID_SIZE = -5,
    // A side length is not finite, not above 0, or above 10 km.
    TAUT_ERROR_SIDE_LENGTH = -6,
    // The frame rate is not within 1 to 10,000 Hz, or the substeps are not within 1 to 1,024.
    TAUT_ERROR_STEP_SIZE = -7,
    // A number that must be finite is NaN or infinite.
    TAUT_ERROR_NOT_FINITE = -8,
    // A number that must not be negative is negative.
    TAUT_ERROR_NEGATIVE = -9,
    // A number is outside the range that its documentation gives.
    TAUT_ERROR_OUT_OF_RANGE = -10,
    // There is no particle of this index.
    TAUT_ERROR_NO_SUCH_PARTICLE = -11,
    // The particle is not pinned.
    TAUT_ERROR_NOT_PINNED = -12,
    // More pins than max_pins of the definition.
    TAUT_ERROR_TOO_MANY_PINS = -13,
    // The feature was not asked for in the definition, so it has no memory.
    TAUT_ERROR_FEATURE_OFF = -14,
    // The stiffness was never set.
    TAUT_ERROR_NO_STIFFNESS = -15,
    // An array has another shape than the call needs.
    TAUT_ERROR_SHAPE = -16,
    // The bytes end early.
    TAUT_ERROR_TRUNCATED = -17,
    // The bytes are not of the expected kind.
    TAUT_ERROR_WRONG_KIND = -18,
    // The bytes were written by a version that this one cannot read.
    TAUT_ERROR_UNSUPPORTED_VERSION = -19,
    // The bytes were changed: their checksum does not match.
    TAUT_ERROR_CHECKSUM = -20,
    // The snapshot belongs to a cloth of another grid or definition.
    TAUT_ERROR_FOREIGN = -21,
    // The damping is too strong for the step: damping times dt must stay below 1.
    TAUT_ERROR_DAMPING = -22,
    // The program was compiled with the header of another version.
    TAUT_ERROR_VERSION_MISMATCH = -23,
    // This machine lacks the vector width.
    TAUT_ERROR_UNSUPPORTED_WIDTH = -24,
    // The particle is absent: the mask says so.
    TAUT_ERROR_ABSENT = -25,
    // There is no collider of this id (any more).
    TAUT_ERROR_NO_SUCH_COLLIDER = -26,
    // There are TAUT_MAX_COLLIDERS colliders already.
    TAUT_ERROR_TOO_MANY_COLLIDERS = -27,
    // Not even the cheapest settings fit the time.
    TAUT_ERROR_NO_PLAN = -28,
    // The handle was not made by its create function, its block was overwritten, or the block was moved. Codes from -100
    // on exist in C only.
    TAUT_ERROR_BAD_HANDLE = -100,
    // A file cannot be opened or read (taut_generator.h).
    TAUT_ERROR_FILE = -101,
    // The generator knows no word of the description (taut_generator.h).
    TAUT_ERROR_NO_KNOWN_WORD = -102,
    // The network of a generator file cannot be run, or answers with what is no stiffness (taut_generator.h).
    TAUT_ERROR_INFERENCE = -103,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum taut_result taut_result;
#else
typedef int32_t taut_result;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How the stiffness is cut to what the step can carry. All four channels of a particle are cut alike.
enum taut_budget
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // 0.25 of the limit of the flat sheet, which holds for every shape of the cloth: stable from any start, and with some
    // damping (1/s) it comes to rest without any limit on speed or compression. 0.31 of the stiffness of TAUT_BUDGET_TUNED.
    TAUT_BUDGET_CERTIFIED = 0,
    // 0.8 of the limit of the flat sheet. Needs the speed limit and some damping. The default.
    TAUT_BUDGET_TUNED = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum taut_budget taut_budget;
#else
typedef uint32_t taut_budget;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How a frame is solved.
enum taut_solver
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Symplectic Euler: explicit and cheapest; the stiffness is cut to the budget. The default.
    TAUT_SOLVER_SYMPLECTIC_EULER = 0,
    // Implicit Euler with conjugate gradients: the stiffness as it is, at any step; damps motion.
    TAUT_SOLVER_IMPLICIT_EULER = 1,
    // The second-order backward difference formula with conjugate gradients: as above, with less damping.
    TAUT_SOLVER_BDF2 = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum taut_solver taut_solver;
#else
typedef uint32_t taut_solver;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The shape of a collider.
enum taut_shape
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // A ball around the collider's position: radius_m[0].
    TAUT_SHAPE_SPHERE = 1,
    // The hull of two balls: ends_m and radius_m. Where one ball holds the other it is the larger ball.
    TAUT_SHAPE_CAPSULE = 2,
    // The half space behind the plane through the collider's position: normal.
    TAUT_SHAPE_PLANE = 3,
    // A box around the collider's position: half_m.
    TAUT_SHAPE_BOX = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum taut_shape taut_shape;
#else
typedef uint32_t taut_shape;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The vectors that a cloth is stepped in. Each gives the same bits; only the time differs.
enum taut_width
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // One number at a time: every processor.
    TAUT_WIDTH_SCALAR = 0,
    // 4 numbers: every x86_64.
    TAUT_WIDTH_SSE2 = 1,
    // 8 numbers: x86_64 with AVX2.
    TAUT_WIDTH_AVX2 = 2,
    // 16 numbers: x86_64 with AVX-512F.
    TAUT_WIDTH_AVX512 = 3,
    // 4 numbers: every aarch64.
    TAUT_WIDTH_NEON = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum taut_width taut_width;
#else
typedef uint32_t taut_width;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How a sheet is held: what decides where it stretches, and how fast that grows with its grid.
enum taut_hold
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // A whole edge is pinned: a banner, a flag, a cape along the shoulders.
    TAUT_HOLD_EDGE = 0,
    // Points of an edge are pinned, at most a few cells apart: a curtain.
    TAUT_HOLD_HOOKS = 1,
    // Two far corners are pinned.
    TAUT_HOLD_CORNERS = 2,
    // One particle is pinned.
    TAUT_HOLD_CORNER = 3,
    // Nothing is pinned: it lies on something.
    TAUT_HOLD_LOOSE = 4,
    // An area in its middle is pinned, and the rest hangs over: a cloth clamped to a table.
    TAUT_HOLD_AREA = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum taut_hold taut_hold;
#else
typedef uint32_t taut_hold;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Where a planned stiffness comes from.
enum taut_stiffness
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // As stiff as the step carries: taut_cloth_set_stiffness_uniform with 1e8 N/m four times. It stretches less than the
    // fabric.
    TAUT_STIFFNESS_STIFFEST = 0,
    // The fabric's own.
    TAUT_STIFFNESS_FABRIC = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum taut_stiffness taut_stiffness;
#else
typedef uint32_t taut_stiffness;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// One frame of a cloth, stepped in bands of rows: begun by taut_cloth_bands_begin, ended by taut_bands_end. Between the two
// nothing else may use the cloth; taut_bands_run and taut_bands_count may be called by any number of threads at a time.
typedef struct taut_bands taut_bands;

// A cloth in a block of the caller's memory. One thread at a time: functions that take `taut_cloth *` change it, and
// nothing else may use it meanwhile; functions that take `const taut_cloth *` may run at the same time as one another.
// Different cloths never share anything.
typedef struct taut_cloth taut_cloth;

// The topology of a cloth: which particles exist and which springs join them. It never changes, and any number of threads
// may use it at a time. A cloth copies what it needs, so the grid's block may go when its cloths are made.
typedef struct taut_grid taut_grid;

// What a grid is made of. Comes from taut_grid_def_default(), then change what you need.
typedef struct {
    // Bytes of this structure. Set by taut_grid_def_default().
    uint32_t size;
    // Shows that the definition came from taut_grid_def_default().
    uint32_t cookie;
    // Particles along v, 2 to 4096. Default 32.
    uint32_t rows;
    // Particles along u, 2 to 4096. Default 32.
    uint32_t columns;
    // Side length along u in m, above 0, at most 10,000. Default 1.
    float width_m;
    // Side length along v in m, above 0, at most 10,000. Default 1.
    float height_m;
    // Spring families, TAUT_FAMILY_* or-ed; the structural ones must be on. A family that is off costs no memory and no
    // time. Default TAUT_FAMILY_ALL.
    uint32_t families;
} taut_grid_def;

// Memory that a call asks for.
typedef struct {
    // Bytes.
    size_t size;
    // Alignment of the first byte, a power of two.
    size_t align;
} taut_memory;

// Sizes of a grid.
typedef struct {
    // Particles along v.
    uint32_t rows;
    // Particles along u.
    uint32_t columns;
    // Particles, rows times columns. Particle (row, column) has the index row * columns + column.
    uint32_t particles;
    // Springs of all families that are on.
    uint32_t springs;
} taut_counts;

// What is to be planned. Comes from taut_plan_def_default(), then change what you need.
typedef struct {
    // Bytes of this structure. Set by taut_plan_def_default().
    uint32_t size;
    // Shows that the definition came from taut_plan_def_default().
    uint32_t cookie;
    // How the sheet is held, a taut_hold. Default TAUT_HOLD_CORNERS.
    uint32_t hold;
    // Largest structural strain at rest, above 0, at most 1 (0.05 is 5 %). Default 0.05.
    float tolerance;
    // CPU time of a frame in ns, above 0. Default infinite.
    float budget_ns;
    // CPU time of a plain particle-step on this machine in ns, above 0, at most 1e6: the time of a taut_cloth_step of a cloth
    // without features divided by its particles and substeps. Default 7.
    float plain_ns;
    // Frames per second, 1 to 10,000. Default 60.
    float rate_hz;
    // Size of gravity in m/s^2, above 0, at most 1e4. Default 9.81.
    float gravity_m_s2;
    // Mass per area in kg/m^2, 1e-6 to 1e6. Default 0.2.
    float density_kg_m2;
    // The fabric's warp, weft, shear and bend in N/m, each 0 to 1e9. Default 2000, 2000, 60, 1.
    float stiffness_n_m[4];
} taut_plan_def;

// Settings that a scene requires, and what to expect of them. taut_plan_apply() writes them into the definitions.
typedef struct {
    // The solver, a taut_solver.
    uint32_t solver;
    // Substeps of a frame.
    uint32_t substeps;
    // Iterations of an implicit solver.
    uint32_t cg_iterations;
    // Spring families for the grid.
    uint32_t families;
    // Features that the plan needs, to be or-ed with those that the scene needs.
    uint32_t features;
    // Where the stiffness comes from, a taut_stiffness.
    uint32_t stiffness;
    // Radius of the inertia field in m; 0 = none.
    float inertia_radius_m;
    // For all three of strain_limit.
    float strain_limit;
    // For all three of tether_slack.
    float tether_slack;
    // Passes of the levels over the cloth itself in each cycle.
    uint32_t strain_passes;
    // Cycles through the levels in each substep; 0 = until the limit is kept.
    uint32_t level_cycles;
    // The speed limit in rest lengths a substep.
    float speed_limit;
    // Largest structural strain to expect at rest, with a margin that nine of ten measured rows stay under.
    float strain;
    // CPU time to expect of a frame in ns, with what such scenes mostly need beside: a collider and hinges where a sheet lies on
    // something.
    float frame_ns;
    // 1 where the strain is within the tolerance; 0 where these are the settings of the least strain that fit the time.
    uint32_t meets;
} taut_settings;

// What a cloth is made of beside its grid. Comes from taut_cloth_def_default(), then change what you need. SI units; no
// axis is "up".
typedef struct {
    // Bytes of this structure. Set by taut_cloth_def_default().
    uint32_t size;
    // Shows that the definition came from taut_cloth_def_default().
    uint32_t cookie;
    // World position of the cloth's local frame in m, each at most 1e12 in size: where particle 0 starts. Default 0, 0, 0.
    double origin_m[3];
    // Frames per second, 1 to 10,000. One taut_cloth_step is one frame. Fixed for the life of the cloth. Default 60.
    float rate_hz;
    // Equal substeps of a frame, 1 to 1,024. dt = 1 / (rate_hz * substeps). More substeps carry stiffer cloth. Default 16.
    uint32_t substeps;
    // Mass per area in kg/m^2, 1e-6 to 1e6; taut_field_info tells that of a baked field. Default 0.2.
    float density_kg_m2;
    // Damping c in 1/s: the force -c M v on each particle. At least 0, and c dt below 1. Default 2.
    float damping_per_s;
    // Speed limit as a fraction of the smallest rest length per substep, 1e-6 to 1e6; 0 = none. Default 0.25. The
    // implicit solvers need none and do not know it.
    float speed_limit;
    // 1: a compressed spring pushes with at most its stiffness times its length, which keeps crumpled cloth from
    // exploding; 0: off. Default 1.
    uint32_t compression_limit;
    // A taut_budget. Default TAUT_BUDGET_TUNED.
    uint32_t budget;
    // Radius of the inertia field in m, 0 to 1e4; 0 = none. A particle closer to a pin than this has more inertia (radius /
    // distance times its mass, its weight unchanged), so that the cloth can be stiff at the pins, where it stretches most,
    // at no cost in dt. Default 0.
    float inertia_radius_m;
    // Largest factor of the inertia field, 1 to 1e4. Default 32.
    float inertia_max;
    // Most pins at a time, 28 bytes each; more than there are particles means all of them. Default 256, or the number of
    // particles if that is less.
    uint32_t max_pins;
    // A taut_solver; the implicit ones need TAUT_FEATURE_IMPLICIT. Default TAUT_SOLVER_SYMPLECTIC_EULER.
    uint32_t solver;
    // Iterations of the conjugate gradients of an implicit solver in each of the two linearisations of a substep, 1 to 1,000.
    // Default 10.
    uint32_t cg_iterations;
    // How much longer than the way through the resting cloth a tether may get: warp, weft, diagonal, each 0 to 10 (0.05 is
    // 5 %). Default 0.
    float tether_slack[3];
    // Largest strain that the strain limit and the levels aim at; the levels keep it along warp and weft (see level_cycles):
    // warp, weft, diagonal, each 0 to 10. Default 0.05.
    float strain_limit[3];
    // Passes of the strain limit in each substep, and of the levels over the cloth itself in each cycle, 1 to 64. Default 2.
    uint32_t strain_passes;
    // Bending rigidity D of the hinges in N m, 0 to 1e6. Default 1e-5.
    float hinge_rigidity_n_m;
    // A cloth whose particles are all slower than this for half a second sleeps until something wakes it, in m/s, 0 to
    // 1e3; 0 = never. Default 0.
    float sleep_speed_m_s;
    // Optional parts, TAUT_FEATURE_* or-ed. What is not asked for costs no memory and no time. Default TAUT_FEATURE_NONE.
    uint32_t features;
    // Gravity in m/s^2, at most 1e4 in size. Default 0, -9.81, 0.
    float gravity_m_s2[3];
    // Direction of u (along a row) at the start, 1e-3 to 1e3 long. Default 1, 0, 0.
    float u_axis[3];
    // Direction of v (along a column, from row 0 on) at the start, 1e-3 to 1e3 long. Default 0, -1, 0.
    float v_axis[3];
    // Cycles through the levels in each substep, 1 to 32: at most so many are paid, and strain_limit is what they aim at,
    // nothing that they promise. 0: as many as it takes that no structural spring is beyond strain_limit, at most 32. Only
    // with TAUT_FEATURE_LEVELS. Default 0.
    uint32_t level_cycles;
} taut_cloth_def;

// What a baked field tells about its fabric beside the stiffness.
typedef struct {
    // Mass per area in kg/m^2.
    float density_kg_m2;
    // Bending rigidity of a hinge in N m.
    float hinge_rigidity_n_m;
    // Largest stretch of the fabric in use along the warp, as a fraction. To be strain limits with TAUT_FEATURE_LEVELS where
    // cut_fraction of taut_cloth_budget is above 0.75; below, the field stretches like its fabric by itself, and limits hold
    // it too tight.
    float limit_warp;
    // The same along the weft.
    float limit_weft;
    // The same along the diagonal.
    float limit_diagonal;
} taut_fabric;

// What a baked field is.
typedef struct {
    // The seed it was generated with.
    uint64_t seed;
    // Hash of the description it was generated from.
    uint64_t description_hash;
    // Rows of the field. It need not be those of the grid: the field is resampled.
    uint32_t rows;
    // Columns of the field.
    uint32_t columns;
    // What it tells about the fabric.
    taut_fabric fabric;
    // 0.
    uint32_t reserved;
} taut_field;

// What the budget made of the stiffness.
typedef struct {
    // Length of a substep in s.
    float dt_s;
    // Largest substep in s that would have kept the whole stiffness; infinite where there is none to keep.
    float max_dt_s;
    // Share of the stiffness that was cut, 0 to 1.
    float cut_fraction;
    // Inertia that the inertia field adds, as a share of the mass of the free particles.
    float inertia_added;
    // Share of the hinge rigidity that is kept, 0 to 1; 1 without hinges. Hinges may use a quarter of what the step can carry.
    float hinge_fraction;
    // Predicted strain of the most stretched structural spring (0.05 is 5 %), when the cloth hangs at rest from a whole edge or
    // from the two corners of one: within 15 % of what will be measured, up to 0.2. 0 where the flags say that it is unknown;
    // only taut_cloth_predict_stretch knows it.
    float stretch;
    // What the largest strain never exceeds, in a cloth that started unstretched and whose pins do not move: at rest, and
    // unless stretch is known on the way there too. Infinite where nothing bounds it.
    float stretch_bound;
    // TAUT_BUDGET_ABOVE_RANGE and so on, or-ed.
    uint32_t flags;
} taut_budget_report;

// Where something is in the world and how it is turned: a collider, the frame of a cloth.
typedef struct {
    // Position in m: of a collider at most 1e6 from the cloth's origin along each axis, of a frame at most 1e12 in size.
    double position_m[3];
    // Rotation as a quaternion x, y, z, w, 1e-3 to 1e3 long. Of a frame only its changes count (the local axes stay those of the
    // world): 0, 0, 0, 1 is how the cloth was made.
    float rotation[4];
} taut_pose;

// What a collider is made of. Comes from taut_collider_def_default(), then change what you need. Lengths are in m, in the
// collider's own frame; fields that the shape does not use are not looked at.
typedef struct {
    // Bytes of this structure. Set by taut_collider_def_default().
    uint32_t size;
    // Shows that the definition came from taut_collider_def_default().
    uint32_t cookie;
    // Where it is. Default 0, 0, 0, not turned.
    taut_pose pose;
    // A taut_shape.
    uint32_t shape;
    // Coefficient of Coulomb friction, 0 to 100. Default 0.3.
    float friction;
    // Distance from the shape that the particles keep, in m, 0 to 1e3. Default 0.005.
    float thickness_m;
    // Radius of the sphere, or of the capsule at its two ends, 1e-6 to 1e4. Default 0.1, 0.1.
    float radius_m[2];
    // Ends of the capsule, at most 1e4 along each axis. Default (0, -0.1, 0) and (0, 0.1, 0).
    float ends_m[2][3];
    // Direction out of the half space, 1e-3 to 1e3 long. Default (0, 1, 0).
    float normal[3];
    // Half the side lengths of the box, 1e-6 to 1e4. Default (0.1, 0.1, 0.1).
    float half_m[3];
    // 0.
    uint32_t reserved;
} taut_collider_def;

// The air around a cloth: drag and lift by the velocity of its cells relative to the wind. Comes from taut_air_default(),
// then change what you need.
typedef struct {
    // Velocity of the wind in m/s, at most 1e3 in size. Default 0, 0, 0.
    float wind_m_s[3];
    // Density in kg/m^3, 0 to 1e4; 0 = no air. Default 1.2.
    float density_kg_m3;
    // Drag coefficient, 0 to 100: the drag of an area A at right angles to the flow is 0.5 density drag A speed^2. Default
    // 1.2, that of a square plate.
    float drag;
    // Lift coefficient, 0 to 100: the lift of an area A at the angle of attack a is 0.5 density lift A speed^2 sin(a) cos(a).
    // Default 1.2.
    float lift;
    // Gusts as a share of the wind's speed, 0 to 1: each component of the wind varies smoothly by up to so much. Default 0.
    float gust;
    // How often a gust turns per second, 0 to 1e3. Default 1.
    float gust_hz;
    // Which gusts: they are a function of the seed and the step index alone. Default 0.
    uint32_t seed;
} taut_air;

// The positions of a cloth without a copy: particle (row, column) is number row * row_stride + column of x, y and z, in m
// in the local frame; add origin_m for the world. Valid until the next call that is handed the cloth without const.
typedef struct {
    // World position of the local frame in m.
    double origin_m[3];
    // x of each particle in m.
    const float *x;
    // y of each particle in m.
    const float *y;
    // z of each particle in m.
    const float *z;
    // Numbers from a row to the next; more than columns.
    size_t row_stride;
    // Particles along v.
    size_t rows;
    // Particles along u.
    size_t columns;
} taut_position_view;

// Strain of the structural springs: (length - rest length) / rest length, so 0.05 is stretched by 5 %.
typedef struct {
    // Largest over all structural springs.
    float largest;
    // Mean over all structural springs.
    float mean;
} taut_strain;

// A box with sides along the axes, in the world in m.
typedef struct {
    // Smallest x, y and z in m.
    double low_m[3];
    // Largest x, y and z in m.
    double high_m[3];
} taut_bounds;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of the library that runs, in the form of TAUT_VERSION_ID: major << 24 | minor << 16 | patch.
//
// Threads: any.
TAUT_API uint32_t taut_version(void);

// Whether a program that was compiled with this header may use the library that it found at run time: call
// taut_check_version(TAUT_VERSION_ID) first. Before 1.0 the first two numbers must be equal; from then on the first one
// must be equal and the library's second one must not be smaller.
//
// Errors: TAUT_ERROR_VERSION_MISMATCH; taut_version() tells what was found.
// Threads: any.
TAUT_API taut_result taut_check_version(uint32_t version_id);

// The name of a result as it stands in this header ("TAUT_ERROR_GRID_SIZE"), "TAUT_ERROR_UNKNOWN" for a number that is
// no result. Never NULL; the text lives as long as the library.
//
// Threads: any.
TAUT_API const char *taut_result_name(int32_t result);

// One line in English that says what a result means. Never NULL; the text lives as long as the library.
//
// Threads: any.
TAUT_API const char *taut_result_message(int32_t result);

// The default grid: 32 x 32 particles, 1 m x 1 m, all spring families.
//
// Threads: any.
TAUT_API taut_grid_def taut_grid_def_default(void);

// Memory that a grid needs: never more than TAUT_GRID_BYTES, aligned to TAUT_GRID_ALIGN.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_DEFINITION, TAUT_ERROR_GRID_SIZE,
// TAUT_ERROR_SIDE_LENGTH, TAUT_ERROR_OUT_OF_RANGE (families).
// Threads: any.
TAUT_API taut_result taut_grid_memory(const taut_grid_def *def, taut_memory *out);

// Makes a grid in the caller's block of block_size bytes. The block is the caller's to keep and to free; there is nothing
// to destroy.
//
// Errors: those of taut_grid_memory, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
// Threads: any.
TAUT_API
taut_result taut_grid_create(const taut_grid_def *def,
                             void *block,
                             size_t block_size,
                             taut_grid **out);

// Rows, columns, particles and springs of a grid.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: any.
TAUT_API taut_result taut_grid_counts(const taut_grid *from, taut_counts *out);

// 64-bit digest of what a grid was made of: two grids are the same topology when their digests agree. The same on every
// machine.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: any.
TAUT_API taut_result taut_grid_digest(const taut_grid *from, uint64_t *out);

// The default plan: two far corners of a light woven, 5 % at rest, 60 frames per second, any time.
//
// Threads: any.
TAUT_API taut_plan_def taut_plan_def_default(void);

// The settings that a scene on a grid requires: the cheapest that meet the tolerance within the time, or, where none do, those
// of the least strain that fit the time. They come from a table of measured rows; nothing is simulated.
//
// Errors: those of taut_grid_memory, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE, TAUT_ERROR_OUT_OF_RANGE,
// TAUT_ERROR_STEP_SIZE (the rate), TAUT_ERROR_NO_PLAN: not even the cheapest fit the time.
// Threads: any.
TAUT_API
taut_result taut_plan(const taut_grid_def *on,
                      const taut_plan_def *def,
                      taut_settings *out);

// Writes settings into the definitions of a grid and of a cloth: families, solver, substeps, iterations, inertia, limits and
// speed limit, and their features beside those that are there. Every other field stays. The stiffness is not part of a
// definition: after taut_cloth_create() call taut_cloth_set_stiffness_uniform() with 1e8 four times for
// TAUT_STIFFNESS_STIFFEST, with the fabric's own for TAUT_STIFFNESS_FABRIC.
//
// Errors: those of taut_grid_memory, and those of taut_cloth_memory for the definitions as they would be; then nothing is
// changed.
// Threads: any.
TAUT_API
taut_result taut_plan_apply(const taut_settings *settings,
                            taut_grid_def *on,
                            taut_cloth_def *def);

// The default cloth for a grid: 60 Hz x 16 substeps, 0.2 kg/m^2, hanging from particle 0 in the direction -y. The grid
// tells how many pins there can be; it may be NULL, which means a grid of 256 particles or more.
//
// Threads: any.
TAUT_API taut_cloth_def taut_cloth_def_default(const taut_grid *on);

// Memory that a cloth needs. For static storage TAUT_CLOTH_BYTES tells the same at compile time.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE (grid), TAUT_ERROR_BAD_DEFINITION,
// TAUT_ERROR_STEP_SIZE, TAUT_ERROR_DAMPING, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE, TAUT_ERROR_OUT_OF_RANGE.
// Threads: any.
TAUT_API taut_result taut_cloth_memory(const taut_grid *on, const taut_cloth_def *def, taut_memory *out);

// Makes a cloth in the caller's block of block_size bytes: flat, at rest, nothing pinned, without stiffness. The content of
// the block does not matter. The block is the caller's to keep until the cloth is no longer used, and then to free; there
// is nothing to destroy. It must stay where it is: a copy of it is no cloth (use a snapshot).
//
// Errors: those of taut_cloth_memory, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BLOCK_TOO_SMALL. Then the block is as it was.
// Threads: any.
TAUT_API
taut_result taut_cloth_create(const taut_grid *on,
                              const taut_cloth_def *def,
                              void *block,
                              size_t block_size,
                              taut_cloth **out);

// Back to the start: flat, at rest, nothing pinned, no collider, step 0, gravity, damping, air, targets, frame and rest lengths
// as they were made. Stiffness, masses and mask stay.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_reset(taut_cloth *cloth);

// Checks a baked field file of size bytes and tells what it is: so the density is known before the cloth is made.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_TRUNCATED, TAUT_ERROR_WRONG_KIND,
// TAUT_ERROR_UNSUPPORTED_VERSION, TAUT_ERROR_GRID_SIZE, TAUT_ERROR_SHAPE, TAUT_ERROR_CHECKSUM, TAUT_ERROR_NOT_FINITE,
// TAUT_ERROR_NEGATIVE.
// Threads: any.
TAUT_API taut_result taut_field_info(const void *data, size_t size, taut_field *out);

// Sets one stiffness for the whole cloth, in N/m, each at least 0: warp (along v), weft (along u), shear, bend. What the
// step cannot carry is cut by the budget, with the ratios kept.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
// TAUT_ERROR_NEGATIVE. Then the former stiffness stays.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_stiffness_uniform(taut_cloth *cloth,
                                             float warp_n_m,
                                             float weft_n_m,
                                             float shear_n_m,
                                             float bend_n_m);

// Sets the stiffness field: channels * rows * columns numbers in N/m, each at least 0, as [channel][row][column], at the
// particles; a spring has the mean of its two ends. 4 channels are warp, weft, shear, bend; 1 channel stands for all four in
// the ratios 1, 1, 0.3, 0.02. Rows and columns, 2 to 4096 each, need not be those of the grid: the field is resampled.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_GRID_SIZE, TAUT_ERROR_SHAPE
// (channels), TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE. Then the former stiffness stays.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_stiffness_field(taut_cloth *cloth,
                                           uint32_t channels,
                                           uint32_t rows,
                                           uint32_t columns,
                                           const float *data);

// The same for numbers that nobody vouches for, such as those that a network printed: every field of the right shape is
// taken. NaN and negative numbers are read as 0, what is above 1e9 (infinity too) as 1e9. What the step cannot carry is cut
// by the budget, as always. How many numbers were read otherwise than they stand goes to out_repaired, which may be NULL.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_GRID_SIZE, TAUT_ERROR_SHAPE
// (channels). Then the former stiffness stays.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_stiffness_field_sanitised(taut_cloth *cloth,
                                                     uint32_t channels,
                                                     uint32_t rows,
                                                     uint32_t columns,
                                                     const float *data,
                                                     uint32_t *out_repaired);

// Sets the stiffness from a baked field file of size bytes, resampled where its grid is another. What the file tells about
// the fabric goes to out_fabric, which may be NULL.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, and those of taut_field_info. Then the
// former stiffness stays.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_load_stiffness(taut_cloth *cloth,
                                      const void *data,
                                      size_t size,
                                      taut_fabric *out_fabric);

// The report of taut_cloth_budget with the stretch to expect, and a sharper bound where that is known. The rest of a sheet that
// hangs from an edge is searched for, which takes from milliseconds at 16 x 16 to seconds at 64 x 64: for a loading screen,
// not for a frame.
//
// Errors: those of taut_cloth_budget.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_predict_stretch(taut_cloth *cloth,
                                       taut_budget_report *out);

// What the budget makes of the stiffness with the pins as they are, and the bound of the stretch: told before the first
// step, and kept. What stretch to expect: taut_cloth_predict_stretch.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_STIFFNESS.
// Threads: changes the cloth.
TAUT_API taut_result taut_cloth_budget(taut_cloth *cloth, taut_budget_report *out);

// Chooses which particles exist, by a byte for each of the count particles: 0 is absent, everything else is present. Needs
// TAUT_FEATURE_MASK; at first all are present. May be called at any time, so a cloth can tear.
//
// An absent particle has no springs, no weight and no pin, and is left out of strain and energy; its position stays where
// it last was, and one that comes back is there at rest. A bend spring also needs the particle in its middle, a diagonal one
// of the two other corners of its cell. taut_cloth_reset keeps the mask and a snapshot does not hold it, but a snapshot that
// was taken under another mask is TAUT_ERROR_FOREIGN. All or nothing.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF, TAUT_ERROR_SHAPE
// (count is not the number of particles).
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_mask(taut_cloth *cloth,
                                uint32_t count,
                                const uint8_t *present);

// Sets the mass of each of the count particles in kg, 1e-6 to 1e6 times its share of the sheet's mass (density times width
// times height over the number of particles), which is what each has at first. Needs TAUT_FEATURE_MASS. Velocities stay as
// they are. taut_cloth_reset keeps the masses and a snapshot does not hold them, but a snapshot that was taken with other
// masses is TAUT_ERROR_FOREIGN. All or nothing.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF, TAUT_ERROR_SHAPE
// (count is not the number of particles), TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE, TAUT_ERROR_OUT_OF_RANGE.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_masses(taut_cloth *cloth,
                                  uint32_t count,
                                  const float *mass_kg);

// Gravity from the next step on, x, y, z in m/s^2, at most 1e4 in size. It is part of the state once it is not that of the
// definition any more; so are damping and rest lengths.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
// TAUT_ERROR_OUT_OF_RANGE.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_gravity(taut_cloth *cloth,
                                   const float gravity_m_s2[3]);

// Damping c from the next step on, in 1/s: at least 0, and c dt below 1. The budget depends on it and is computed anew.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
// TAUT_ERROR_NEGATIVE, TAUT_ERROR_DAMPING.
// Threads: changes the cloth.
TAUT_API taut_result taut_cloth_set_damping(taut_cloth *cloth, float damping_per_s);

// Factors of the rest lengths from the next step on, 0.5 to 2: of the warp (structural and bend springs along v), the weft
// (those along u), and the diagonals. Below 1 the cloth shrinks, or is pre-stretched where pins hold it; above 1 it has slack.
// With the same factor for all three a flat sheet is flat without tension again. Strain is that against the scaled lengths;
// the stiffness stays, and the budget is computed anew.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
// TAUT_ERROR_OUT_OF_RANGE.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_rest_scale(taut_cloth *cloth,
                                      float warp,
                                      float weft,
                                      float diagonal);

// Pins a particle where it is. One that is pinned already stays as it is.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_PARTICLE,
// TAUT_ERROR_ABSENT, TAUT_ERROR_TOO_MANY_PINS.
// Threads: changes the cloth.
TAUT_API taut_result taut_cloth_pin(taut_cloth *cloth, uint32_t particle);

// Moves a pin: at the end of the next frame it is at world_m (x, y, z in m), and on the way there it is interpolated over
// the substeps. Without a new call it then stays.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_PARTICLE,
// TAUT_ERROR_NOT_PINNED, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (more than 1e6 m from the cloth's origin).
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_pin_move(taut_cloth *cloth,
                                uint32_t particle,
                                const double world_m[3]);

// Frees a pinned particle; it keeps the velocity of its pin.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_PARTICLE,
// TAUT_ERROR_NOT_PINNED.
// Threads: changes the cloth.
TAUT_API taut_result taut_cloth_unpin(taut_cloth *cloth, uint32_t particle);

// Number of pins.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_pin_count(const taut_cloth *cloth, uint32_t *out);

// A definition of a collider with its defaults; shape is a taut_shape.
//
// Threads: any.
TAUT_API taut_collider_def taut_collider_def_default(uint32_t shape);

// Adds a collider, of which a cloth has up to TAUT_MAX_COLLIDERS. Needs TAUT_FEATURE_COLLIDERS. out_id is its id: a value,
// never 0, that is not given again after the collider was removed. Ids are part of the state: after taut_cloth_restore
// or taut_cloth_reset the same calls give the same ids again. Particles that are inside are moved out over the nearest
// surface, by at most 1/16 of the smallest rest length in each substep. docs/contact.md tells what a collider does.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_BAD_DEFINITION,
// TAUT_ERROR_FEATURE_OFF, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE, TAUT_ERROR_OUT_OF_RANGE (also a shape that is none, a
// size of 0), TAUT_ERROR_TOO_MANY_COLLIDERS.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_collider_add(taut_cloth *cloth,
                                    const taut_collider_def *def,
                                    uint32_t *out_id);

// Moves a collider: at the end of the next frame it is at pose, and on the way there its position is interpolated linearly
// over the substeps and its rotation along the shorter arc. Its surface drags the cloth with it. Without a new call it then
// stays.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_COLLIDER,
// TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (more than 1e6 m from the cloth's origin, a rotation of length 0).
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_collider_move(taut_cloth *cloth,
                                     uint32_t id,
                                     const taut_pose *pose);

// Puts a collider somewhere at once, with no way and no velocity between: a teleport. Particles that are inside then are
// moved out as after taut_cloth_collider_add.
//
// Errors: those of taut_cloth_collider_move.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_collider_set_pose(taut_cloth *cloth,
                                         uint32_t id,
                                         const taut_pose *pose);

// Removes a collider; its id is answered with TAUT_ERROR_NO_SUCH_COLLIDER from now on.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_COLLIDER.
// Threads: changes the cloth.
TAUT_API taut_result taut_cloth_collider_remove(taut_cloth *cloth, uint32_t id);

// Where a collider is now, before the next frame.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_COLLIDER.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_collider_pose(const taut_cloth *cloth, uint32_t id, taut_pose *out);

// Number of colliders.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_collider_count(const taut_cloth *cloth, uint32_t *out);

// Sets how far each of the count particles may be from its target; count is the number of particles of the grid. Needs
// TAUT_FEATURE_TARGETS. max_distance_m is the largest distance in m, 0 to 1e6 or infinity (free, as before the first call);
// with 0 the particle is where its target is. The backstop is a ball that the particle stays out of: its radius in m, 0 to
// 1e6 (0 = none), and the distance of its surface behind the target, against the normal of the skin, 0 to 1e6 m; either may
// be NULL, which means 0. All or nothing.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF, TAUT_ERROR_SHAPE
// (count), TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE, TAUT_ERROR_OUT_OF_RANGE.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_target_limits(taut_cloth *cloth,
                                         uint32_t count,
                                         const float *max_distance_m,
                                         const float *backstop_radius_m,
                                         const float *backstop_distance_m);

// Moves the targets of the count particles: at the end of the next frame they are there, and on the way they are
// interpolated linearly over the substeps. Without a new call they then stay. Before the first call they are the places and
// the normal of the flat cloth at its start.
//
// positions_m holds x, y, z in m of each particle as floats, as seen from base_m, a point of the world in m; normals the
// outward normals of the skin, 1e-3 to 1e3 long (0, 0, 0 keeps the last one), or NULL, which keeps them all. stride is the
// bytes from a particle to the next in both, at least 12; neither need be aligned. All or nothing.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth, base_m), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF,
// TAUT_ERROR_SHAPE (count, stride), TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (more than 1e6 m from the cloth's
// origin, a normal of another length).
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_move_targets(taut_cloth *cloth,
                                    const double base_m[3],
                                    uint32_t count,
                                    const void *positions_m,
                                    const void *normals,
                                    size_t stride);

// Puts the targets somewhere at once, with no way and no velocity between: for the first frame and for teleports. The
// arguments are those of taut_cloth_move_targets.
//
// Errors: those of taut_cloth_move_targets.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_targets(taut_cloth *cloth,
                                   const double base_m[3],
                                   uint32_t count,
                                   const void *positions_m,
                                   const void *normals,
                                   size_t stride);

// Puts a particle somewhere, at rest; a pinned one together with its pin. local_m is x, y, z in m in the cloth's local
// frame (the world less origin_m).
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_PARTICLE,
// TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (more than 1e6 m along an axis).
// Threads: changes the cloth.
TAUT_API taut_result taut_cloth_set_position(taut_cloth *cloth, uint32_t particle, const float local_m[3]);

// Puts all particles somewhere, at rest, pinned ones together with their pins. local_m holds x, y, z of each of the count
// particles in m in the cloth's local frame, particle after particle; count is the number of particles of the grid. All or
// nothing.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (count),
// TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (more than 1e6 m along an axis).
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_positions(taut_cloth *cloth,
                                     uint32_t count,
                                     const float *local_m);

// Sets the velocity of a particle, x, y, z in m/s; a pinned one keeps that of its pin.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_PARTICLE,
// TAUT_ERROR_ABSENT, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (above 1e6 m/s along an axis).
// Threads: changes the cloth.
TAUT_API taut_result taut_cloth_set_velocity(taut_cloth *cloth, uint32_t particle, const float v_m_s[3]);

// Adds a force on a particle, x, y, z in N, which acts during the next frame. Needs TAUT_FEATURE_PULL.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF,
// TAUT_ERROR_NO_SUCH_PARTICLE, TAUT_ERROR_ABSENT, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (above 1e9 N along an axis).
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_add_force(taut_cloth *cloth,
                                 uint32_t particle,
                                 const float force_n[3]);

// Still air of 1.2 kg/m^3, drag and lift 1.2: what a cloth with TAUT_FEATURE_AIR starts with.
//
// Threads: any.
TAUT_API taut_air taut_air_default(void);

// Sets the air from the next step on. Needs TAUT_FEATURE_AIR. May be called every frame; but the budget counts drag as
// damping, in steps of a factor of 2, so a wind that grows a lot makes the next step cut the stiffness anew.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF,
// TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE, TAUT_ERROR_OUT_OF_RANGE. Then the former air stays.
// Threads: changes the cloth.
TAUT_API taut_result taut_cloth_set_air(taut_cloth *cloth, const taut_air *air);

// The air as it is now. Needs TAUT_FEATURE_AIR.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_air(const taut_cloth *cloth, taut_air *out);

// The frame is at a new place at the end of the next step: that of the character whom the cloth follows. linear_inertia and
// angular_inertia, 0 to 1, are the shares of its shift and its turn since the last frame that the cloth feels; with the rest
// it is carried along, at no strain and no velocity. Pins and colliders go where they are told to be in the world, so it
// does not matter whether they are moved before or after this call; a pin that is not moved stays where it is.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
// TAUT_ERROR_OUT_OF_RANGE (also a way of more than 1e6 m along an axis: that is a teleport).
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_frame(taut_cloth *cloth,
                                 const taut_pose *frame,
                                 float linear_inertia,
                                 float angular_inertia);

// The cloth is elsewhere at once, with its pins and colliders and where they go to: it does not notice. A change of place alone
// leaves every bit of the local state; a turn rounds positions and velocities.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
// TAUT_ERROR_OUT_OF_RANGE.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_teleport(taut_cloth *cloth,
                                const taut_pose *frame);

// Moves the origin of the local frame, x, y, z in m, each at most 1e12 in size, and the cloth with all that is attached to it:
// for engines that shift their world. The local state and its hash stay, to the bit.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
// TAUT_ERROR_OUT_OF_RANGE.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_origin(taut_cloth *cloth,
                                  const double origin_m[3]);

// Where the frame is.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_frame(const taut_cloth *cloth, taut_pose *out);

// Steps one frame: 1 / rate_hz seconds in `substeps` equal substeps. Pins move to their targets, forces act. The same
// calls give the same bits on every machine, whatever floating-point modes the engine has set.
//
// out_flags, which may be NULL, tells what happened: 0, or TAUT_STEP_* or-ed.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_STIFFNESS.
// Threads: changes the cloth.
TAUT_API taut_result taut_cloth_step(taut_cloth *cloth, uint32_t *out_flags);

// Steps count frames, 0 or more; pin targets and forces belong to the first. It ends early after a frame that was taken back
// (TAUT_STEP_NON_FINITE); taut_cloth_step_index tells how far it came.
//
// out_flags, which may be NULL, tells what happened: 0, or TAUT_STEP_* or-ed.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_STIFFNESS.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_step_many(taut_cloth *cloth,
                                 uint32_t count,
                                 uint32_t *out_flags);

// Frames stepped since the creation, the last reset, or those of the snapshot that was restored.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_step_index(const taut_cloth *cloth, uint64_t *out);

// Steps each of count cloths one frame, in the order of the list: for each of them the same as taut_cloth_step. It starts
// no threads; to step on many give each a list of its own. A cloth that is named twice is stepped twice. out_flags, which
// may be NULL, gets the TAUT_STEP_* of each cloth, count of them; it must not overlap the list or a cloth.
//
// All or nothing: the whole list is checked before the first cloth is stepped.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE (any cloth), TAUT_ERROR_NO_STIFFNESS (any
// cloth). Then no cloth was stepped.
// Threads: changes all cloths of the list.
TAUT_API
taut_result taut_cloth_step_all(taut_cloth *const *cloths,
                                uint32_t count,
                                uint32_t *out_flags);

// Memory that a frame in bands of rows_per_band rows needs beside the cloth, at least 8 rows; the last band takes what is
// left over. It is the same for every frame.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_OUT_OF_RANGE (fewer rows than 8;
// an implicit solver, TAUT_FEATURE_STRAIN_LIMIT or TAUT_FEATURE_LEVELS: such a cloth cannot be stepped in bands).
// Threads: reads the cloth.
TAUT_API
taut_result taut_cloth_bands_memory(const taut_cloth *cloth,
                                    uint32_t rows_per_band,
                                    taut_memory *out);

// Begins a frame that many threads step: bands of rows_per_band rows, in a block of block_size bytes of the caller's, whose
// content does not matter. Then taut_bands_run for every phase and band, then taut_bands_end: the cloth is as it is after
// taut_cloth_step, with the same bits, for any number of bands and threads. The block must stay until the end.
//
// Errors: those of taut_cloth_bands_memory, TAUT_ERROR_BLOCK_TOO_SMALL, TAUT_ERROR_NO_STIFFNESS. Then nothing was begun.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_bands_begin(taut_cloth *cloth,
                                   uint32_t rows_per_band,
                                   void *block,
                                   size_t block_size,
                                   taut_bands **out);

// How many bands there are, and how many phases: 0 where there is nothing to step, as in a cloth that sleeps.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: any, also several at a time.
TAUT_API taut_result taut_bands_count(const taut_bands *bands, uint32_t *out_bands, uint32_t *out_phases);

// Steps one band through one phase, both counted from 0. All bands of a phase may run at the same time, in any order; a
// phase begins when all bands have ended the one before, which a job system sees to (a barrier, a counter). What comes too
// early or twice is refused.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_OUT_OF_RANGE (no such band; not the
// band's next phase; a band has yet to end the phase before). Then nothing was done.
// Threads: any, also several at a time.
TAUT_API
taut_result taut_bands_run(const taut_bands *bands,
                           uint32_t phase,
                           uint32_t band);

// Ends the frame; the handle is none any more. out_flags, which may be NULL, gets the TAUT_STEP_* of taut_cloth_step.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_OUT_OF_RANGE (a band has phases to
// go: then the particles are taken back to where they were before the frame, and the handle is none any more either).
// Threads: changes the cloth.
TAUT_API
taut_result taut_bands_end(taut_bands *bands,
                           uint32_t *out_flags);

// Whether this machine has the vectors of a taut_width: 1, or 0.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_OUT_OF_RANGE (no taut_width).
// Threads: any.
TAUT_API taut_result taut_width_supported(uint32_t number, uint32_t *out);

// Steps in other vectors (a taut_width) from now on, to time or test them: the bits stay the same. A cloth begins with the widest
// ones of the machine. This is no part of the state: no snapshot holds it, and a reset keeps it.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_OUT_OF_RANGE (no taut_width),
// TAUT_ERROR_UNSUPPORTED_WIDTH (this machine lacks it).
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_set_width(taut_cloth *cloth,
                                 uint32_t number);

// The vectors that the cloth is stepped in: a taut_width.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_width(const taut_cloth *cloth, uint32_t *out);

// The positions without a copy.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_positions(const taut_cloth *cloth, taut_position_view *out);

// Copies the world positions in m as three doubles per particle, in the order of the particles. out has out_size bytes;
// stride is the bytes from a particle to the next, at least 24. Bytes between are left alone, and out need not be aligned.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (stride),
// TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
// Threads: reads the cloth.
TAUT_API
taut_result taut_cloth_copy_positions_f64(const taut_cloth *cloth,
                                          void *out,
                                          size_t out_size,
                                          size_t stride);

// Copies the positions as seen from base_m, a point of the world in m (the camera, or 0, 0, 0), as three floats per
// particle in m, in the order of the particles: so a vertex buffer stays exact far from the world's origin. out has
// out_size bytes; stride is the bytes from a particle to the next, at least 12. Bytes between are left alone, and out need
// not be aligned.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth, base_m), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE
// (base_m), TAUT_ERROR_SHAPE (stride), TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
// Threads: reads the cloth.
TAUT_API
taut_result taut_cloth_copy_positions_f32(const taut_cloth *cloth,
                                          const double base_m[3],
                                          void *out,
                                          size_t out_size,
                                          size_t stride);

// Copies the velocities in m/s as three floats per particle, in the order of the particles. out has out_size bytes; stride
// is the bytes from a particle to the next, at least 12. Bytes between are left alone, and out need not be aligned.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (stride),
// TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
// Threads: reads the cloth.
TAUT_API
taut_result taut_cloth_copy_velocities_f32(const taut_cloth *cloth,
                                           void *out,
                                           size_t out_size,
                                           size_t stride);

// Strain of the structural springs as they are now. Takes time in proportion to the particles.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_strain(const taut_cloth *cloth, taut_strain *out);

// Kinetic energy in J, with the inertia of the inertia field. Takes time in proportion to the particles.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_kinetic_energy(const taut_cloth *cloth, double *out_j);

// Number of triangles of a grid, two in each cell. For static storage TAUT_TRIANGLES tells the same.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: any.
TAUT_API taut_result taut_grid_triangle_count(const taut_grid *from, uint32_t *out);

// Copies the triangles as three particle indices each, a list without gaps for an index buffer: cell after cell along the
// rows, each cell cut from its lower left to its upper right corner. Counterclockwise is the front, the side from which u
// runs to the right and v runs down, as a picture is looked at. out has out_size bytes, of which 12 per triangle are
// written, and need not be aligned.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (from), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_BLOCK_TOO_SMALL. Then
// nothing is written.
// Threads: any.
TAUT_API
taut_result taut_grid_copy_triangles_u32(const taut_grid *from,
                                         void *out,
                                         size_t out_size);

// The same as 16-bit indices, 6 bytes per triangle, for a grid of at most 65,536 particles.
//
// Errors: those of taut_grid_copy_triangles_u32, TAUT_ERROR_OUT_OF_RANGE (more particles). Then nothing is written.
// Threads: any.
TAUT_API taut_result taut_grid_copy_triangles_u16(const taut_grid *from, void *out, size_t out_size);

// Copies the texture coordinates as two floats per particle, 0 to 1, in the order of the particles: 0, 0 at particle 0, u
// along the columns, v along the rows. out has out_size bytes; stride is the bytes from a particle to the next, at least 8.
// Bytes between are left alone, and out need not be aligned.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (from), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (stride),
// TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
// Threads: any.
TAUT_API
taut_result taut_grid_copy_uvs_f32(const taut_grid *from,
                                   void *out,
                                   size_t out_size,
                                   size_t stride);

// Copies the unit normals as three floats per particle, in the order of the particles, into a vertex buffer of its own or,
// with out at the place of the first normal, into one that the positions are in too. A normal is the mean of those of the
// one to four cells around the particle, weighted by their areas. It points to the front, the side from which u runs to
// the right and v runs down; 0, 0, 0 where those cells have no area. out has out_size bytes; stride is the bytes from a
// particle to the next, at least 12. Bytes between are left alone, and out need not be aligned.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (stride),
// TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
// Threads: reads the cloth.
TAUT_API
taut_result taut_cloth_copy_normals_f32(const taut_cloth *cloth,
                                        void *out,
                                        size_t out_size,
                                        size_t stride);

// The box around all particles, in the world in m, for culling. Takes time in proportion to the particles.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_bounds(const taut_cloth *cloth, taut_bounds *out);

// Wakes a cloth that sleeps (taut_cloth_def.sleep_speed_m_s). Calls that change something do it by themselves.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: changes the cloth.
TAUT_API taut_result taut_cloth_wake(taut_cloth *cloth);

// Whether the cloth sleeps: 1, or 0.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_is_asleep(const taut_cloth *cloth, uint32_t *out);

// Force with which a pin holds its particle in the state as it is now, x, y, z in N: the opposite of springs, weight, pull,
// air and hinges on the particle; what it is pinned to feels the opposite. At rest the sum over the pins is the weight of
// the sheet. What tethers, strain limits, colliders and targets carry is not in it, nor what accelerates the particle.
//
// Takes the time of a particle; with TAUT_FEATURE_AIR, _HINGE or _MASS that of a pass over the cloth.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_PARTICLE,
// TAUT_ERROR_NOT_PINNED.
// Threads: changes the cloth (it settles what a change of pins does to the inertia).
TAUT_API
taut_result taut_cloth_pin_force(taut_cloth *cloth,
                                 uint32_t particle,
                                 float out_n[3]);

// Copies the force of every pin (taut_cloth_pin_force) as three floats in N, in the order of the pinned particles, of which
// there are taut_cloth_pin_count. out has out_size bytes; stride is the bytes from a pin to the next, at least 12. Bytes
// between are left alone, and out need not be aligned.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (stride),
// TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
// Threads: changes the cloth (it settles what a change of pins does to the inertia).
TAUT_API
taut_result taut_cloth_copy_pin_forces_f32(taut_cloth *cloth,
                                           void *out,
                                           size_t out_size,
                                           size_t stride);

// Bytes of a snapshot of the cloth as it is now. It grows with the pins and with pending forces.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_snapshot_size(const taut_cloth *cloth, size_t *out);

// Bytes that every snapshot of this cloth fits in, however many pins and forces it will have.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: reads the cloth.
TAUT_API taut_result taut_cloth_snapshot_size_max(const taut_cloth *cloth, size_t *out);

// Writes the state (positions, velocities, pins, pending forces, step index, and what was changed of gravity, damping,
// rest lengths and frame) into out, which has out_size bytes and need not
// be aligned. Every machine writes and reads the same bytes. Stiffness, masses, mask and definition are left out: they do
// not change by stepping. out_written, which may be NULL, gets the number of bytes.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth, out_written), TAUT_ERROR_BAD_HANDLE,
// TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
// Threads: changes the cloth (it settles what a change of pins does to the inertia).
TAUT_API
taut_result taut_cloth_snapshot(taut_cloth *cloth,
                                void *out,
                                size_t out_size,
                                size_t *out_written);

// Reads a state back from size bytes, which need not be aligned. The whole snapshot is checked before anything is changed.
// Going on from it gives the bits that it gave the first time, provided that the stiffness is the same.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_TRUNCATED,
// TAUT_ERROR_WRONG_KIND, TAUT_ERROR_UNSUPPORTED_VERSION, TAUT_ERROR_FOREIGN, TAUT_ERROR_SHAPE, TAUT_ERROR_CHECKSUM,
// and, where a cloth did not write the bytes, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE, TAUT_ERROR_NEGATIVE,
// TAUT_ERROR_DAMPING, TAUT_ERROR_NO_SUCH_PARTICLE, TAUT_ERROR_ABSENT. Then the cloth is as it was.
// Threads: changes the cloth.
TAUT_API
taut_result taut_cloth_restore(taut_cloth *cloth,
                               const void *data,
                               size_t size);

// 64-bit hash of the state: two machines that play in lockstep compare it. The frame is not in it, so they may have their
// worlds' origins elsewhere.
//
// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
// Threads: changes the cloth (it settles what a change of pins does to the inertia).
TAUT_API
taut_result taut_cloth_state_hash(taut_cloth *cloth,
                                  uint64_t *out);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* TAUT_H */
