// Colliders and targets from C: a sheet whose first row is held by its skin falls over a ball that moves. Bad calls are
// answered with their codes.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "require.h"
#include "taut.h"

enum {
    ROWS = 17,
    COLUMNS = 23,
    COUNT = ROWS * COLUMNS,
    FEATURES = TAUT_FEATURE_COLLIDERS | TAUT_FEATURE_TARGETS,
    BYTES = TAUT_CLOTH_BYTES(ROWS, COLUMNS, TAUT_FAMILY_ALL, FEATURES, 4)
};

_Static_assert(sizeof(taut_pose) == 40, "no padding");
_Static_assert(sizeof(taut_collider_def) == 8 + 40 + 12 + 8 + 24 + 12 + 12 + 4, "no padding");

static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char cloth_block[BYTES];
static float skin[COUNT][6]; // position, normal
static float distance[COUNT];

int main(void)
{
    taut_grid_def g = taut_grid_def_default();
    g.rows = ROWS;
    g.columns = COLUMNS;
    taut_grid *grid;
    REQUIRE(taut_grid_create(&g, grid_block, sizeof grid_block, &grid) == TAUT_OK);

    // the macro for static storage is the query, for every set of features
    taut_cloth_def d = taut_cloth_def_default(grid);
    taut_memory memory;
    d.max_pins = 4;
    for (uint32_t features = 0; features < 2048; ++features) {
        d.features = features;
        REQUIRE(taut_cloth_memory(grid, &d, &memory) == TAUT_OK);
        REQUIRE(memory.size == TAUT_CLOTH_BYTES(ROWS, COLUMNS, TAUT_FAMILY_ALL, features, 4));
    }
    d.features = FEATURES;
    d.v_axis[1] = 0.0f;
    d.v_axis[2] = 1.0f;
    taut_cloth *cloth;
    REQUIRE(taut_cloth_create(grid, &d, cloth_block, sizeof cloth_block, &cloth) == TAUT_OK);
    REQUIRE(taut_cloth_set_stiffness_uniform(cloth, 1000.0f, 1000.0f, 300.0f, 10.0f) == TAUT_OK);

    uint32_t ball = 0, other = 0, count = 9;
    taut_collider_def c = taut_collider_def_default(TAUT_SHAPE_SPHERE);
    c.pose.position_m[0] = 0.5;
    c.pose.position_m[1] = -0.3;
    c.pose.position_m[2] = 0.5;
    c.radius_m[0] = 0.2f;
    REQUIRE(taut_cloth_collider_add(cloth, NULL, &ball) == TAUT_ERROR_NULL_POINTER);
    REQUIRE(taut_cloth_collider_add(cloth, &c, NULL) == TAUT_ERROR_NULL_POINTER);
    c.cookie ^= 1;
    REQUIRE(taut_cloth_collider_add(cloth, &c, &ball) == TAUT_ERROR_BAD_DEFINITION);
    c.cookie ^= 1;
    c.shape = 9;
    REQUIRE(taut_cloth_collider_add(cloth, &c, &ball) == TAUT_ERROR_OUT_OF_RANGE);
    c.shape = TAUT_SHAPE_SPHERE;
    c.radius_m[0] = NAN;
    REQUIRE(taut_cloth_collider_add(cloth, &c, &ball) == TAUT_ERROR_NOT_FINITE);
    c.radius_m[0] = 0.2f;
    c.friction = -1.0f;
    REQUIRE(taut_cloth_collider_add(cloth, &c, &ball) == TAUT_ERROR_NEGATIVE);
    c.friction = 0.3f;
    REQUIRE(ball == 0);
    REQUIRE(taut_cloth_collider_count(cloth, &count) == TAUT_OK && count == 0);
    REQUIRE(taut_cloth_collider_add(cloth, &c, &ball) == TAUT_OK && ball != 0);
    for (uint32_t shape = TAUT_SHAPE_CAPSULE; shape <= TAUT_SHAPE_BOX; ++shape) {
        taut_collider_def far = taut_collider_def_default(shape);
        far.pose.position_m[1] = -5.0;
        REQUIRE(taut_cloth_collider_add(cloth, &far, &other) == TAUT_OK && other != ball);
    }
    REQUIRE(taut_cloth_collider_remove(cloth, other) == TAUT_OK);
    REQUIRE(taut_cloth_collider_remove(cloth, other) == TAUT_ERROR_NO_SUCH_COLLIDER);
    REQUIRE(taut_cloth_collider_move(cloth, 0, &c.pose) == TAUT_ERROR_NO_SUCH_COLLIDER);
    REQUIRE(taut_cloth_collider_count(cloth, &count) == TAUT_OK && count == 3);
    while (taut_cloth_collider_add(cloth, &c, &other) == TAUT_OK) {
        ++count;
    }
    REQUIRE(count == TAUT_MAX_COLLIDERS);
    REQUIRE(taut_cloth_collider_add(cloth, &c, &other) == TAUT_ERROR_TOO_MANY_COLLIDERS);
    REQUIRE(taut_cloth_reset(cloth) == TAUT_OK);
    REQUIRE(taut_cloth_collider_set_pose(cloth, ball, &c.pose) == TAUT_ERROR_NO_SUCH_COLLIDER);
    REQUIRE(taut_cloth_collider_add(cloth, &c, &ball) == TAUT_OK);

    for (int i = 0; i < COUNT; ++i) {
        skin[i][0] = (float)(i % COLUMNS) / (float)(COLUMNS - 1);
        skin[i][2] = (float)(i / COLUMNS) / (float)(ROWS - 1);
        skin[i][4] = 1.0f;
        distance[i] = i < COLUMNS ? 0.0f : INFINITY;
    }
    const double base[3] = {0.0, 0.0, 0.0};
    const size_t stride = sizeof skin[0];
    REQUIRE(taut_cloth_set_target_limits(cloth, 17, distance, NULL, NULL) == TAUT_ERROR_SHAPE);
    REQUIRE(taut_cloth_set_target_limits(cloth, COUNT, NULL, NULL, NULL) == TAUT_ERROR_NULL_POINTER);
    REQUIRE(taut_cloth_set_target_limits(cloth, COUNT, distance, distance, NULL) == TAUT_ERROR_NOT_FINITE);
    REQUIRE(taut_cloth_set_target_limits(cloth, COUNT, distance, NULL, NULL) == TAUT_OK);
    REQUIRE(taut_cloth_move_targets(cloth, base, COUNT, skin, NULL, 11) == TAUT_ERROR_SHAPE);
    REQUIRE(taut_cloth_move_targets(cloth, base, 1, skin, NULL, stride) == TAUT_ERROR_SHAPE);
    REQUIRE(taut_cloth_move_targets(cloth, base, COUNT, NULL, NULL, stride) == TAUT_ERROR_NULL_POINTER);
    REQUIRE(taut_cloth_move_targets(cloth, NULL, COUNT, skin, NULL, stride) == TAUT_ERROR_NULL_POINTER);
    REQUIRE(taut_cloth_set_targets(cloth, base, COUNT, skin, &skin[0][3], stride) == TAUT_OK);

    taut_pose pose = c.pose;
    for (int frame = 0; frame < 60; ++frame) {
        uint32_t flags = 1;
        pose.position_m[2] += 0.001;
        REQUIRE(taut_cloth_collider_move(cloth, ball, &pose) == TAUT_OK);
        REQUIRE(taut_cloth_move_targets(cloth, base, COUNT, skin, NULL, stride) == TAUT_OK);
        REQUIRE(taut_cloth_step(cloth, &flags) == TAUT_OK && flags == 0);
        taut_position_view view;
        REQUIRE(taut_cloth_positions(cloth, &view) == TAUT_OK);
        for (size_t i = 0; i < COUNT; ++i) {
            size_t at = i / COLUMNS * view.row_stride + i % COLUMNS;
            double x = (double)view.x[at], y = (double)view.y[at], z = (double)view.z[at];
            if (i < COLUMNS) {
                REQUIRE(x == (double)skin[i][0] && y == 0.0 && z == 0.0);
                continue;
            }
            x -= 0.5;
            y += 0.3;
            z -= pose.position_m[2];
            REQUIRE(sqrt(x * x + y * y + z * z) > 0.205 - 1e-5);
        }
    }
    taut_pose now;
    REQUIRE(taut_cloth_collider_pose(cloth, ball, &now) == TAUT_OK);
    REQUIRE(fabs(now.position_m[2] - pose.position_m[2]) < 1e-6 && now.rotation[3] == 1.0f);
    REQUIRE(taut_cloth_collider_set_pose(cloth, ball, &pose) == TAUT_OK);
    puts("ok");
    return 0;
}
