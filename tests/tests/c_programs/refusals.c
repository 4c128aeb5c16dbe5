// Every mistake that taut.h names is made here, and must be answered with its code. After each of them the cloth, the
// blocks and the outputs are compared with what they were: nothing may be half done.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "require.h"
#include "taut.h"

enum { SIDE = 8, BYTES = TAUT_CLOTH_BYTES(SIDE, SIDE, TAUT_FAMILY_ALL, TAUT_FEATURE_PULL, 4) };

static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char cloth_block[BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char before[BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char spare[BYTES + TAUT_CLOTH_ALIGN];
static unsigned char field[3][64 * 1024];
static size_t field_size[3];
static unsigned char bytes[64 * 1024];
static unsigned char snapshot[64 * 1024];

static taut_grid *grid;
static taut_cloth *cloth;
static int calls;

// The call answers with the code, and the cloth's block has not changed by a bit.
#define REFUSED(code, call)                                                                            \
    do {                                                                                               \
        memcpy(before, cloth_block, sizeof before);                                                    \
        taut_result result_ = (call);                                                                  \
        ++calls;                                                                                       \
        if (result_ != (code)) {                                                                       \
            printf("line %d: %s\n  is %s, not %s\n", __LINE__, #call, taut_result_name(result_), #code); \
            return 1;                                                                                  \
        }                                                                                              \
        if (memcmp(before, cloth_block, sizeof before) != 0) {                                         \
            printf("line %d: %s\n  changed the cloth\n", __LINE__, #call);                             \
            return 1;                                                                                  \
        }                                                                                              \
    } while (0)

#define DONE(call)                                                                                     \
    do {                                                                                               \
        taut_result result_ = (call);                                                                  \
        ++calls;                                                                                       \
        if (result_ != TAUT_OK) {                                                                      \
            printf("line %d: %s\n  is %s\n", __LINE__, #call, taut_result_name(result_));              \
            return 1;                                                                                  \
        }                                                                                              \
    } while (0)

// A pointer that is off by a byte.
static void *off(void *p)
{
    return (char *)p + 1;
}

static int versions(void)
{
    DONE(taut_check_version(TAUT_VERSION_ID));
    DONE(taut_check_version(TAUT_VERSION_ID ^ 1)); // another patch
    REFUSED(TAUT_ERROR_VERSION_MISMATCH, taut_check_version(TAUT_VERSION_ID + (1u << 24)));
    REFUSED(TAUT_ERROR_VERSION_MISMATCH, taut_check_version(TAUT_VERSION_ID + (1u << 16)));
    REFUSED(TAUT_ERROR_VERSION_MISMATCH, taut_check_version(0xffffffffu));
    return 0;
}

static int grids(void)
{
    static const struct {
        uint32_t rows, columns;
        float width_m, height_m;
        uint32_t families;
        taut_result answer;
    } bad[] = {
        {1, 1, 1, 1, 7, TAUT_ERROR_GRID_SIZE},
        {70000, 2, 1, 1, 7, TAUT_ERROR_GRID_SIZE},
        {2, 70000, 1, 1, 7, TAUT_ERROR_GRID_SIZE},
        {0, 8, 1, 1, 7, TAUT_ERROR_GRID_SIZE},
        {8, 4097, 1, 1, 7, TAUT_ERROR_GRID_SIZE},
        {0xffffffffu, 0xffffffffu, 1, 1, 7, TAUT_ERROR_GRID_SIZE},
        {8, 8, 0, 1, 7, TAUT_ERROR_SIDE_LENGTH},
        {8, 8, 1, -1, 7, TAUT_ERROR_SIDE_LENGTH},
        {8, 8, NAN, 1, 7, TAUT_ERROR_SIDE_LENGTH},
        {8, 8, 1, INFINITY, 7, TAUT_ERROR_SIDE_LENGTH},
        {8, 8, 1, 10001, 7, TAUT_ERROR_SIDE_LENGTH},
        {8, 8, 1, 1, 0, TAUT_ERROR_OUT_OF_RANGE},
        {8, 8, 1, 1, 6, TAUT_ERROR_OUT_OF_RANGE},
        {8, 8, 1, 1, 8 + 7, TAUT_ERROR_OUT_OF_RANGE},
    };
    unsigned char block_before[TAUT_GRID_BYTES];
    memcpy(block_before, grid_block, sizeof grid_block);
    taut_grid *out = grid;
    taut_memory memory = {7, 7};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        taut_grid_def def = taut_grid_def_default();
        def.rows = bad[i].rows;
        def.columns = bad[i].columns;
        def.width_m = bad[i].width_m;
        def.height_m = bad[i].height_m;
        def.families = bad[i].families;
        REFUSED(bad[i].answer, taut_grid_memory(&def, &memory));
        REFUSED(bad[i].answer, taut_grid_create(&def, grid_block, sizeof grid_block, &out));
    }

    taut_grid_def def = taut_grid_def_default();
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_grid_memory(NULL, &memory));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_grid_memory(&def, NULL));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_grid_memory(&def, off(bytes)));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_grid_create(NULL, grid_block, sizeof grid_block, &out));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_grid_create(off(&def), grid_block, sizeof grid_block, &out));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_grid_create(&def, NULL, sizeof grid_block, &out));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_grid_create(&def, grid_block, sizeof grid_block, NULL));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_grid_create(&def, grid_block + 4, sizeof grid_block, &out));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_grid_create(&def, grid_block, TAUT_GRID_BYTES - 1, &out));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_grid_create(&def, grid_block, 0, &out));
    def.size -= 4;
    REFUSED(TAUT_ERROR_BAD_DEFINITION, taut_grid_create(&def, grid_block, sizeof grid_block, &out));
    def = taut_grid_def_default();
    def.cookie ^= 1;
    REFUSED(TAUT_ERROR_BAD_DEFINITION, taut_grid_create(&def, grid_block, sizeof grid_block, &out));
    memset(&def, 0, sizeof def);
    REFUSED(TAUT_ERROR_BAD_DEFINITION, taut_grid_create(&def, grid_block, sizeof grid_block, &out));
    REQUIRE(memcmp(block_before, grid_block, sizeof grid_block) == 0);
    REQUIRE(out == grid && memory.size == 7 && memory.align == 7);

    taut_counts counts;
    uint64_t digest;
    DONE(taut_grid_counts(grid, &counts));
    REQUIRE(counts.rows == SIDE && counts.columns == SIDE && counts.particles == SIDE * SIDE);
    REQUIRE(counts.springs == 2 * 8 * 7 + 2 * 7 * 7 + 2 * 8 * 6);
    DONE(taut_grid_digest(grid, &digest));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_grid_counts(NULL, &counts));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_grid_counts(grid, NULL));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_grid_digest(NULL, &digest));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_grid_digest(grid, off(bytes)));
    memset(spare, 0, sizeof spare);
    REFUSED(TAUT_ERROR_BAD_HANDLE, taut_grid_counts((taut_grid *)(void *)spare, &counts));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_grid_counts((taut_grid *)(void *)(spare + 4), &counts));
    REFUSED(TAUT_ERROR_BAD_HANDLE, taut_grid_counts((taut_grid *)(void *)cloth, &counts));
    return 0;
}

