// taut for C++17: taut.h with classes. Header-only; no standard library, no exceptions, no run-time type information, and
// like taut.h no allocation: memory is an argument.
//
//     static taut::GridStorage grid_memory;
//     static taut::ClothStorage<32, 32, 2> cloth_memory; // rows, columns, pins
//
//     taut::Grid grid;
//     taut::Cloth cloth;
//     if (grid.create(taut::grid_def_default(), grid_memory) != TAUT_OK) ...
//     taut_cloth_def def = taut::cloth_def_default(grid);
//     def.max_pins = 2;
//     if (cloth.create(grid, def, cloth_memory) != TAUT_OK) ...
//
// Every function of taut.h is here under its name, less the prefix: taut_cloth_pin_move(cloth, ...) is cloth.pin_move(...),
// taut_field_info is taut::field_info. What taut.h says about ranges, defaults and errors holds; the comments here tell only
// what is added. A call that changes the cloth is not const, one that reads it is: const calls may run at the same time.
//
// Grid and Cloth are handles: they can be moved, not copied, and the one moved from is empty. An empty one answers every call
// with TAUT_ERROR_NULL_POINTER. There is nothing to destroy: the storage is yours, and must outlive the handle and stay where
// it is.
#ifndef TAUT_HPP
#define TAUT_HPP

#include "taut.h"

namespace taut {

// A block of the caller's memory.
struct Block {
    void *data;
    size_t size;
};

// Memory for a block: static, in a class of yours, or from your allocator.
template <size_t Size, size_t Align> struct Storage {
    alignas(Align) unsigned char bytes[Size];

    operator Block() noexcept { return {bytes, Size}; }
};

using GridStorage = Storage<TAUT_GRID_BYTES, TAUT_GRID_ALIGN>;

// As much as taut_cloth_memory asks for.
template <uint32_t Rows, uint32_t Columns, uint32_t MaxPins, uint32_t Families = TAUT_FAMILY_ALL,
          uint32_t Features = TAUT_FEATURE_NONE>
using ClothStorage = Storage<TAUT_CLOTH_BYTES(Rows, Columns, Families, Features, MaxPins), TAUT_CLOTH_ALIGN>;

// One attribute in a vertex buffer: where the first one lies, the bytes from there to the buffer's end, and the bytes from a
// vertex to the next.
struct Attribute {
    void *data;
    size_t size;
    size_t stride;
};

// The attribute `member` of an array of vertices, as in attribute(vertices, count, &Vertex::normal).
template <class Vertex, class Member>
Attribute attribute(Vertex *vertices, size_t count, Member Vertex::*member) noexcept
{
    if (vertices == nullptr || count == 0) {
        return {vertices, 0, sizeof(Vertex)};
    }
    unsigned char *first = reinterpret_cast<unsigned char *>(&(vertices->*member));
    const unsigned char *end = reinterpret_cast<unsigned char *>(vertices + count);
    return {first, static_cast<size_t>(end - first), sizeof(Vertex)};
}

// An array that holds nothing but the attribute, as float positions[1024][3].
template <class Vector> Attribute attribute(Vector *vectors, size_t count) noexcept
{
    return {vectors, count * sizeof(Vector), sizeof(Vector)};
}

inline uint32_t version() noexcept { return taut_version(); }

// Whether the library that was found at run time fits the header that this was compiled with.
[[nodiscard]] inline taut_result check_version(uint32_t version_id = TAUT_VERSION_ID) noexcept
{
    return taut_check_version(version_id);
}

inline const char *result_name(taut_result result) noexcept { return taut_result_name(result); }

inline const char *result_message(taut_result result) noexcept { return taut_result_message(result); }

[[nodiscard]] inline taut_result field_info(const void *data, size_t size, taut_field &out) noexcept
{
    return taut_field_info(data, size, &out);
}

inline taut_plan_def plan_def_default() noexcept { return taut_plan_def_default(); }

[[nodiscard]] inline taut_result plan(const taut_grid_def &on, const taut_plan_def &def, taut_settings &out) noexcept
{
    return taut_plan(&on, &def, &out);
}

/// taut_plan_apply
[[nodiscard]] inline taut_result apply(const taut_settings &settings, taut_grid_def &on, taut_cloth_def &def) noexcept
{
    return taut_plan_apply(&settings, &on, &def);
}

inline taut_grid_def grid_def_default() noexcept { return taut_grid_def_default(); }

[[nodiscard]] inline taut_result grid_memory(const taut_grid_def &def, taut_memory &out) noexcept
{
    return taut_grid_memory(&def, &out);
}

// The shape is a taut_shape.
inline taut_collider_def collider_def_default(uint32_t shape) noexcept { return taut_collider_def_default(shape); }

inline taut_air air_default() noexcept { return taut_air_default(); }
// Whether this machine has the vectors: 1, or 0.
[[nodiscard]] inline taut_result width_supported(taut_width width, uint32_t &out) noexcept
{
    return taut_width_supported(width, &out);
}

class Grid {
public:
    Grid() noexcept = default;
    Grid(const Grid &) = delete;
    Grid &operator=(const Grid &) = delete;
    Grid(Grid &&from) noexcept : handle_(from.handle_) { from.handle_ = nullptr; }
    Grid &operator=(Grid &&from) noexcept
    {
        taut_grid *handle = from.handle_;
        from.handle_ = nullptr;
        handle_ = handle;
        return *this;
    }

