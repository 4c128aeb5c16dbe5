// A cape on a character that walks, turns and stops: the upper edge is pinned to the shoulders, and all its pins are moved in
// every frame. His body and his legs are capsules that move with him and keep the cape outside. What a renderer needs is read
// each frame: an interleaved vertex buffer with positions, normals and texture coordinates, 16-bit indices, a box to cull by.
//
// The character is 60 km away from the origin of the world, where a float is only good to 4 mm. The cape does not notice: inside
// it counts from its own origin, and the vertex buffer is seen from the camera.
//
//     cc -std=c11 -I include examples/c/cape.c target/release/libtaut.a -lm -o cape
//     ./cape
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "taut.h"

enum {
    ROWS = 24,
    COLUMNS = 16,
    PARTICLES = ROWS * COLUMNS,
    TRIANGLES = TAUT_TRIANGLES(ROWS, COLUMNS),
    FRAMES = 8 * 60,
    CAPSULES = 3, // the body, the left leg, the right one
};

static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char
    cloth_block[TAUT_CLOTH_BYTES(ROWS, COLUMNS, TAUT_FAMILY_ALL, TAUT_FEATURE_COLLIDERS, COLUMNS)];

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

// How fast he walks at a time, as a share.
static double walking(double time_s)
{
    return time_s < 5.0 ? 1.0 : time_s < 7.0 ? (7.0 - time_s) / 2.0 : 0.0;
}

// The shape of a capsule in its own frame, where he looks along +x: a body of two balls from the hips to below the neck, or a
// leg that hangs from the hip.
static taut_collider_def shape(int capsule)
{
    taut_collider_def def = taut_collider_def_default(TAUT_SHAPE_CAPSULE);
    const bool leg = capsule > 0;
    def.ends_m[0][1] = leg ? 0.0f : -0.5f;
    def.ends_m[1][1] = leg ? -0.8f : -0.12f;
    def.radius_m[0] = leg ? 0.11f : 0.14f;
    def.radius_m[1] = leg ? 0.07f : 0.13f;
    def.friction = 0.2f;
    def.thickness_m = 0.01f;
    return def;
}

// Where a capsule is at a time. Body and legs turn with the character; the legs swing by up to 0.5 rad about the axis
// through the hips, one ahead and one behind.
static taut_pose limb(double time_s, int capsule)
{
    double shoulder[3], yaw;
    pose(time_s, shoulder, &yaw);
    taut_pose at = {{shoulder[0], shoulder[1], shoulder[2]}, {0.0f, 0.0f, 0.0f, 1.0f}};
    double swing = 0.0;
    if (capsule > 0) {
        const double side = capsule == 1 ? -0.09 : 0.09;
        at.position_m[0] -= side * sin(yaw);
        at.position_m[1] -= 0.6;
        at.position_m[2] += side * cos(yaw);
        swing = (capsule == 1 ? 0.5 : -0.5) * walking(time_s) * sin(2.0 * 3.14159265 * time_s);
    }
    // first the swing about z, his right hand, then the turn about y: he looks along (cos yaw, 0, sin yaw)
    const double y = sin(-0.5 * yaw), w = cos(0.5 * yaw), z = sin(0.5 * swing), c = cos(0.5 * swing);
    at.rotation[0] = (float)(y * z);
    at.rotation[1] = (float)(y * c);
    at.rotation[2] = (float)(w * z);
    at.rotation[3] = (float)(w * c);
    return at;
}

// v turned by a quaternion.
static void turned(const float q[4], const float v[3], double out[3])
{
    double t[3];
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        t[i] = 2.0 * ((double)q[j] * (double)v[k] - (double)q[k] * (double)v[j]);
    }
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = (double)v[i] + (double)q[3] * t[i] + (double)q[j] * t[k] - (double)q[k] * t[j];
    }
}