// A definition with one wrong field, and the answer that all calls that take it give.
#define WRONG(code, change)                                                                            \
    do {                                                                                               \
        taut_cloth_def def = taut_cloth_def_default(grid);                                             \
        def.max_pins = 4;                                                                              \
        def.features = TAUT_FEATURE_PULL;                                                              \
        def.change;                                                                                    \
        taut_memory memory = {7, 7};                                                                   \
        taut_cloth *out = cloth;                                                                       \
        REFUSED(code, taut_cloth_memory(grid, &def, &memory));                                         \
        REFUSED(code, taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, &out));           \
        REQUIRE(out == cloth && memory.size == 7);                                                     \
    } while (0)

static int definitions(void)
{
    WRONG(TAUT_ERROR_BAD_DEFINITION, size = 0);
    WRONG(TAUT_ERROR_BAD_DEFINITION, size += 4);
    WRONG(TAUT_ERROR_BAD_DEFINITION, cookie = 0);
    WRONG(TAUT_ERROR_BAD_DEFINITION, cookie = taut_grid_def_default().cookie);
    WRONG(TAUT_ERROR_STEP_SIZE, rate_hz = 0);
    WRONG(TAUT_ERROR_STEP_SIZE, rate_hz = 10001);
    WRONG(TAUT_ERROR_STEP_SIZE, rate_hz = -60);
    WRONG(TAUT_ERROR_STEP_SIZE, substeps = 0);
    WRONG(TAUT_ERROR_STEP_SIZE, substeps = 1025);
    WRONG(TAUT_ERROR_NOT_FINITE, rate_hz = NAN);
    WRONG(TAUT_ERROR_NOT_FINITE, density_kg_m2 = INFINITY);
    WRONG(TAUT_ERROR_NOT_FINITE, gravity_m_s2[1] = NAN);
    WRONG(TAUT_ERROR_NOT_FINITE, origin_m[2] = (double)INFINITY);
    WRONG(TAUT_ERROR_NOT_FINITE, u_axis[0] = NAN);
    WRONG(TAUT_ERROR_NEGATIVE, damping_per_s = -1);
    WRONG(TAUT_ERROR_NEGATIVE, speed_limit = -1);
    WRONG(TAUT_ERROR_NEGATIVE, inertia_radius_m = -0.1f);
    WRONG(TAUT_ERROR_DAMPING, damping_per_s = 960);
    WRONG(TAUT_ERROR_OUT_OF_RANGE, density_kg_m2 = 0);
    WRONG(TAUT_ERROR_OUT_OF_RANGE, inertia_max = 0.5f);
    WRONG(TAUT_ERROR_OUT_OF_RANGE, gravity_m_s2[0] = 1e5f);
    WRONG(TAUT_ERROR_OUT_OF_RANGE, v_axis[1] = 0);
    WRONG(TAUT_ERROR_OUT_OF_RANGE, budget = 2);
    WRONG(TAUT_ERROR_OUT_OF_RANGE, budget = 0xffffffffu);
    WRONG(TAUT_ERROR_OUT_OF_RANGE, compression_limit = 2);
    WRONG(TAUT_ERROR_OUT_OF_RANGE, features = 2048);
    WRONG(TAUT_ERROR_OUT_OF_RANGE, speed_limit = 1e-7f);
    WRONG(TAUT_ERROR_OUT_OF_RANGE, level_cycles = 33);
    return 0;
}