    // Makes the grid in a block. On an error this handle is as it was.
    [[nodiscard]] taut_result create(const taut_grid_def &def, Block block) noexcept
    {
        return taut_grid_create(&def, block.data, block.size, &handle_);
    }

    [[nodiscard]] taut_result counts(taut_counts &out) const noexcept { return taut_grid_counts(handle_, &out); }

    [[nodiscard]] taut_result digest(uint64_t &out) const noexcept { return taut_grid_digest(handle_, &out); }

    [[nodiscard]] taut_result triangle_count(uint32_t &out) const noexcept
    {
        return taut_grid_triangle_count(handle_, &out);
    }

    [[nodiscard]] taut_result copy_triangles_u32(void *out, size_t out_size) const noexcept
    {
        return taut_grid_copy_triangles_u32(handle_, out, out_size);
    }

    [[nodiscard]] taut_result copy_triangles_u16(void *out, size_t out_size) const noexcept
    {
        return taut_grid_copy_triangles_u16(handle_, out, out_size);
    }

    [[nodiscard]] taut_result copy_uvs_f32(Attribute out) const noexcept
    {
        return taut_grid_copy_uvs_f32(handle_, out.data, out.size, out.stride);
    }

    // The handle for taut.h, NULL if this is empty.
    taut_grid *get() const noexcept { return handle_; }

    explicit operator bool() const noexcept { return handle_ != nullptr; }

private:
    taut_grid *handle_ = nullptr;
};

inline taut_cloth_def cloth_def_default(const Grid &on) noexcept { return taut_cloth_def_default(on.get()); }

[[nodiscard]] inline taut_result cloth_memory(const Grid &on, const taut_cloth_def &def, taut_memory &out) noexcept
{
    return taut_cloth_memory(on.get(), &def, &out);
}

// One frame of a cloth in bands of rows that many threads may step: begun by Cloth::bands_begin, and nothing else may use the
// cloth until the end. A frame that was begun must be ended.
class Bands {
public:
    Bands() noexcept = default;
    explicit Bands(taut_bands *handle) noexcept : handle_(handle) {}
    Bands(const Bands &) = delete;
    Bands &operator=(const Bands &) = delete;
    Bands(Bands &&from) noexcept : handle_(from.handle_) { from.handle_ = nullptr; }
    Bands &operator=(Bands &&from) noexcept
    {
        taut_bands *handle = from.handle_;
        from.handle_ = nullptr;
        handle_ = handle;
        return *this;
    }

    [[nodiscard]] taut_result count(uint32_t &bands, uint32_t &phases) const noexcept
    {
        return taut_bands_count(handle_, &bands, &phases);
    }

    // By any thread, for different bands of one phase at a time.
    [[nodiscard]] taut_result run(uint32_t phase, uint32_t band) const noexcept
    {
        return taut_bands_run(handle_, phase, band);
    }

    // The handle is empty afterwards. out_flags may be left out.
    [[nodiscard]] taut_result end(uint32_t *out_flags = nullptr) noexcept
    {
        taut_bands *handle = handle_;
        handle_ = nullptr;
        return taut_bands_end(handle, out_flags);
    }

