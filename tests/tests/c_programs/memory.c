// TAUT_CLOTH_BYTES is what taut_cloth_memory asks for: for all spring families, all sets of features that the library knows
// (asked of the library, so a new feature that the macro does not know fails here), many sizes and numbers of pins.
#include <stdio.h>

#include "taut.h"

static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
static const uint32_t sides[] = {2, 3, 15, 16, 17, 31, 32, 33, 48, 100, 255, 1023, 4095, 4096};
enum { SIDES = sizeof sides / sizeof sides[0] };

// The macro is a constant expression.
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char
    cloth_block[TAUT_CLOTH_BYTES(3, 17, TAUT_FAMILY_STRUCTURAL | TAUT_FAMILY_BEND, TAUT_FEATURE_PULL, 5)];

static taut_grid *make_grid(uint32_t rows, uint32_t columns, uint32_t families)
{
    taut_grid_def def = taut_grid_def_default();
    def.rows = rows;
    def.columns = columns;
    def.families = families;
    taut_grid *grid;
    return taut_grid_create(&def, grid_block, sizeof grid_block, &grid) == TAUT_OK ? grid : NULL;
}

// The features that the library knows: those that a definition may have alone.
static uint32_t known_features(void)
{
    taut_grid *grid = make_grid(8, 8, TAUT_FAMILY_ALL);
    uint32_t known = 0;
    for (int bit = 0; bit < 32; ++bit) {
        taut_cloth_def def = taut_cloth_def_default(grid);
        def.features = (uint32_t)1 << bit;
        taut_memory memory;
        if (taut_cloth_memory(grid, &def, &memory) == TAUT_OK) {
            known |= def.features;
        }
    }
    return known;
}

int main(void)
{
    const uint32_t known = known_features();
    if (!(known & TAUT_FEATURE_PULL)) {
        return 1;
    }
    long compared = 0;
    for (int m = 0; m < SIDES; ++m) {
        for (int n = 0; n < SIDES; ++n) {
            const uint32_t rows = sides[m], columns = sides[n], particles = rows * columns;
            const uint32_t pins[] = {0, 1, 2, 3, 4, 7, 16, 33, 255, particles - 1, particles};
            for (uint32_t families = TAUT_FAMILY_STRUCTURAL; families <= TAUT_FAMILY_ALL; families += 2) {
                taut_grid *grid = make_grid(rows, columns, families);
                // all sets of known features: (set - known) & known is the next one
                uint32_t features = 0;
                do {
                    for (size_t p = 0; p < sizeof pins / sizeof pins[0]; ++p) {
                        if (pins[p] > particles) {
                            continue;
                        }
                        taut_cloth_def def = taut_cloth_def_default(grid);
                        def.features = features;
                        def.max_pins = pins[p];
                        taut_memory memory;
                        const taut_result r = taut_cloth_memory(grid, &def, &memory);
                        const size_t bytes = TAUT_CLOTH_BYTES(rows, columns, families, features, pins[p]);
                        if (r != TAUT_OK || memory.size != bytes || memory.align != TAUT_CLOTH_ALIGN ||
                            bytes % TAUT_CLOTH_ALIGN != 0) { // so that blocks can stand side by side
                            printf("%u x %u, families %u, features %u, %u pins: %s, asked for %zu, macro %zu\n",
                                   (unsigned)rows, (unsigned)columns, (unsigned)families, (unsigned)features,
                                   (unsigned)pins[p], taut_result_name(r), memory.size, bytes);
                            return 1;
                        }
                        ++compared;
                    }
                    features = (features - known) & known;
                } while (features != 0);
            }
        }
    }

    // and a block of that size is enough
    taut_grid *grid = make_grid(3, 17, TAUT_FAMILY_STRUCTURAL | TAUT_FAMILY_BEND);
    taut_cloth_def def = taut_cloth_def_default(grid);
    def.features = TAUT_FEATURE_PULL;
    def.max_pins = 5;
    taut_cloth *cloth;
    if (taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, &cloth) != TAUT_OK ||
        taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block - 1, &cloth) != TAUT_ERROR_BLOCK_TOO_SMALL) {
        return 1;
    }
    printf("%ld sizes are those that the library asks for\n", compared);
    return 0;
}
