// From words to a cloth: the generator is asked for a fabric while a level is loaded, its field goes to a cloth and, as a
// baked field file, to the disk for the players' machines.
//
//     cargo build --release -p taut-ffi --features generator
//     cc -std=c11 -I include examples/c/generator.c target/release/libtaut.a -lpthread -ldl -lm -o generator
//     ./generator onnx/generator.onnx "heavy blue denim" denim.tautfield
#include <stdio.h>
#include <stdlib.h>

#include "taut_generator.h"

enum { ROWS = 32, COLUMNS = 32 };

static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char
    cloth_block[TAUT_CLOTH_BYTES(ROWS, COLUMNS, TAUT_FAMILY_ALL, TAUT_FEATURE_NONE, 2)];
static float field[4 * ROWS * COLUMNS];
static unsigned char file_bytes[64 * 1024];

static void fail(const char *what, taut_result result)
{
    char line[256];
    taut_generator_last_error(line, sizeof line);
    fprintf(stderr, "%s: %s: %s\n", what, taut_result_name(result), line);
    exit(2);
}

#define TRY(call)                        \
    do {                                 \
        taut_result result_ = (call);    \
        if (result_ != TAUT_OK) {        \
            fail(#call, result_);        \
        }                                \
    } while (0)

int main(int argc, char **argv)
{
    if (argc != 4) {
        fprintf(stderr, "usage: %s GENERATOR.onnx DESCRIPTION OUT\n", argv[0]);
        return 2;
    }
    taut_grid *grid = NULL;
    taut_grid_def grid_def = taut_grid_def_default();
    grid_def.rows = ROWS;
    grid_def.columns = COLUMNS;
    TRY(taut_grid_create(&grid_def, grid_block, sizeof grid_block, &grid));

    taut_generator *generator = NULL;
    TRY(taut_generator_load_file(argv[1], &generator));
    const uint32_t pins[] = {0, COLUMNS - 1};
    taut_fabric fabric;
    TRY(taut_generator_correct(generator, argv[2], 0, grid, pins, 2, field, sizeof field / sizeof field[0], &fabric));
    char skipped[256];
    if (taut_generator_last_error(skipped, sizeof skipped) > 0) {
        printf("%s\n", skipped);
    }
    size_t size = 0;
    TRY(taut_generator_bake(generator, argv[2], 0, grid, pins, 2, file_bytes, sizeof file_bytes, &size));
    taut_generator_free(generator);

    FILE *file = fopen(argv[3], "wb");
    if (!file || fwrite(file_bytes, 1, size, file) != size || fclose(file) != 0) {
        perror(argv[3]);
        return 2;
    }

    taut_cloth_def def = taut_cloth_def_default(grid);
    def.density_kg_m2 = fabric.density_kg_m2;
    def.max_pins = 2;
    def.inertia_radius_m = 0.3f;
    taut_cloth *cloth = NULL;
    TRY(taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, &cloth));
    TRY(taut_cloth_set_stiffness_field(cloth, 4, ROWS, COLUMNS, field));
    TRY(taut_cloth_pin(cloth, 0));
    TRY(taut_cloth_pin(cloth, COLUMNS - 1));
    for (int frame = 0; frame < 300; frame++) {
        TRY(taut_cloth_step(cloth, NULL));
    }
    taut_strain strain;
    TRY(taut_cloth_strain(cloth, &strain));
    printf("%s: %.3f kg/m^2, largest stretch %.2f %%\n", argv[2], fabric.density_kg_m2, 100.0 * strain.largest);
    return 0;
}
