// Every function of taut.hpp is called, without exceptions and run-time type information. What only C++ has is checked: empty
// handles, moves, vertex attributes, the sizes of storage.
#include <stdio.h>

#include "require.h"
#include "taut.hpp"

#define DONE(call) REQUIRE((call) == TAUT_OK)
#define EMPTY(call) REQUIRE((call) == TAUT_ERROR_NULL_POINTER)

// What a type can do, without the standard library.
template <class T> T &&make() noexcept;
template <class T, class = void> constexpr bool copies = false;
template <class T> constexpr bool copies<T, decltype(void(T(make<const T &>())))> = true;
template <class T, class = void> constexpr bool assigns = false;
template <class T> constexpr bool assigns<T, decltype(void(make<T &>() = make<const T &>()))> = true;
static_assert(!copies<taut::Grid> && !assigns<taut::Grid>, "two handles of one grid");
static_assert(!copies<taut::Cloth> && !assigns<taut::Cloth>, "two handles of one cloth");
static_assert(copies<int> && assigns<int>, "the question itself");
static_assert(noexcept(taut::Cloth(make<taut::Cloth>())), "vectors move only what cannot fail");
static_assert(sizeof(taut::Grid) == sizeof(void *) && sizeof(taut::Cloth) == sizeof(void *), "no cost");