static int blocks(void)
{
    taut_cloth_def def = taut_cloth_def_default(grid);
    REQUIRE(def.max_pins == SIDE * SIDE); // the default follows a small grid
    def.max_pins = 4;
    def.features = TAUT_FEATURE_PULL;
    taut_memory memory = {7, 7};
    DONE(taut_cloth_memory(grid, &def, &memory));
    REQUIRE(memory.size == BYTES && memory.align == TAUT_CLOTH_ALIGN);
    def.max_pins = 0xffffffffu; // all there are
    DONE(taut_cloth_memory(grid, &def, &memory));
    REQUIRE(memory.size == TAUT_CLOTH_BYTES(SIDE, SIDE, TAUT_FAMILY_ALL, TAUT_FEATURE_PULL, SIDE * SIDE));
    def.max_pins = 4;
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_memory(NULL, &def, &memory));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_memory(grid, NULL, &memory));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_memory(grid, &def, NULL));

    taut_cloth *out = cloth;
    memset(spare, 0xa5, sizeof spare);
    taut_grid *no_grid = (taut_grid *)(void *)spare;
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_create(NULL, &def, spare, BYTES, &out));
    REFUSED(TAUT_ERROR_BAD_HANDLE, taut_cloth_create(no_grid, &def, spare, BYTES, &out));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_create(grid, NULL, spare, BYTES, &out));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_create(grid, &def, NULL, BYTES, &out));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_create(grid, &def, spare, BYTES, NULL));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_create(grid, &def, spare, BYTES, off(bytes)));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_create(grid, off(&def), spare, BYTES, &out));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_create(grid, &def, spare + 1, BYTES, &out));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_create(grid, &def, spare + 32, BYTES, &out));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_cloth_create(grid, &def, spare, BYTES - 1, &out));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_cloth_create(grid, &def, spare, 0, &out));
    REQUIRE(out == cloth);
    for (size_t i = 0; i < sizeof spare; ++i) {
        REQUIRE(spare[i] == 0xa5); // a refused block is as it was
    }
    DONE(taut_cloth_create(grid, &def, spare, BYTES, &out)); // and its old content does not matter
    REQUIRE((void *)out == (void *)spare);
    REQUIRE(spare[BYTES] == 0xa5); // no byte behind the block was touched
    return 0;
}