    explicit operator bool() const noexcept { return handle_ != nullptr; }

private:
    taut_bands *handle_ = nullptr;
};

class Cloth {
public:
    Cloth() noexcept = default;
    Cloth(const Cloth &) = delete;
    Cloth &operator=(const Cloth &) = delete;
    Cloth(Cloth &&from) noexcept : handle_(from.handle_) { from.handle_ = nullptr; }
    Cloth &operator=(Cloth &&from) noexcept
    {
        taut_cloth *handle = from.handle_;
        from.handle_ = nullptr;
        handle_ = handle;
        return *this;
    }

    // Makes the cloth in a block. On an error this handle is as it was.
    [[nodiscard]] taut_result create(const Grid &on, const taut_cloth_def &def, Block block) noexcept
    {
        return taut_cloth_create(on.get(), &def, block.data, block.size, &handle_);
    }

    [[nodiscard]] taut_result reset() noexcept { return taut_cloth_reset(handle_); }

    // Stiffness and budget.

    [[nodiscard]] taut_result set_stiffness_uniform(float warp_n_m, float weft_n_m, float shear_n_m,
                                                    float bend_n_m) noexcept
    {
        return taut_cloth_set_stiffness_uniform(handle_, warp_n_m, weft_n_m, shear_n_m, bend_n_m);
    }

    [[nodiscard]] taut_result set_stiffness_field(uint32_t channels, uint32_t rows, uint32_t columns,
                                                  const float *data) noexcept
    {
        return taut_cloth_set_stiffness_field(handle_, channels, rows, columns, data);
    }

    // out_repaired may be left out.
    [[nodiscard]] taut_result set_stiffness_field_sanitised(uint32_t channels, uint32_t rows, uint32_t columns,
                                                            const float *data,
                                                            uint32_t *out_repaired = nullptr) noexcept
    {
        return taut_cloth_set_stiffness_field_sanitised(handle_, channels, rows, columns, data, out_repaired);
    }

    [[nodiscard]] taut_result load_stiffness(const void *data, size_t size, taut_fabric *out_fabric = nullptr) noexcept
    {
        return taut_cloth_load_stiffness(handle_, data, size, out_fabric);
    }

    [[nodiscard]] taut_result budget(taut_budget_report &out) noexcept { return taut_cloth_budget(handle_, &out); }

    [[nodiscard]] taut_result predict_stretch(taut_budget_report &out) noexcept
    {
        return taut_cloth_predict_stretch(handle_, &out);
    }

    // Matter: which particles exist, and what they weigh.

    [[nodiscard]] taut_result set_mask(uint32_t count, const uint8_t *present) noexcept
    {
        return taut_cloth_set_mask(handle_, count, present);
    }

    [[nodiscard]] taut_result set_masses(uint32_t count, const float *mass_kg) noexcept
    {
        return taut_cloth_set_masses(handle_, count, mass_kg);
    }

    // Surroundings. A vector can be written as {x, y, z}.

    [[nodiscard]] taut_result set_gravity(const float (&gravity_m_s2)[3]) noexcept
    {
        return taut_cloth_set_gravity(handle_, gravity_m_s2);
    }

    [[nodiscard]] taut_result set_damping(float damping_per_s) noexcept
    {
        return taut_cloth_set_damping(handle_, damping_per_s);
    }

    [[nodiscard]] taut_result set_rest_scale(float warp, float weft, float diagonal) noexcept
    {
        return taut_cloth_set_rest_scale(handle_, warp, weft, diagonal);
    }

    [[nodiscard]] taut_result set_air(const taut_air &air) noexcept { return taut_cloth_set_air(handle_, &air); }

    [[nodiscard]] taut_result air(taut_air &out) const noexcept { return taut_cloth_air(handle_, &out); }

    // Frame.

    [[nodiscard]] taut_result set_frame(const taut_pose &frame, float linear_inertia, float angular_inertia) noexcept
    {
        return taut_cloth_set_frame(handle_, &frame, linear_inertia, angular_inertia);
    }

    [[nodiscard]] taut_result teleport(const taut_pose &frame) noexcept { return taut_cloth_teleport(handle_, &frame); }

    [[nodiscard]] taut_result set_origin(const double (&origin_m)[3]) noexcept
    {
        return taut_cloth_set_origin(handle_, origin_m);
    }