namespace {

constexpr uint32_t side = 8;
constexpr uint32_t particles = side * side;

struct Vertex {
    unsigned short color;
    float position[3];
    float normal[3];
    float uv[2];
    float velocity[3];
};

taut::GridStorage grid_memory;
taut::ClothStorage<side, side, 3, TAUT_FAMILY_ALL, TAUT_FEATURE_PULL> cloth_memory;
taut::ClothStorage<side, side, 3, TAUT_FAMILY_ALL, TAUT_FEATURE_PULL> other_memory;
constexpr uint32_t whole_features = TAUT_FEATURE_AIR | TAUT_FEATURE_MASS | TAUT_FEATURE_MASK | TAUT_FEATURE_COLLIDERS |
                                    TAUT_FEATURE_TARGETS;
taut::ClothStorage<side, side, 3, TAUT_FAMILY_ALL, whole_features> whole_memory;
constexpr size_t band_bytes = 8192;
taut::Storage<band_bytes, TAUT_CLOTH_ALIGN> band_block;
unsigned char file_bytes[64 * 1024];
unsigned char snapshot[64 * 1024];
Vertex vertices[particles];
double world[particles][3];
uint32_t wide[TAUT_TRIANGLES(side, side)][3];
uint16_t narrow[TAUT_TRIANGLES(side, side)][3];

int empty_handles()
{
    taut::Grid grid;
    taut::Cloth cloth;
    taut_counts counts;
    uint64_t u64;
    uint32_t u32;
    REQUIRE(!grid && !cloth && grid.get() == nullptr && cloth.get() == nullptr);
    EMPTY(grid.counts(counts));
    EMPTY(grid.digest(u64));
    EMPTY(grid.triangle_count(u32));
    taut_memory bytes;
    taut::Bands bands;
    EMPTY(cloth.bands_memory(8, bytes));
    EMPTY(cloth.bands_begin(8, band_block, bands));
    EMPTY(bands.count(u32, u32));
    EMPTY(bands.run(0, 0));
    EMPTY(bands.end());
    REQUIRE(!bands);
    EMPTY(cloth.reset());
    EMPTY(cloth.step());
    EMPTY(cloth.create(grid, taut::cloth_def_default(grid), cloth_memory));
    REQUIRE(!cloth);
    return 0;
}

// What the engine's world does to a cloth: air, frame, colliders, a skin.
int surroundings(const taut::Grid &grid)
{
    taut_cloth_def def = taut::cloth_def_default(grid);
    def.max_pins = 3;
    def.features = whole_features;
    def.sleep_speed_m_s = 1000.0f;
    taut_memory memory;
    DONE(taut::cloth_memory(grid, def, memory));
    REQUIRE(memory.size == sizeof whole_memory);
    taut::Cloth cloth;
    DONE(cloth.create(grid, def, whole_memory));
    const taut::Cloth &read = cloth;
    const float field[4] = {100, -100, 100, 100};
    uint32_t repaired = 0;
    DONE(cloth.set_stiffness_field_sanitised(1, 2, 2, field));
    DONE(cloth.set_stiffness_field_sanitised(1, 2, 2, field, &repaired));
    REQUIRE(repaired == 1);
    DONE(cloth.set_stiffness_uniform(500, 500, 100, 5));

    uint8_t present[particles];
    float mass[particles];
    for (uint32_t i = 0; i < particles; ++i) {
        present[i] = i != particles - 1;
        mass[i] = 2.0f * def.density_kg_m2 / particles;
    }
    DONE(cloth.set_mask(particles, present));
    DONE(cloth.set_masses(particles, mass));
    REQUIRE(cloth.pin(particles - 1) == TAUT_ERROR_ABSENT);
    DONE(cloth.set_gravity({0.0f, -1.0f, 0.0f}));
    DONE(cloth.set_damping(3.0f));
    DONE(cloth.set_rest_scale(1.0f, 1.0f, 1.01f));
    taut_air air = taut::air_default(), now;
    air.wind_m_s[2] = 2.0f;
    DONE(cloth.set_air(air));
    DONE(read.air(now));
    REQUIRE(now.wind_m_s[2] == 2.0f && now.seed == air.seed);

    taut_collider_def ball = taut::collider_def_default(TAUT_SHAPE_SPHERE);
    ball.pose.position_m[2] = -5.0;
    uint32_t id, count;
    DONE(cloth.collider_add(ball, id));
    taut_pose pose = ball.pose, there;
    pose.position_m[2] = -6.0;
    DONE(cloth.collider_set_pose(id, pose));
    DONE(read.collider_pose(id, there));
    REQUIRE(there.position_m[2] == -6.0);
    DONE(cloth.collider_move(id, ball.pose));
    DONE(read.collider_count(count));
    REQUIRE(count == 1);

    float far[particles], none[particles] = {}, skin[particles][6];
    for (uint32_t i = 0; i < particles; ++i) {
        const float u = static_cast<float>(i % side) / 7.0f, v = static_cast<float>(i / side) / 7.0f;
        const float at[6] = {u, -v, 0.0f, 0.0f, 0.0f, 1.0f};
        far[i] = 10.0f;
        for (int j = 0; j < 6; ++j) {
            skin[i][j] = at[j];
        }
    }
    DONE(cloth.set_target_limits(particles, far));
    DONE(cloth.set_target_limits(particles, far, none, none));
    DONE(cloth.set_targets({0.0, 0.0, 0.0}, particles, skin, &skin[0][3], sizeof skin[0]));
    DONE(cloth.move_targets({0.0, 0.0, 0.01}, particles, skin, nullptr, sizeof skin[0]));

    taut_grid_def planned = taut::grid_def_default();
    taut_plan_def wish = taut::plan_def_default();
    taut_settings settings;
    DONE(taut::plan(planned, wish, settings));
    REQUIRE(settings.meets == 1 && settings.strain <= wish.tolerance && settings.substeps >= 1);
    taut_cloth_def applied = taut::cloth_def_default(grid);
    DONE(taut::apply(settings, planned, applied));
    REQUIRE(applied.substeps == settings.substeps && applied.strain_limit[2] == settings.strain_limit);
    wish.budget_ns = 1.0f;
    REQUIRE(taut::plan(planned, wish, settings) == TAUT_ERROR_NO_PLAN);

    DONE(cloth.pin(0));
    DONE(cloth.pin(side - 1));
    uint32_t flags, asleep = 1;
    DONE(cloth.step(&flags));
    REQUIRE(flags == 0);
    float force[3], forces[2][3];
    DONE(cloth.pin_force(0, force));
    DONE(cloth.copy_pin_forces_f32(taut::attribute(forces, 2)));
    REQUIRE(force[0] == forces[0][0] && force[1] == forces[0][1] && force[2] == forces[0][2]);
    DONE(cloth.collider_remove(id));
    REQUIRE(read.collider_pose(id, there) == TAUT_ERROR_NO_SUCH_COLLIDER);

    taut_pose frame;
    DONE(read.frame(frame));
    frame.position_m[0] = 0.1;
    DONE(cloth.set_frame(frame, 0.5f, 0.5f));
    DONE(cloth.step(&flags));
    frame.position_m[0] = 500.0;
    DONE(cloth.teleport(frame));
    DONE(cloth.set_origin({1000.0, 0.0, 0.0}));
    DONE(read.frame(frame));
    REQUIRE(frame.position_m[0] == 1000.0);

    // everything is slower than 1 km/s
    DONE(read.is_asleep(asleep));
    REQUIRE(asleep == 0);
    DONE(cloth.step_many(60, &flags));
    DONE(read.is_asleep(asleep));
    REQUIRE(asleep == 1 && (flags & TAUT_STEP_ASLEEP) != 0);
    DONE(cloth.wake());
    uint32_t widest, has;
    DONE(read.width(widest));
    DONE(taut::width_supported(static_cast<taut_width>(widest), has));
    REQUIRE(has == 1);
    DONE(cloth.set_width(TAUT_WIDTH_SCALAR));
    DONE(read.width(widest));
    REQUIRE(widest == TAUT_WIDTH_SCALAR);
    DONE(read.is_asleep(asleep));
    REQUIRE(asleep == 0);
    return 0;
}

int run(const void *file, size_t size)
{
    DONE(taut::check_version());
    REQUIRE(taut::version() == TAUT_VERSION_ID);
    REQUIRE(taut::result_name(TAUT_OK)[0] == 'T' && taut::result_message(TAUT_OK)[0] == 'd');
    taut_field info;
    DONE(taut::field_info(file, size, info));

    taut_grid_def grid_def = taut::grid_def_default();
    grid_def.rows = grid_def.columns = side;
    taut_memory memory;
    DONE(taut::grid_memory(grid_def, memory));
    REQUIRE(memory.size == sizeof grid_memory && memory.align == alignof(taut::GridStorage));
    taut::Grid grid;
    DONE(grid.create(grid_def, grid_memory));
    taut_counts counts;
    uint64_t digest;
    uint32_t triangles;
    DONE(grid.counts(counts));
    DONE(grid.digest(digest));
    DONE(grid.triangle_count(triangles));
    REQUIRE(counts.particles == particles && triangles == TAUT_TRIANGLES(side, side));
    DONE(grid.copy_triangles_u32(wide, sizeof wide));
    DONE(grid.copy_triangles_u16(narrow, sizeof narrow));
    for (uint32_t i = 0; i < triangles; ++i) {
        for (int j = 0; j < 3; ++j) {
            REQUIRE(wide[i][j] == narrow[i][j] && wide[i][j] < particles);
        }
    }

    taut_cloth_def def = taut::cloth_def_default(grid);
    def.max_pins = 3;
    def.features = TAUT_FEATURE_PULL;
    def.origin_m[0] = 1000.0;
    DONE(taut::cloth_memory(grid, def, memory));
    REQUIRE(memory.size == sizeof cloth_memory && memory.align == alignof(decltype(cloth_memory)));
    taut::Cloth cloth;
    DONE(cloth.create(grid, def, cloth_memory));
    REQUIRE(cloth.step() == TAUT_ERROR_NO_STIFFNESS);
    const float field[4] = {100, 100, 100, 100};
    DONE(cloth.set_stiffness_uniform(500, 500, 100, 5));
    DONE(cloth.set_stiffness_field(1, 2, 2, field));
    taut_fabric fabric;
    DONE(cloth.load_stiffness(file, size, &fabric));
    DONE(cloth.load_stiffness(file, size));
    REQUIRE(fabric.density_kg_m2 == info.fabric.density_kg_m2);
    DONE(cloth.pin(0));
    DONE(cloth.pin(side - 1));
    DONE(cloth.pin(side));
    DONE(cloth.unpin(side));
    DONE(cloth.pin_move(0, {1000.01, 0.0, 0.0}));
    uint32_t pins;
    DONE(cloth.pin_count(pins));
    REQUIRE(pins == 2);
    taut_budget_report report;
    DONE(cloth.budget(report));
    DONE(cloth.predict_stretch(report));
    DONE(cloth.set_velocity(30, {0.0f, 0.0f, 0.1f}));
    DONE(cloth.add_force(30, {0.0f, 0.0f, 0.01f}));
    DONE(cloth.set_position(31, {1.0f, -0.45f, 0.01f}));

    size_t used, most, written;
    uint64_t hash, again;
    DONE(cloth.snapshot_size(used));
    DONE(cloth.snapshot_size_max(most));
    REQUIRE(used <= most && most <= sizeof snapshot);
    DONE(cloth.snapshot(snapshot, sizeof snapshot, &written));
    uint32_t flags = 7;
    DONE(cloth.step(&flags));
    REQUIRE(flags == 0);
    DONE(cloth.step_many(9, &flags));
    DONE(cloth.state_hash(hash));

    // a moved cloth is the same cloth, and the handle it came from is empty
    taut::Cloth moved(static_cast<taut::Cloth &&>(cloth));
    REQUIRE(moved && !cloth);
    DONE(moved.restore(snapshot, written));
    cloth = static_cast<taut::Cloth &&>(moved);
    REQUIRE(cloth && !moved);
    taut::Cloth &same = cloth;
    cloth = static_cast<taut::Cloth &&>(same);
    REQUIRE(cloth);
    taut::Grid moved_grid(static_cast<taut::Grid &&>(grid));
    grid = static_cast<taut::Grid &&>(moved_grid);
    REQUIRE(grid && !moved_grid);
    taut_cloth *all[1] = {cloth.get()};
    for (int i = 0; i < 10; ++i) {
        DONE(taut::cloth_step_all(all, 1, &flags));
    }
    DONE(cloth.state_hash(again));
    uint64_t index;
    DONE(cloth.step_index(index));
    REQUIRE(again == hash && index == 10);

    // one frame in bands, as a job system would step them
    taut_memory band_memory;
    DONE(cloth.bands_memory(8, band_memory));
    REQUIRE(band_memory.size <= band_bytes && band_memory.align <= TAUT_CLOTH_ALIGN);
    taut::Bands bands;
    DONE(cloth.bands_begin(8, band_block, bands));
    uint32_t band_count, phases;
    DONE(bands.count(band_count, phases));
    REQUIRE(bands && band_count >= 1 && phases > 0);
    for (uint32_t phase = 0; phase < phases; ++phase) {
        for (uint32_t band = 0; band < band_count; ++band) {
            DONE(bands.run(phase, band));
        }
    }
    taut::Bands moved_bands(static_cast<taut::Bands &&>(bands));
    DONE(moved_bands.end(&flags));
    REQUIRE(!bands && !moved_bands && flags == 0);
    DONE(cloth.step_index(index));
    REQUIRE(index == 11);

    // reading through a const reference, into an interleaved buffer
    const taut::Cloth &read = cloth;
    const taut::Attribute positions = taut::attribute(vertices, particles, &Vertex::position);
    REQUIRE(positions.stride == sizeof(Vertex));
    REQUIRE(static_cast<unsigned char *>(positions.data) + positions.size ==
            reinterpret_cast<unsigned char *>(vertices + particles));
    DONE(read.copy_positions_f32({1000.0, 0.0, 0.0}, positions));
    DONE(read.copy_normals_f32(taut::attribute(vertices, particles, &Vertex::normal)));
    DONE(read.copy_velocities_f32(taut::attribute(vertices, particles, &Vertex::velocity)));
    DONE(grid.copy_uvs_f32(taut::attribute(vertices, particles, &Vertex::uv)));
    DONE(read.copy_positions_f64(taut::attribute(world, particles)));
    REQUIRE(read.copy_normals_f32(taut::attribute(vertices, particles - 1, &Vertex::normal)) ==
            TAUT_ERROR_BLOCK_TOO_SMALL);
    REQUIRE(read.copy_normals_f32(taut::attribute(vertices, 0, &Vertex::normal)) == TAUT_ERROR_BLOCK_TOO_SMALL);
    taut_position_view view;
    taut_bounds bounds;
    taut_strain strain;
    double energy;
    DONE(read.positions(view));
    DONE(read.bounds(bounds));
    DONE(read.strain(strain));
    DONE(read.kinetic_energy(energy));
    REQUIRE(energy > 0 && strain.largest > 0);
    for (uint32_t i = 0; i < particles; ++i) {
        const Vertex &v = vertices[i];
        const float length = v.normal[0] * v.normal[0] + v.normal[1] * v.normal[1] + v.normal[2] * v.normal[2];
        REQUIRE(v.color == 0 && length > 0.999f && length < 1.001f);
        REQUIRE(v.uv[0] == static_cast<float>(i % side) / 7.0f && v.uv[1] == static_cast<float>(i / side) / 7.0f);
        REQUIRE(v.position[0] == static_cast<float>(world[i][0] - 1000.0));
        REQUIRE(v.position[1] == view.y[i / side * view.row_stride + i % side]);
        for (int axis = 0; axis < 3; ++axis) {
            REQUIRE(bounds.low_m[axis] <= world[i][axis] && world[i][axis] <= bounds.high_m[axis]);
        }
    }

    taut::Cloth other;
    DONE(other.create(grid, def, other_memory));
    float start[particles][3] = {};
    DONE(other.set_positions(particles, start[0]));
    DONE(other.reset());
    DONE(other.step_index(index));
    REQUIRE(index == 0);
    return surroundings(grid);
}

} // namespace

int main(int argc, char **argv)
{
    FILE *file = argc == 2 ? fopen(argv[1], "rb") : nullptr;
    REQUIRE(file);
    const size_t size = fread(file_bytes, 1, sizeof file_bytes, file);
    fclose(file);
    if (empty_handles() || run(file_bytes, size)) {
        return 1;
    }
    printf("every function was called\n");
    return 0;
}