static int handles(void)
{
    taut_cloth *wrong[] = {NULL, off(cloth), (taut_cloth *)(void *)spare};
    const taut_result answers[] = {TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE};
    memcpy(spare, cloth_block, BYTES); // a copy of the block elsewhere is no cloth
    const double world[3] = {0, 0, 0};
    const float local[3] = {0, 0, 0};
    uint64_t u64 = 7;
    size_t size = 7;
    uint32_t u32 = 7;
    double f64 = 7;
    taut_budget_report report;
    taut_strain strain;
    taut_bounds bounds;
    taut_position_view view;
    uint32_t flags[2] = {7, 7};
    taut_pose frame = {{0, 0, 0}, {0, 0, 0, 1}};
    float force[3] = {7, 7, 7};
    for (int i = 0; i < 3; ++i) {
        taut_cloth *c = wrong[i];
        taut_result a = answers[i];
        REFUSED(a, taut_cloth_reset(c));
        REFUSED(a, taut_cloth_set_stiffness_uniform(c, 1, 1, 1, 1));
        REFUSED(a, taut_cloth_set_stiffness_field(c, 1, 2, 2, local));
        REFUSED(a, taut_cloth_load_stiffness(c, field[0], field_size[0], NULL));
        REFUSED(a, taut_cloth_budget(c, &report));
        REFUSED(a, taut_cloth_predict_stretch(c, &report));
        REFUSED(a, taut_cloth_pin(c, 0));
        REFUSED(a, taut_cloth_pin_move(c, 0, world));
        REFUSED(a, taut_cloth_unpin(c, 0));
        REFUSED(a, taut_cloth_pin_count(c, &u32));
        REFUSED(a, taut_cloth_set_position(c, 0, local));
        REFUSED(a, taut_cloth_set_positions(c, 1, local));
        REFUSED(a, taut_cloth_set_velocity(c, 0, local));
        REFUSED(a, taut_cloth_add_force(c, 0, local));
        REFUSED(a, taut_cloth_set_gravity(c, local));
        REFUSED(a, taut_cloth_set_damping(c, 1));
        REFUSED(a, taut_cloth_set_rest_scale(c, 1, 1, 1));
        REFUSED(a, taut_cloth_set_mask(c, 1, bytes));
        REFUSED(a, taut_cloth_set_masses(c, 1, local));
        REFUSED(a, taut_cloth_set_frame(c, &frame, 0, 0));
        REFUSED(a, taut_cloth_teleport(c, &frame));
        REFUSED(a, taut_cloth_set_origin(c, world));
        REFUSED(a, taut_cloth_frame(c, &frame));
        REFUSED(a, taut_cloth_wake(c));
        REFUSED(a, taut_cloth_is_asleep(c, &u32));
        REFUSED(a, taut_cloth_pin_force(c, 0, force));
        REFUSED(a, taut_cloth_copy_pin_forces_f32(c, bytes, sizeof bytes, 12));
        REFUSED(a, taut_cloth_step(c, &u32));
        REFUSED(a, taut_cloth_step_many(c, 3, &u32));
        REFUSED(a, taut_cloth_step_index(c, &u64));
        REFUSED(a, taut_cloth_positions(c, &view));
        REFUSED(a, taut_cloth_copy_positions_f64(c, bytes, sizeof bytes, 24));
        REFUSED(a, taut_cloth_copy_positions_f32(c, world, bytes, sizeof bytes, 12));
        REFUSED(a, taut_cloth_copy_velocities_f32(c, bytes, sizeof bytes, 12));
        REFUSED(a, taut_cloth_copy_normals_f32(c, bytes, sizeof bytes, 12));
        REFUSED(a, taut_cloth_bounds(c, &bounds));
        taut_cloth *list[] = {cloth, c};
        REFUSED(a, taut_cloth_step_all(list, 2, flags)); // nor is the first one stepped
        REFUSED(a, taut_cloth_step_all(&list[1], 1, NULL));
        REFUSED(a, taut_cloth_strain(c, &strain));
        REFUSED(a, taut_cloth_kinetic_energy(c, &f64));
        REFUSED(a, taut_cloth_snapshot_size(c, &size));
        REFUSED(a, taut_cloth_snapshot_size_max(c, &size));
        REFUSED(a, taut_cloth_snapshot(c, bytes, sizeof bytes, &size));
        REFUSED(a, taut_cloth_restore(c, snapshot, sizeof snapshot));
        REFUSED(a, taut_cloth_state_hash(c, &u64));
    }
    REQUIRE(u64 == 7 && size == 7 && u32 == 7 && f64 == 7 && flags[0] == 7);
    return 0;
}
#include "refusals_meshes.h"
#include "refusals_plan.h"
static int arguments(void)
{
    const double nan_world[3] = {0, (double)NAN, 0};
    const double far_world[3] = {0, 0, 1.1e6};
    const double world[3] = {0, 0, 0};
    const float nan_local[3] = {NAN, 0, 0};
    const float far_local[3] = {0, -1.1e6f, 0};
    const float strong[3] = {0, 0, 2e9f};
    const float local[3] = {0, 0, 0};
    const uint32_t none = SIDE * SIDE;
    uint32_t flags = 7;

    // steps and forces
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_step(cloth, off(bytes)));
    DONE(taut_cloth_step_many(cloth, 0, &flags));
    REQUIRE(flags == 0);
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_step_index(cloth, NULL));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_add_force(cloth, 0, NULL));
    REFUSED(TAUT_ERROR_NO_SUCH_PARTICLE, taut_cloth_add_force(cloth, none, local));
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_cloth_add_force(cloth, 0, nan_local));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_add_force(cloth, 0, strong));

    // pins
    REFUSED(TAUT_ERROR_NO_SUCH_PARTICLE, taut_cloth_pin(cloth, none));
    REFUSED(TAUT_ERROR_NO_SUCH_PARTICLE, taut_cloth_pin(cloth, 0xffffffffu));
    REFUSED(TAUT_ERROR_TOO_MANY_PINS, taut_cloth_pin(cloth, 40)); // four there are
    REFUSED(TAUT_ERROR_NO_SUCH_PARTICLE, taut_cloth_unpin(cloth, none));
    REFUSED(TAUT_ERROR_NOT_PINNED, taut_cloth_unpin(cloth, 40));
    REFUSED(TAUT_ERROR_NOT_PINNED, taut_cloth_pin_move(cloth, 40, world));
    REFUSED(TAUT_ERROR_NO_SUCH_PARTICLE, taut_cloth_pin_move(cloth, none, world));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_pin_move(cloth, 0, NULL));
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_cloth_pin_move(cloth, 0, nan_world));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_pin_move(cloth, 0, far_world));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_pin_count(cloth, NULL));

    float force[3] = {7, 7, 7};
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_pin_force(cloth, 0, NULL));
    REFUSED(TAUT_ERROR_NO_SUCH_PARTICLE, taut_cloth_pin_force(cloth, none, force));
    REFUSED(TAUT_ERROR_NOT_PINNED, taut_cloth_pin_force(cloth, 40, force));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_copy_pin_forces_f32(cloth, NULL, 48, 12));
    REFUSED(TAUT_ERROR_SHAPE, taut_cloth_copy_pin_forces_f32(cloth, bytes, 48, 11));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_cloth_copy_pin_forces_f32(cloth, bytes, 47, 12));
    REQUIRE(force[0] == 7);

    // surroundings, masses, mask, frame
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_set_gravity(cloth, NULL));
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_cloth_set_gravity(cloth, nan_local));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_set_gravity(cloth, far_local));
    REFUSED(TAUT_ERROR_NEGATIVE, taut_cloth_set_damping(cloth, -1));
    REFUSED(TAUT_ERROR_DAMPING, taut_cloth_set_damping(cloth, 960));
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_cloth_set_rest_scale(cloth, 1, NAN, 1));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_set_rest_scale(cloth, 1, 1, 0.4f));
    static float kg[SIDE * SIDE];
    REFUSED(TAUT_ERROR_FEATURE_OFF, taut_cloth_set_masses(cloth, none, kg));
    REFUSED(TAUT_ERROR_SHAPE, taut_cloth_set_masses(cloth, none + 1, kg));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_set_masses(cloth, none, NULL));
    REFUSED(TAUT_ERROR_FEATURE_OFF, taut_cloth_set_mask(cloth, none, bytes));
    REFUSED(TAUT_ERROR_SHAPE, taut_cloth_set_mask(cloth, 1, bytes));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_set_mask(cloth, none, NULL));
    taut_pose frame = {{0, 0, 0}, {0, 0, 0, 0}};
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_frame(cloth, NULL));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_set_frame(cloth, NULL, 0, 0));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_teleport(cloth, off(bytes)));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_set_frame(cloth, &frame, 0, 0));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_teleport(cloth, &frame));
    frame.rotation[3] = 1;
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_set_frame(cloth, &frame, 0, 1.5f));
    frame.position_m[1] = (double)NAN;
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_cloth_set_frame(cloth, &frame, 0, 0));
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_cloth_set_origin(cloth, nan_world));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_set_origin(cloth, NULL));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_is_asleep(cloth, NULL));

    // positions and velocities
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_set_position(cloth, 0, NULL));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_set_position(cloth, 0, off(bytes)));
    REFUSED(TAUT_ERROR_NO_SUCH_PARTICLE, taut_cloth_set_position(cloth, none, local));
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_cloth_set_position(cloth, 0, nan_local));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_set_position(cloth, 0, far_local));
    REFUSED(TAUT_ERROR_NO_SUCH_PARTICLE, taut_cloth_set_velocity(cloth, none, local));
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_cloth_set_velocity(cloth, 0, nan_local));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_set_velocity(cloth, 0, far_local));
    static float all[SIDE * SIDE][3];
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_set_positions(cloth, none, NULL));
    REFUSED(TAUT_ERROR_SHAPE, taut_cloth_set_positions(cloth, none - 1, all[0]));
    all[SIDE * SIDE - 1][2] = NAN; // the last one: those before it must stay too
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_cloth_set_positions(cloth, none, all[0]));
    all[SIDE * SIDE - 1][2] = 1.000001e6f;
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_set_positions(cloth, none, all[0]));

    // copies
    memset(bytes, 0xa5, sizeof bytes);
    const size_t need32 = (none - 1) * 20 + 12, need64 = (none - 1) * 30 + 24;
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_copy_positions_f64(cloth, NULL, need64, 30));
    REFUSED(TAUT_ERROR_SHAPE, taut_cloth_copy_positions_f64(cloth, bytes, sizeof bytes, 23));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_cloth_copy_positions_f64(cloth, bytes, need64 - 1, 30));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_copy_positions_f32(cloth, NULL, bytes, need32, 20));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_copy_positions_f32(cloth, world, NULL, need32, 20));
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_cloth_copy_positions_f32(cloth, nan_world, bytes, need32, 20));
    REFUSED(TAUT_ERROR_SHAPE, taut_cloth_copy_positions_f32(cloth, world, bytes, need32, 11));
    REFUSED(TAUT_ERROR_SHAPE, taut_cloth_copy_positions_f32(cloth, world, bytes, need32, 0));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_cloth_copy_positions_f32(cloth, world, bytes, need32 - 1, 20));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_cloth_copy_positions_f32(cloth, world, bytes, need32, (size_t)-1));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_copy_positions_f32(cloth, world, bytes, (size_t)-1, 20));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_cloth_copy_velocities_f32(cloth, bytes, need32 - 1, 20));
    for (size_t i = 0; i < sizeof bytes; ++i) {
        REQUIRE(bytes[i] == 0xa5);
    }
    DONE(taut_cloth_copy_positions_f32(cloth, world, bytes, need32, 20));
    taut_position_view view;
    DONE(taut_cloth_positions(cloth, &view));
    for (size_t i = 0; i < none; ++i) {
        float xyz[3];
        memcpy(xyz, bytes + 20 * i, sizeof xyz);
        const size_t at = i / SIDE * view.row_stride + i % SIDE;
        REQUIRE(xyz[0] == view.x[at] && xyz[1] == view.y[at] && xyz[2] == view.z[at]);
        REQUIRE(bytes[20 * i + 12] == 0xa5); // the bytes between belong to somebody else
    }
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_positions(cloth, NULL));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_strain(cloth, NULL));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_kinetic_energy(cloth, NULL));
    return 0;
}

