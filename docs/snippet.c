#include "taut.h"

static _Alignas(TAUT_GRID_ALIGN) char grid_block[TAUT_GRID_BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) char cloth_block[TAUT_CLOTH_BYTES(32, 32, TAUT_FAMILY_ALL, TAUT_FEATURE_NONE, 256)];

// A cloth of the fabric in a baked field file, hanging from its two top corners.
taut_result make_cloth(const void *field_file, size_t size, taut_cloth **out)
{
    taut_field field;
    taut_grid *grid;
    taut_result r = taut_field_info(field_file, size, &field);
    if (r) return r;

    taut_grid_def grid_def = taut_grid_def_default(); // 32 x 32 particles, 1 m x 1 m
    if ((r = taut_grid_create(&grid_def, grid_block, sizeof grid_block, &grid))) return r;

    taut_cloth_def def = taut_cloth_def_default(grid); // 60 Hz x 16 substeps
    def.density_kg_m2 = field.fabric.density_kg_m2;
    def.inertia_radius_m = 0.3f; // stiff at the pins, at no cost in the step
    if ((r = taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, out))) return r;
    if ((r = taut_cloth_load_stiffness(*out, field_file, size, NULL))) return r;
    if ((r = taut_cloth_pin(*out, 0))) return r;
    return taut_cloth_pin(*out, 31);
}
// In the game loop: taut_cloth_step(cloth, &flags), then taut_cloth_copy_positions_f32 into a vertex buffer.