    [[nodiscard]] taut_result frame(taut_pose &out) const noexcept { return taut_cloth_frame(handle_, &out); }

    // Pins and particles.

    [[nodiscard]] taut_result pin(uint32_t particle) noexcept { return taut_cloth_pin(handle_, particle); }

    [[nodiscard]] taut_result pin_move(uint32_t particle, const double (&world_m)[3]) noexcept
    {
        return taut_cloth_pin_move(handle_, particle, world_m);
    }

    [[nodiscard]] taut_result unpin(uint32_t particle) noexcept { return taut_cloth_unpin(handle_, particle); }

    [[nodiscard]] taut_result pin_count(uint32_t &out) const noexcept { return taut_cloth_pin_count(handle_, &out); }

    [[nodiscard]] taut_result pin_force(uint32_t particle, float (&out_n)[3]) noexcept
    {
        return taut_cloth_pin_force(handle_, particle, out_n);
    }

    [[nodiscard]] taut_result copy_pin_forces_f32(Attribute out) noexcept
    {
        return taut_cloth_copy_pin_forces_f32(handle_, out.data, out.size, out.stride);
    }

    [[nodiscard]] taut_result set_position(uint32_t particle, const float (&local_m)[3]) noexcept
    {
        return taut_cloth_set_position(handle_, particle, local_m);
    }

    [[nodiscard]] taut_result set_positions(uint32_t count, const float *local_m) noexcept
    {
        return taut_cloth_set_positions(handle_, count, local_m);
    }

    [[nodiscard]] taut_result set_velocity(uint32_t particle, const float (&v_m_s)[3]) noexcept
    {
        return taut_cloth_set_velocity(handle_, particle, v_m_s);
    }

    [[nodiscard]] taut_result add_force(uint32_t particle, const float (&force_n)[3]) noexcept
    {
        return taut_cloth_add_force(handle_, particle, force_n);
    }

    // Colliders.

    [[nodiscard]] taut_result collider_add(const taut_collider_def &def, uint32_t &out_id) noexcept
    {
        return taut_cloth_collider_add(handle_, &def, &out_id);
    }

    [[nodiscard]] taut_result collider_move(uint32_t id, const taut_pose &pose) noexcept
    {
        return taut_cloth_collider_move(handle_, id, &pose);
    }

    [[nodiscard]] taut_result collider_set_pose(uint32_t id, const taut_pose &pose) noexcept
    {
        return taut_cloth_collider_set_pose(handle_, id, &pose);
    }

    [[nodiscard]] taut_result collider_remove(uint32_t id) noexcept { return taut_cloth_collider_remove(handle_, id); }

    [[nodiscard]] taut_result collider_pose(uint32_t id, taut_pose &out) const noexcept
    {
        return taut_cloth_collider_pose(handle_, id, &out);
    }

    [[nodiscard]] taut_result collider_count(uint32_t &out) const noexcept
    {
        return taut_cloth_collider_count(handle_, &out);
    }

    // Targets. The backstop may be left out; normals may be NULL.

    [[nodiscard]] taut_result set_target_limits(uint32_t count, const float *max_distance_m,
                                                const float *backstop_radius_m = nullptr,
                                                const float *backstop_distance_m = nullptr) noexcept
    {
        return taut_cloth_set_target_limits(handle_, count, max_distance_m, backstop_radius_m, backstop_distance_m);
    }

    [[nodiscard]] taut_result move_targets(const double (&base_m)[3], uint32_t count, const void *positions_m,
                                           const void *normals, size_t stride) noexcept
    {
        return taut_cloth_move_targets(handle_, base_m, count, positions_m, normals, stride);
    }

    [[nodiscard]] taut_result set_targets(const double (&base_m)[3], uint32_t count, const void *positions_m,
                                          const void *normals, size_t stride) noexcept
    {
        return taut_cloth_set_targets(handle_, base_m, count, positions_m, normals, stride);
    }

    // Steps. out_flags may be left out.

    [[nodiscard]] taut_result step(uint32_t *out_flags = nullptr) noexcept
    {
        return taut_cloth_step(handle_, out_flags);
    }

    [[nodiscard]] taut_result step_many(uint32_t count, uint32_t *out_flags = nullptr) noexcept
    {
        return taut_cloth_step_many(handle_, count, out_flags);
    }