static int stiffness(void)
{
    static float k[4 * 3 * 3];
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_cloth_set_stiffness_uniform(cloth, 1, NAN, 1, 1));
    REFUSED(TAUT_ERROR_NEGATIVE, taut_cloth_set_stiffness_uniform(cloth, 1, 1, 1, -1));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_set_stiffness_field(cloth, 4, 3, 3, NULL));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_set_stiffness_field(cloth, 4, 3, 3, off(k)));
    REFUSED(TAUT_ERROR_SHAPE, taut_cloth_set_stiffness_field(cloth, 3, 3, 3, k));
    REFUSED(TAUT_ERROR_SHAPE, taut_cloth_set_stiffness_field(cloth, 0, 3, 3, k));
    REFUSED(TAUT_ERROR_GRID_SIZE, taut_cloth_set_stiffness_field(cloth, 4, 1, 1, k));
    REFUSED(TAUT_ERROR_GRID_SIZE, taut_cloth_set_stiffness_field(cloth, 4, 70000, 2, k));
    REFUSED(TAUT_ERROR_GRID_SIZE, taut_cloth_set_stiffness_field(cloth, 1, 0xffffffffu, 0xffffffffu, k));
    k[35] = NAN;
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_cloth_set_stiffness_field(cloth, 4, 3, 3, k));
    k[35] = -1;
    REFUSED(TAUT_ERROR_NEGATIVE, taut_cloth_set_stiffness_field(cloth, 4, 3, 3, k));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_budget(cloth, NULL));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_predict_stretch(cloth, NULL));

    // files: each mistake is found by both calls, and the fabric is not written
    taut_field info;
    taut_fabric fabric;
    memset(&info, 0x5a, sizeof info);
    memset(&fabric, 0x5a, sizeof fabric);
