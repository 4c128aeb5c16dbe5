// A cloth of the fabric in a baked field file hangs from two corners for five seconds: the whole of taut that a game
// needs, in static memory. Afterwards the second half is rewound and stepped again, which must give the same bits.
//
//     cc -std=c11 -I include examples/c/drape.c target/release/libtaut.a -o drape
//     ./drape examples/data/denim.tautfield
#include <stdio.h>

#include "taut.h"

enum {
    ROWS = 32,
    COLUMNS = 32,
    MAX_PINS = 2,
    FRAMES = 5 * 60, // five seconds at 60 Hz
};

// taut never allocates. All memory is ours; here it is static, and its size is known at compile time.
static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char
    cloth_block[TAUT_CLOTH_BYTES(ROWS, COLUMNS, TAUT_FAMILY_ALL, TAUT_FEATURE_NONE, MAX_PINS)];
static unsigned char field_file[64 * 1024];
static unsigned char snapshot[64 * 1024];

// Leaves main with exit code 2 and says what failed.
#define TRY(call)                                                              \
    do {                                                                       \
        taut_result result_ = (call);                                          \
        if (result_ != TAUT_OK) {                                              \
            fprintf(stderr, "%s: %s (%s)\n", #call, taut_result_message(result_), taut_result_name(result_)); \
            return 2;                                                          \
        }                                                                      \
    } while (0)

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: %s FIELD\n", argv[0]);
        return 2;
    }
    FILE *file = fopen(argv[1], "rb");
    if (!file) {
        perror(argv[1]);
        return 2;
    }
    size_t field_size = fread(field_file, 1, sizeof field_file, file);
    fclose(file);

    // The header that we compiled with must fit the library that we found.
    TRY(taut_check_version(TAUT_VERSION_ID));

    // The file tells how heavy the fabric is, which we need before the cloth is made.
    taut_field field;
    TRY(taut_field_info(field_file, field_size, &field));

    // The grid: which particles there are and how springs join them. Many cloths may share one.
    taut_grid_def grid_def = taut_grid_def_default();
    grid_def.rows = ROWS;
    grid_def.columns = COLUMNS;
    grid_def.width_m = 1.0f;
    grid_def.height_m = 1.0f;
    taut_grid *grid;
    TRY(taut_grid_create(&grid_def, grid_block, sizeof grid_block, &grid));

    // The cloth: how it is stepped, how heavy it is, where it starts. Everything else keeps its default.
    taut_cloth_def def = taut_cloth_def_default(grid);
    def.rate_hz = 60.0f;
    def.substeps = 16;
    def.density_kg_m2 = field.fabric.density_kg_m2;
    def.inertia_radius_m = 0.3f; // stiff near the pins, at no cost in the step
    def.max_pins = MAX_PINS;
    taut_cloth *cloth;
    TRY(taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, &cloth));

    // The stiffness of the fabric, then the two top corners.
    TRY(taut_cloth_load_stiffness(cloth, field_file, field_size, NULL));
    TRY(taut_cloth_pin(cloth, 0));
    TRY(taut_cloth_pin(cloth, COLUMNS - 1));

    // No step carries any stiffness. What it cannot carry was cut, and this is how much.
    taut_budget_report budget;
    TRY(taut_cloth_budget(cloth, &budget));
    printf("stiffness cut by %.1f %%\n", 100.0 * budget.cut_fraction);

    // Half of the way, a snapshot, the other half.
    TRY(taut_cloth_step_many(cloth, FRAMES / 2, NULL));
    size_t snapshot_size;
    TRY(taut_cloth_snapshot(cloth, snapshot, sizeof snapshot, &snapshot_size));
    for (int frame = FRAMES / 2; frame < FRAMES; ++frame) {
        uint32_t flags;
        TRY(taut_cloth_step(cloth, &flags)); // one frame: this is the call in the game loop
        if (flags & TAUT_STEP_NON_FINITE) {
            fprintf(stderr, "frame %d was taken back\n", frame);
            return 1;
        }
    }

    // What a renderer reads: all positions, as seen from a point near the camera.
    static float vertices[ROWS * COLUMNS][3];
    const double camera_m[3] = {0.0, 0.0, 0.0};
    TRY(taut_cloth_copy_positions_f32(cloth, camera_m, vertices, sizeof vertices, sizeof vertices[0]));
    printf("lower left corner at %.3f %.3f %.3f m\n", vertices[(ROWS - 1) * COLUMNS][0],
           vertices[(ROWS - 1) * COLUMNS][1], vertices[(ROWS - 1) * COLUMNS][2]);

    taut_strain strain;
    uint64_t hash, again;
    TRY(taut_cloth_strain(cloth, &strain));
    TRY(taut_cloth_state_hash(cloth, &hash));
    printf("largest stretch %.2f %%\n", 100.0 * strain.largest);
    printf("state hash %016llx\n", (unsigned long long)hash);

    // Rewind and do the second half again: the same bits, or rollback netcode would drift.
    TRY(taut_cloth_restore(cloth, snapshot, snapshot_size));
    TRY(taut_cloth_step_many(cloth, FRAMES - FRAMES / 2, NULL));
    TRY(taut_cloth_state_hash(cloth, &again));
    if (again != hash) {
        fprintf(stderr, "after the rewind the hash is %016llx\n", (unsigned long long)again);
        return 1;
    }
    return 0;
}
