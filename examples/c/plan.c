// The planner picks the settings, and the cloth shows whether what it told is true: a sheet of SIDE x SIDE particles on two
// corners for 10 s, for one tolerance after the other.
//
//     cc -std=c11 -I include examples/c/plan.c target/release/libtaut.a -o plan
//     ./plan
#include <stdio.h>

#include "taut.h"

enum { SIDE = 96 };

static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
// whatever it picks fits
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char cloth_block[TAUT_CLOTH_BYTES(
    SIDE, SIDE, TAUT_FAMILY_ALL, TAUT_FEATURE_TETHERS | TAUT_FEATURE_LEVELS | TAUT_FEATURE_IMPLICIT, 2)];

// Leaves the function with 0 and says what failed.
#define TRY(call)                                                              \
    do {                                                                       \
        taut_result result_ = (call);                                          \
        if (result_ != TAUT_OK) {                                              \
            fprintf(stderr, "%s: %s (%s)\n", #call, taut_result_message(result_), taut_result_name(result_)); \
            return 0;                                                          \
        }                                                                      \
    } while (0)

static int hang(float tolerance)
{
    taut_plan_def wish = taut_plan_def_default();
    wish.hold = TAUT_HOLD_CORNERS;
    wish.tolerance = tolerance;

    taut_grid_def grid_def = taut_grid_def_default();
    grid_def.rows = grid_def.columns = SIDE;
    taut_settings settings;
    TRY(taut_plan(&grid_def, &wish, &settings));

    taut_cloth_def def = taut_cloth_def_default(NULL);
    def.max_pins = 2;
    TRY(taut_plan_apply(&settings, &grid_def, &def));

    taut_grid *grid;
    TRY(taut_grid_create(&grid_def, grid_block, sizeof grid_block, &grid));
    taut_cloth *cloth;
    TRY(taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, &cloth));
    const float stiffest[4] = {1e8f, 1e8f, 1e8f, 1e8f};
    const float *k = settings.stiffness == TAUT_STIFFNESS_FABRIC ? wish.stiffness_n_m : stiffest;
    TRY(taut_cloth_set_stiffness_uniform(cloth, k[0], k[1], k[2], k[3]));
    TRY(taut_cloth_pin(cloth, 0));
    TRY(taut_cloth_pin(cloth, SIDE - 1));

    for (int frame = 0; frame < 600; ++frame) {
        TRY(taut_cloth_step(cloth, NULL));
    }
    taut_strain strain;
    TRY(taut_cloth_strain(cloth, &strain));
    printf("tolerance %4.1f %%: %3u substeps%s%s, told %5.2f %%, hangs with %5.2f %%, %4.0f us a frame\n", 100.0 * tolerance,
           (unsigned)settings.substeps, settings.level_cycles > 0 ? ", one cycle" : "",
           settings.features & TAUT_FEATURE_TETHERS ? ", tethers" : "", 100.0 * settings.strain, 100.0 * strain.largest,
           1e-3 * settings.frame_ns);
    return settings.meets && strain.largest <= tolerance;
}

int main(void)
{
    int kept = 1;
    const float tolerances[] = {0.01f, 0.03f, 0.1f};
    for (int i = 0; i < 3; ++i) {
        kept = hang(tolerances[i]) && kept;
    }
    return kept ? 0 : 1;
}