#define FILE_REFUSED(code, data, size)                                                                 \
    do {                                                                                               \
        REFUSED(code, taut_field_info(data, size, &info));                                             \
        REFUSED(code, taut_cloth_load_stiffness(cloth, data, size, &fabric));                          \
        REQUIRE(info.rows == 0x5a5a5a5au && info.reserved == 0x5a5a5a5au);                             \
        REQUIRE(memcmp(&fabric, &info.fabric, sizeof fabric) == 0);                                    \
    } while (0)
    FILE_REFUSED(TAUT_ERROR_NULL_POINTER, NULL, 100);
    FILE_REFUSED(TAUT_ERROR_TRUNCATED, field[0], 0);
    FILE_REFUSED(TAUT_ERROR_TRUNCATED, field[0], 40);
    FILE_REFUSED(TAUT_ERROR_TRUNCATED, field[0], field_size[0] - 1);
    FILE_REFUSED(TAUT_ERROR_OUT_OF_RANGE, field[0], (size_t)-1);
    FILE_REFUSED(TAUT_ERROR_NOT_FINITE, field[1], field_size[1]);
    FILE_REFUSED(TAUT_ERROR_NEGATIVE, field[2], field_size[2]);
    memcpy(bytes, field[0], field_size[0]);
    bytes[5000] ^= 1;
    FILE_REFUSED(TAUT_ERROR_CHECKSUM, bytes, field_size[0]);
    bytes[5000] ^= 1;
    bytes[8] = 2;
    FILE_REFUSED(TAUT_ERROR_UNSUPPORTED_VERSION, bytes, field_size[0]);
    bytes[8] = 1;
    bytes[12] ^= 1;
    FILE_REFUSED(TAUT_ERROR_SHAPE, bytes, field_size[0]);
    bytes[12] ^= 1;
    bytes[18] = 1; // 65568 rows
    FILE_REFUSED(TAUT_ERROR_GRID_SIZE, bytes, field_size[0]);
    bytes[18] = 0;
    FILE_REFUSED(TAUT_ERROR_WRONG_KIND, snapshot, sizeof snapshot);
    FILE_REFUSED(TAUT_ERROR_WRONG_KIND, "\x08\x08\x12\x04taut: this is an onnx file, or looks like one", 50);
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_field_info(field[0], field_size[0], NULL));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_load_stiffness(cloth, field[0], field_size[0], off(k)));
    DONE(taut_field_info(bytes, field_size[0], &info));
    REQUIRE(info.rows == 32 && info.columns == 32 && info.seed == 0 && info.reserved == 0);
    REQUIRE(info.fabric.density_kg_m2 == 0.324f && info.fabric.limit_diagonal == 0.06f);
    return 0;
}