    [[nodiscard]] taut_result wake() noexcept { return taut_cloth_wake(handle_); }

    // The vectors that it is stepped in: to time and test them, with the same bits.
    [[nodiscard]] taut_result set_width(taut_width width) noexcept { return taut_cloth_set_width(handle_, width); }
    [[nodiscard]] taut_result width(uint32_t &out) const noexcept { return taut_cloth_width(handle_, &out); }
    [[nodiscard]] taut_result is_asleep(uint32_t &out) const noexcept { return taut_cloth_is_asleep(handle_, &out); }

    [[nodiscard]] taut_result step_index(uint64_t &out) const noexcept { return taut_cloth_step_index(handle_, &out); }

    // Reading.

    [[nodiscard]] taut_result positions(taut_position_view &out) const noexcept
    {
        return taut_cloth_positions(handle_, &out);
    }

    [[nodiscard]] taut_result copy_positions_f64(Attribute out) const noexcept
    {
        return taut_cloth_copy_positions_f64(handle_, out.data, out.size, out.stride);
    }

    [[nodiscard]] taut_result copy_positions_f32(const double (&base_m)[3], Attribute out) const noexcept
    {
        return taut_cloth_copy_positions_f32(handle_, base_m, out.data, out.size, out.stride);
    }

    [[nodiscard]] taut_result copy_velocities_f32(Attribute out) const noexcept
    {
        return taut_cloth_copy_velocities_f32(handle_, out.data, out.size, out.stride);
    }

    [[nodiscard]] taut_result copy_normals_f32(Attribute out) const noexcept
    {
        return taut_cloth_copy_normals_f32(handle_, out.data, out.size, out.stride);
    }

    [[nodiscard]] taut_result bounds(taut_bounds &out) const noexcept { return taut_cloth_bounds(handle_, &out); }

    [[nodiscard]] taut_result strain(taut_strain &out) const noexcept { return taut_cloth_strain(handle_, &out); }

    [[nodiscard]] taut_result kinetic_energy(double &out_j) const noexcept
    {
        return taut_cloth_kinetic_energy(handle_, &out_j);
    }

    // Rollback.

    [[nodiscard]] taut_result snapshot_size(size_t &out) const noexcept
    {
        return taut_cloth_snapshot_size(handle_, &out);
    }

    [[nodiscard]] taut_result snapshot_size_max(size_t &out) const noexcept
    {
        return taut_cloth_snapshot_size_max(handle_, &out);
    }

    [[nodiscard]] taut_result snapshot(void *out, size_t out_size, size_t *out_written = nullptr) noexcept
    {
        return taut_cloth_snapshot(handle_, out, out_size, out_written);
    }

    [[nodiscard]] taut_result restore(const void *data, size_t size) noexcept
    {
        return taut_cloth_restore(handle_, data, size);
    }

    [[nodiscard]] taut_result state_hash(uint64_t &out) noexcept { return taut_cloth_state_hash(handle_, &out); }

    // A frame in bands that many threads may step.

    [[nodiscard]] taut_result bands_memory(uint32_t rows_per_band, taut_memory &out) const noexcept
    {
        return taut_cloth_bands_memory(handle_, rows_per_band, &out);
    }

    // The block stays until the end of the bands.
    [[nodiscard]] taut_result bands_begin(uint32_t rows_per_band, Block block, Bands &out) noexcept
    {
        taut_bands *handle = nullptr;
        const taut_result result = taut_cloth_bands_begin(handle_, rows_per_band, block.data, block.size, &handle);
        if (result == TAUT_OK) {
            out = Bands(handle);
        }
        return result;
    }

    // The handle for taut.h, NULL if this is empty. It can change the cloth, so a const Cloth does not give it.
    taut_cloth *get() noexcept { return handle_; }

    explicit operator bool() const noexcept { return handle_ != nullptr; }

private:
    taut_cloth *handle_ = nullptr;
};

// Steps a list of cloths, as Cloth::get gives them, one frame each. out_flags, which may be left out, has count places.
[[nodiscard]] inline taut_result cloth_step_all(taut_cloth *const *cloths, uint32_t count,
                                                uint32_t *out_flags = nullptr) noexcept
{
    return taut_cloth_step_all(cloths, count, out_flags);
}

} // namespace taut

#endif // TAUT_HPP