// How far a point is outside of a capsule, below 0 inside: that of the ball, somewhere between the ends, that is nearest.
static double outside(const taut_collider_def *def, const taut_pose *at, const double point_m[3])
{
    double least = INFINITY;
    for (int i = 0; i <= 64; ++i) {
        const float share = (float)i / 64.0f;
        float middle[3];
        double there[3], squared = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            middle[axis] = def->ends_m[0][axis] + share * (def->ends_m[1][axis] - def->ends_m[0][axis]);
        }
        turned(at->rotation, middle, there);
        for (int axis = 0; axis < 3; ++axis) {
            const double way = point_m[axis] - at->position_m[axis] - there[axis];
            squared += way * way;
        }
        const double radius = (double)(def->radius_m[0] + share * (def->radius_m[1] - def->radius_m[0]));
        least = fmin(least, sqrt(squared) - radius);
    }
    return least;
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
    def.features = TAUT_FEATURE_COLLIDERS;
    taut_cloth *cloth;
    TRY(taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, &cloth));
    TRY(taut_cloth_set_stiffness_uniform(cloth, 2000.0f, 1000.0f, 300.0f, 8.0f));
    for (uint32_t column = 0; column < COLUMNS; ++column) {
        TRY(taut_cloth_pin(cloth, column));
    }

    taut_collider_def shapes[CAPSULES];
    uint32_t ids[CAPSULES];
    for (int i = 0; i < CAPSULES; ++i) {
        shapes[i] = shape(i);
        shapes[i].pose = limb(0.0, i);
        TRY(taut_cloth_collider_add(cloth, &shapes[i], &ids[i]));
    }

    // What never changes is read once.
    TRY(taut_grid_copy_triangles_u16(grid, indices, sizeof indices));
    TRY(taut_grid_copy_uvs_f32(grid, vertices[0].uv, sizeof vertices - offsetof(vertex, uv), sizeof(vertex)));

    float largest = 0.0f, farthest = 0.0f;
    double off_m = 0.0, deepest_m = 0.0;
    int touches = 0;
    for (int frame = 1; frame <= FRAMES; ++frame) {
        const double time_s = frame / 60.0;
        double world_m[COLUMNS][3];
        for (int column = 0; column < COLUMNS; ++column) {
            pin_at(time_s, column, world_m[column]);
            TRY(taut_cloth_pin_move(cloth, (uint32_t)column, world_m[column]));
        }
        taut_pose limbs[CAPSULES];
        for (int i = 0; i < CAPSULES; ++i) {
            limbs[i] = limb(time_s, i);
            TRY(taut_cloth_collider_move(cloth, ids[i], &limbs[i]));
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
        // nothing of the cape is inside of him
        for (int i = 0; i < PARTICLES * CAPSULES; ++i) {
            const float *seen = vertices[i % PARTICLES].position;
            double point_m[3];
            for (int axis = 0; axis < 3; ++axis) {
                point_m[axis] = (double)seen[axis] + camera_m[axis];
            }
            const double gap = outside(&shapes[i / PARTICLES], &limbs[i / PARTICLES], point_m);
            deepest_m = fmax(deepest_m, -gap);
            touches += gap < 0.011;
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
    printf("%d times a particle lay against him, none deeper than %.1f mm\n", touches, 1000.0 * deepest_m);
    printf("never more than %.2f m from the shoulders\n", (double)farthest);

    // The first triangle looks to where its normals point.
    const float *a = vertices[indices[0][0]].position, *b = vertices[indices[0][1]].position,
                *c = vertices[indices[0][2]].position, *n = vertices[indices[0][0]].normal;
    const float p[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, q[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const float front = n[0] * (p[1] * q[2] - p[2] * q[1]) + n[1] * (p[2] * q[0] - p[0] * q[2]) +
                        n[2] * (p[0] * q[1] - p[1] * q[0]);
    return largest < 0.15f && off_m < 1e-5 && farthest < 1.5f && front > 0.0f && touches > 200 && deepest_m < 0.001
               ? 0
               : 1;
}
