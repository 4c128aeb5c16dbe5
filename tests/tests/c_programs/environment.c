// The run of examples/c/drape.c in the floating-point modes that an engine may have set: rounding upwards and, where there
// is such a thing, denormals flushed to zero. The modes are found as they were.
#include <fenv.h>
#include <stdio.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "require.h"
#include "taut.h"

static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char
    cloth_block[TAUT_CLOTH_BYTES(32, 32, TAUT_FAMILY_ALL, TAUT_FEATURE_NONE, 2)];
static unsigned char file_bytes[64 * 1024];

int main(int argc, char **argv)
{
    REQUIRE(argc == 2);
    FILE *file = fopen(argv[1], "rb");
    REQUIRE(file);
    size_t size = fread(file_bytes, 1, sizeof file_bytes, file);
    fclose(file);

    REQUIRE(fesetround(FE_UPWARD) == 0);
#if defined(__SSE__)
    const unsigned modes = 0xffc0; // all but the flags of what happened
    _mm_setcsr(_mm_getcsr() | 0x8040);
    const unsigned before = _mm_getcsr() & modes;
#endif

    taut_field field;
    REQUIRE(taut_field_info(file_bytes, size, &field) == TAUT_OK);
    taut_grid_def grid_def = taut_grid_def_default();
    taut_grid *grid;
    REQUIRE(taut_grid_create(&grid_def, grid_block, sizeof grid_block, &grid) == TAUT_OK);
    taut_cloth_def def = taut_cloth_def_default(grid);
    def.density_kg_m2 = field.fabric.density_kg_m2;
    def.inertia_radius_m = 0.3f;
    def.max_pins = 2;
    taut_cloth *cloth;
    REQUIRE(taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, &cloth) == TAUT_OK);
    REQUIRE(taut_cloth_load_stiffness(cloth, file_bytes, size, NULL) == TAUT_OK);
    REQUIRE(taut_cloth_pin(cloth, 0) == TAUT_OK);
    REQUIRE(taut_cloth_pin(cloth, 31) == TAUT_OK);
    for (int frame = 0; frame < 300; ++frame) {
        REQUIRE(taut_cloth_step(cloth, NULL) == TAUT_OK);
    }
    uint64_t hash;
    REQUIRE(taut_cloth_state_hash(cloth, &hash) == TAUT_OK);

    REQUIRE(fegetround() == FE_UPWARD);
#if defined(__SSE__)
    REQUIRE((_mm_getcsr() & modes) == before);
#endif
    fesetround(FE_TONEAREST);
    printf("state hash %016llx\n", (unsigned long long)hash);
    return 0;
}