static int snapshots(void)
{
    size_t size = 0, most = 0, written = 7;
    DONE(taut_cloth_snapshot_size(cloth, &size));
    DONE(taut_cloth_snapshot_size_max(cloth, &most));
    REQUIRE(size <= most && most <= sizeof snapshot);
    memset(bytes, 0xa5, sizeof bytes);
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_snapshot_size(cloth, NULL));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_snapshot_size_max(cloth, NULL));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_snapshot(cloth, NULL, size, &written));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_cloth_snapshot(cloth, bytes, size - 1, &written));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_cloth_snapshot(cloth, bytes, 0, &written));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_snapshot(cloth, bytes, size, off(snapshot)));
    for (size_t i = 0; i < sizeof bytes; ++i) {
        REQUIRE(bytes[i] == 0xa5);
    }
    REQUIRE(written == 7);
    DONE(taut_cloth_snapshot(cloth, bytes + 1, size, &written));
    REQUIRE(written == size && bytes[0] == 0xa5 && bytes[size + 1] == 0xa5);
    DONE(taut_cloth_snapshot(cloth, snapshot, sizeof snapshot, NULL));
    REQUIRE(memcmp(bytes + 1, snapshot, size) == 0);

    DONE(taut_cloth_step(cloth, NULL)); // so that a snapshot that is restored by mistake is seen
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_restore(cloth, NULL, size));
    REFUSED(TAUT_ERROR_TRUNCATED, taut_cloth_restore(cloth, snapshot, 0));
    REFUSED(TAUT_ERROR_TRUNCATED, taut_cloth_restore(cloth, snapshot, 30));
    REFUSED(TAUT_ERROR_TRUNCATED, taut_cloth_restore(cloth, snapshot, size - 1));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_restore(cloth, snapshot, (size_t)-1));
    REFUSED(TAUT_ERROR_WRONG_KIND, taut_cloth_restore(cloth, field[0], field_size[0]));
    for (size_t i = 0; i < size; ++i) { // every byte counts
        memcpy(bytes, snapshot, size);
        bytes[i] ^= 0x40;
        memcpy(before, cloth_block, sizeof before);
        const taut_result r = taut_cloth_restore(cloth, bytes, size);
        REQUIRE(r < 0 && r != TAUT_ERROR_NULL_POINTER && r != TAUT_ERROR_BAD_HANDLE);
        REQUIRE(memcmp(before, cloth_block, sizeof before) == 0);
    }
    memcpy(bytes, snapshot, size);
    bytes[8] = 1; // an older one
    REFUSED(TAUT_ERROR_UNSUPPORTED_VERSION, taut_cloth_restore(cloth, bytes, size));
    memcpy(bytes, snapshot, size);
    bytes[100] ^= 1;
    REFUSED(TAUT_ERROR_CHECKSUM, taut_cloth_restore(cloth, bytes, size));
    memcpy(bytes, snapshot, size);
    bytes[32] += 1; // one pin more
    REFUSED(TAUT_ERROR_SHAPE, taut_cloth_restore(cloth, bytes, size));

    // a snapshot of a cloth of another definition
    taut_cloth_def def = taut_cloth_def_default(grid);
    def.max_pins = 4;
    def.features = TAUT_FEATURE_PULL;
    def.damping_per_s = 3;
    taut_cloth *other;
    DONE(taut_cloth_create(grid, &def, spare, BYTES, &other));
    DONE(taut_cloth_snapshot(other, bytes, sizeof bytes, &written));
    REFUSED(TAUT_ERROR_FOREIGN, taut_cloth_restore(cloth, bytes, written));

    uint64_t hash;
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_state_hash(cloth, NULL));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_state_hash(cloth, off(bytes)));
    DONE(taut_cloth_restore(cloth, snapshot, size));
    DONE(taut_cloth_state_hash(cloth, &hash));
    return 0;
}

