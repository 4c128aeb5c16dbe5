// A cape on a character that walks, turns and stops: the upper edge is pinned to the shoulders, and all its pins are moved in
// every frame. What a renderer needs is read each frame: an interleaved vertex buffer with positions, normals and texture
// coordinates, 16-bit indices, a box to cull by.
//
// The character is 60 km away from the origin of the world, where a float is only good to 4 mm. The cape does not notice: inside
// it counts from its own origin, and the vertex buffer is seen from the camera.
//
//     cc -std=c11 -I include examples/c/cape.c target/release/libtaut.a -lm -o cape
//     ./cape
#include <math.h>
#include <stddef.h>
#include <stdio.h>

#include "taut.h"

enum {
    ROWS = 24,
    COLUMNS = 16,
    PARTICLES = ROWS * COLUMNS,
    TRIANGLES = TAUT_TRIANGLES(ROWS, COLUMNS),
    FRAMES = 8 * 60,
};

static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char
    cloth_block[TAUT_CLOTH_BYTES(ROWS, COLUMNS, TAUT_FAMILY_ALL, TAUT_FEATURE_NONE, COLUMNS)];

typedef struct {
    float position[3];
    float normal[3];
    float uv[2];
} vertex;

static vertex vertices[PARTICLES];
static uint16_t indices[TRIANGLES][3];

static const float width_m = 0.5f, height_m = 1.1f; // at the shoulders and down
static const double home_m[3] = {60000.0, 0.0, -20000.0};

// Leaves main with exit code 2 and says what failed.
#define TRY(call)                                                              \
    do {                                                                       \
        taut_result result_ = (call);                                          \
        if (result_ != TAUT_OK) {                                              \
            fprintf(stderr, "%s: %s (%s)\n", #call, taut_result_message(result_), taut_result_name(result_)); \
            return 2;                                                          \
        }                                                                      \
    } while (0)

// Where the middle of the shoulders is at a time, and which way the character looks: six seconds in a circle of 3 m at 1.5 m/s,
// with the ups and downs of steps, then he stands. y is up.
static void pose(double time_s, double shoulder_m[3], double *yaw)
{
    const double walked_s = time_s < 5.0 ? time_s : time_s < 7.0 ? time_s - (time_s - 5.0) * (time_s - 5.0) / 4.0 : 6.0;
    const double angle = 1.5 / 3.0 * walked_s;
    shoulder_m[0] = home_m[0] + 3.0 * sin(angle);
    shoulder_m[1] = home_m[1] + 1.5 + 0.03 * sin(2.0 * 3.14159265 * 2.0 * walked_s);
    shoulder_m[2] = home_m[2] + 3.0 - 3.0 * cos(angle);
    *yaw = angle;
}

// Where a pin is on the shoulders in the world: a straight line, 0.15 m behind the spine.
static void pin_at(double time_s, int column, double out_m[3])
{
    double middle[3], yaw;
    pose(time_s, middle, &yaw);
    const double across = ((double)column / (COLUMNS - 1) - 0.5) * width_m;
    // he looks along +x at yaw 0; +z is his right hand
    out_m[0] = middle[0] - 0.15 * cos(yaw) - across * sin(yaw);
    out_m[1] = middle[1];
    out_m[2] = middle[2] - 0.15 * sin(yaw) + across * cos(yaw);
}

int main(void)
{
    TRY(taut_check_version(TAUT_VERSION_ID));
    taut_grid_def grid_def = taut_grid_def_default();
    grid_def.rows = ROWS;
    grid_def.columns = COLUMNS;
    grid_def.width_m = width_m;
    grid_def.height_m = height_m;
    taut_grid *grid;
    TRY(taut_grid_create(&grid_def, grid_block, sizeof grid_block, &grid));

    // The cape hangs from its first pin along the shoulders. That is its origin for life.
    taut_cloth_def def = taut_cloth_def_default(grid);
    pin_at(0.0, 0, def.origin_m);
    def.u_axis[0] = 0.0f;
    def.u_axis[2] = 1.0f;
    def.density_kg_m2 = 0.35f;
    def.inertia_radius_m = 0.3f;
    def.max_pins = COLUMNS;
    taut_cloth *cloth;
    TRY(taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, &cloth));
    TRY(taut_cloth_set_stiffness_uniform(cloth, 2000.0f, 1000.0f, 300.0f, 8.0f));
    for (uint32_t column = 0; column < COLUMNS; ++column) {
        TRY(taut_cloth_pin(cloth, column));
    }

    // What never changes is read once.
    TRY(taut_grid_copy_triangles_u16(grid, indices, sizeof indices));
    TRY(taut_grid_copy_uvs_f32(grid, vertices[0].uv, sizeof vertices - offsetof(vertex, uv), sizeof(vertex)));

    float largest = 0.0f, farthest = 0.0f;
    double off_m = 0.0;
    for (int frame = 1; frame <= FRAMES; ++frame) {
        const double time_s = frame / 60.0;
        double world_m[COLUMNS][3];
        for (int column = 0; column < COLUMNS; ++column) {
            pin_at(time_s, column, world_m[column]);
            TRY(taut_cloth_pin_move(cloth, (uint32_t)column, world_m[column]));
        }
        uint32_t flags;
        TRY(taut_cloth_step(cloth, &flags));
        if (flags != 0) {
            fprintf(stderr, "frame %d was taken back\n", frame);
            return 1;
        }

        double camera_m[3], yaw;
        pose(time_s, camera_m, &yaw); // the camera sits on his shoulder
        TRY(taut_cloth_copy_positions_f32(cloth, camera_m, vertices[0].position, sizeof vertices, sizeof(vertex)));
        TRY(taut_cloth_copy_normals_f32(cloth, vertices[0].normal, sizeof vertices - offsetof(vertex, normal),
                                        sizeof(vertex)));

        // the pins are where the shoulders are, and the cape hangs on them and not elsewhere
        for (int column = 0; column < COLUMNS; ++column) {
            for (int axis = 0; axis < 3; ++axis) {
                const double is = (double)vertices[column].position[axis] + camera_m[axis];
                off_m = fmax(off_m, fabs(is - world_m[column][axis]));
            }
        }
        taut_bounds box;
        TRY(taut_cloth_bounds(cloth, &box));
        for (int axis = 0; axis < 3; ++axis) {
            farthest = fmaxf(farthest, (float)(box.high_m[axis] - camera_m[axis]));
            farthest = fmaxf(farthest, (float)(camera_m[axis] - box.low_m[axis]));
        }
        taut_strain strain;
        TRY(taut_cloth_strain(cloth, &strain));
        largest = fmaxf(largest, strain.largest);
    }
    printf("%d triangles, %d pins moved in each of %d frames\n", TRIANGLES, COLUMNS, FRAMES);
    printf("largest stretch %.1f %%, pins off by at most %.0e m\n", 100.0 * (double)largest, off_m);
    printf("never more than %.2f m from the shoulders\n", (double)farthest);

    // The first triangle looks to where its normals point.
    const float *a = vertices[indices[0][0]].position, *b = vertices[indices[0][1]].position,
                *c = vertices[indices[0][2]].position, *n = vertices[indices[0][0]].normal;
    const float p[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, q[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const float front = n[0] * (p[1] * q[2] - p[2] * q[1]) + n[1] * (p[2] * q[0] - p[0] * q[2]) +
                        n[2] * (p[0] * q[1] - p[1] * q[0]);
    return largest < 0.15f && off_m < 1e-5 && farthest < 1.5f && front > 0.0f ? 0 : 1;
}
