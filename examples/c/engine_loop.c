// The loop of an engine: frames take as long as they take, the cloth takes fixed steps. Time that has passed is saved up in an
// accumulator and spent in whole steps; what is rendered lies between the last two of them. So the frame times change what
// is seen and when, but no bit of the cloth: four runs with other frame times end with the same hash.
//
//     cc -std=c11 -I include examples/c/engine_loop.c target/release/libtaut.a -o engine_loop
//     ./engine_loop
#include <stdio.h>

#include "taut.h"

enum {
    SIDE = 24,
    PARTICLES = SIDE * SIDE,
    RATE_HZ = 60,
    STEPS = 10 * RATE_HZ,
    MOST_STEPS_A_FRAME = 8, // after a longer pause (a breakpoint, a loading screen) the game is slow instead of busy
};

static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char
    cloth_block[TAUT_CLOTH_BYTES(SIDE, SIDE, TAUT_FAMILY_ALL, TAUT_FEATURE_NONE, 2)];

// The positions after the last two steps, and what lies between them.
static float previous[PARTICLES][3], current[PARTICLES][3], rendered[PARTICLES][3];

// Leaves the function with 0 and says what failed.
#define TRY(call)                                                              \
    do {                                                                       \
        taut_result result_ = (call);                                          \
        if (result_ != TAUT_OK) {                                              \
            fprintf(stderr, "%s: %s (%s)\n", #call, taut_result_message(result_), taut_result_name(result_)); \
            return 0;                                                          \
        }                                                                      \
    } while (0)

// A frame time of 1 to 100 ms in s, another one in each frame; seed 0 is a steady 144 Hz.
static double frame_time_s(uint32_t *seed)
{
    if (*seed == 0) {
        return 1.0 / 144.0;
    }
    *seed = *seed * 1664525u + 1013904223u;
    return 0.001 * (1 + (*seed >> 8) % 100);
}

// What the game does in a step. It may depend on the number of the step, not on the frame or the clock.
static int game_step(taut_cloth *cloth, uint64_t step)
{
    // the right corner swings 0.2 m to and fro, once in two seconds
    const int phase = (int)(step % 120);
    const double swing = (phase < 60 ? phase : 120 - phase) / 60.0;
    const double corner_m[3] = {1.0 - 0.2 * swing, 0.0, 0.0};
    uint32_t flags;
    TRY(taut_cloth_pin_move(cloth, SIDE - 1, corner_m));
    TRY(taut_cloth_step(cloth, &flags));
    return flags == 0;
}

static int copy(const taut_cloth *cloth, float to[PARTICLES][3])
{
    const double camera_m[3] = {0.0, 0.0, 0.0};
    TRY(taut_cloth_copy_positions_f32(cloth, camera_m, to, sizeof previous, sizeof previous[0]));
    return 1;
}

// Ten seconds of the game. Returns 1 and the hash if all went well.
static int run(taut_cloth *cloth, uint32_t seed, uint64_t *hash)
{
    TRY(taut_cloth_reset(cloth));
    TRY(taut_cloth_pin(cloth, 0));
    TRY(taut_cloth_pin(cloth, SIDE - 1));
    if (!copy(cloth, current)) {
        return 0;
    }

    const double step_s = 1.0 / RATE_HZ;
    double accumulator_s = 0.0;
    uint64_t step = 0;
    int frames = 0;
    while (step < STEPS) {
        accumulator_s += frame_time_s(&seed);
        if (accumulator_s > MOST_STEPS_A_FRAME * step_s) {
            accumulator_s = MOST_STEPS_A_FRAME * step_s;
        }
        while (accumulator_s >= step_s && step < STEPS) {
            for (int i = 0; i < PARTICLES; ++i) {
                for (int axis = 0; axis < 3; ++axis) {
                    previous[i][axis] = current[i][axis];
                }
            }
            if (!game_step(cloth, step) || !copy(cloth, current)) {
                return 0;
            }
            accumulator_s -= step_s;
            ++step;
        }

        // The part of a step that is still in the accumulator: 0 shows the step before the last one, 1 the last one. The
        // picture is up to a step behind, and never jumps.
        const float share = (float)(accumulator_s / step_s);
        if (step > 0) {
            for (int i = 0; i < PARTICLES; ++i) {
                for (int axis = 0; axis < 3; ++axis) {
                    rendered[i][axis] = previous[i][axis] + (current[i][axis] - previous[i][axis]) * share;
                }
            }
        }
        ++frames;
    }
    TRY(taut_cloth_state_hash(cloth, hash));
    printf("%4d frames, %d steps, state hash %016llx\n", frames, STEPS, (unsigned long long)*hash);
    return 1;
}

int main(void)
{
    taut_grid_def grid_def = taut_grid_def_default();
    grid_def.rows = SIDE;
    grid_def.columns = SIDE;
    taut_grid *grid;
    taut_cloth *cloth;
    if (taut_check_version(TAUT_VERSION_ID) != TAUT_OK ||
        taut_grid_create(&grid_def, grid_block, sizeof grid_block, &grid) != TAUT_OK) {
        return 2;
    }
    taut_cloth_def def = taut_cloth_def_default(grid);
    def.rate_hz = RATE_HZ; // the fixed step: the frame rate of the screen is no business of the cloth
    def.inertia_radius_m = 0.3f;
    def.max_pins = 2;
    if (taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, &cloth) != TAUT_OK ||
        taut_cloth_set_stiffness_uniform(cloth, 1000.0f, 600.0f, 200.0f, 8.0f) != TAUT_OK) {
        return 2;
    }

    uint64_t steady, hash;
    if (!run(cloth, 0, &steady)) {
        return 2;
    }
    for (uint32_t seed = 1; seed <= 3; ++seed) {
        if (!run(cloth, seed, &hash)) {
            return 2;
        }
        if (hash != steady) {
            fprintf(stderr, "the frame times reached the cloth\n");
            return 1;
        }
    }
    return 0;
}