#include "refusals_frames.h"

int main(int argc, char **argv)
{
    REQUIRE(argc == 4);
    for (int i = 0; i < 3; ++i) {
        FILE *file = fopen(argv[i + 1], "rb");
        REQUIRE(file);
        field_size[i] = fread(field[i], 1, sizeof field[i], file);
        fclose(file);
    }
    taut_grid_def grid_def = taut_grid_def_default();
    grid_def.rows = SIDE;
    grid_def.columns = SIDE;
    DONE(taut_grid_create(&grid_def, grid_block, sizeof grid_block, &grid));

    // without what it needs a cloth does not step, and what it was not made for it does not do
    taut_cloth_def def = taut_cloth_def_default(grid);
    def.max_pins = 4;
    uint32_t flags = 7;
    taut_budget_report report;
    const float force[3] = {0, 1, 0};
    DONE(taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, &cloth));
    REFUSED(TAUT_ERROR_NO_STIFFNESS, taut_cloth_step(cloth, &flags));
    REFUSED(TAUT_ERROR_NO_STIFFNESS, taut_cloth_step_many(cloth, 2, &flags));
    REFUSED(TAUT_ERROR_NO_STIFFNESS, taut_cloth_budget(cloth, &report));
    REFUSED(TAUT_ERROR_FEATURE_OFF, taut_cloth_add_force(cloth, 0, force));
    REQUIRE(flags == 7);

    // a cloth in the middle of its life, which all the mistakes must leave alone
    def.features = TAUT_FEATURE_PULL;
    def.inertia_radius_m = 0.3f;
    DONE(taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, &cloth));
    DONE(taut_cloth_load_stiffness(cloth, field[0], field_size[0], NULL));
    DONE(taut_cloth_pin(cloth, 0));
    DONE(taut_cloth_pin(cloth, SIDE - 1));
    DONE(taut_cloth_pin(cloth, 20));
    DONE(taut_cloth_pin(cloth, 21));
    DONE(taut_cloth_pin(cloth, 21)); // pinned already
    DONE(taut_cloth_step_many(cloth, 5, &flags));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_width_supported(5, &flags));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_set_width(cloth, 5));
    for (uint32_t width = TAUT_WIDTH_SCALAR; width <= TAUT_WIDTH_NEON; ++width) {
        uint32_t has;
        DONE(taut_width_supported(width, &has));
        REQUIRE(taut_cloth_set_width(cloth, width) == (has ? TAUT_OK : TAUT_ERROR_UNSUPPORTED_WIDTH));
    }
    DONE(taut_cloth_add_force(cloth, 30, force));

    if (versions() || grids() || definitions() || blocks() || handles() || meshes() || arguments() || stiffness() || snapshots() ||
        plans()) {
        return 1;
    }

    if (taken_back()) {
        return 1;
    }
    uint64_t index;
    DONE(taut_cloth_step_index(cloth, &index));
    REQUIRE(index == 5);
    DONE(taut_cloth_reset(cloth));
    DONE(taut_cloth_step_index(cloth, &index));
    REQUIRE(index == 0);

    printf("%d calls were answered as they should be\n", calls);
    return 0;
}
