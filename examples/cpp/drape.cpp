// A cloth of the fabric in a baked field file hangs from two corners for five seconds, and the second half is rewound and
// stepped again. The same as examples/c/drape.c, in C++17 with taut.hpp.
//
//     c++ -std=c++17 -I include examples/cpp/drape.cpp target/release/libtaut.a -o drape
//     ./drape examples/data/denim.tautfield
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "taut.hpp"

namespace {

constexpr std::uint32_t rows = 32;
constexpr std::uint32_t columns = 32;
constexpr std::uint32_t max_pins = 2;
constexpr std::uint32_t frames = 5 * 60; // five seconds at 60 Hz

// taut never allocates. All memory is ours; here it is static, and its size is known at compile time.
taut::GridStorage grid_memory;
taut::ClothStorage<rows, columns, max_pins> cloth_memory;

// taut.hpp needs no exceptions. For those who like them:
void check(taut_result result)
{
    if (result != TAUT_OK) {
        throw std::runtime_error(std::string(taut::result_name(result)) + ": " + taut::result_message(result));
    }
}

std::vector<char> read(const char *path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw std::runtime_error(std::string("cannot read ") + path);
    }
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::uint64_t state_hash(taut::Cloth &cloth)
{
    std::uint64_t hash = 0;
    check(cloth.state_hash(hash));
    return hash;
}

int drape(const char *path)
{
    // The header that we compiled with must fit the library that we found.
    check(taut::check_version());

    // The file tells how heavy the fabric is, which we need before the cloth is made.
    const std::vector<char> file = read(path);
    taut_field field{};
    check(taut::field_info(file.data(), file.size(), field));

    // The grid: which particles there are and how springs join them. Many cloths may share one.
    taut_grid_def grid_def = taut::grid_def_default();
    grid_def.rows = rows;
    grid_def.columns = columns;
    taut::Grid grid;
    check(grid.create(grid_def, grid_memory));

    // The cloth: how it is stepped, how heavy it is, where it starts. Everything else keeps its default.
    taut_cloth_def def = taut::cloth_def_default(grid);
    def.rate_hz = 60.0f;
    def.substeps = 16;
    def.density_kg_m2 = field.fabric.density_kg_m2;
    def.inertia_radius_m = 0.3f; // stiff near the pins, at no cost in the step
    def.max_pins = max_pins;
    taut::Cloth cloth;
    check(cloth.create(grid, def, cloth_memory));

    // The stiffness of the fabric, then the two top corners.
    check(cloth.load_stiffness(file.data(), file.size()));
    check(cloth.pin(0));
    check(cloth.pin(columns - 1));

    // Half of the way, a snapshot, the other half.
    check(cloth.step_many(frames / 2));
    std::size_t size = 0;
    check(cloth.snapshot_size(size));
    std::vector<unsigned char> snapshot(size);
    check(cloth.snapshot(snapshot.data(), snapshot.size()));
    for (std::uint32_t frame = frames / 2; frame < frames; ++frame) {
        std::uint32_t flags = 0;
        check(cloth.step(&flags)); // one frame: this is the call in the game loop
        if (flags & TAUT_STEP_NON_FINITE) {
            throw std::runtime_error("a frame was taken back");
        }
    }

    // What a renderer reads without a copy: particle (row, column) is number row * row_stride + column.
    taut_position_view view{};
    check(cloth.positions(view));
    const std::size_t corner = (view.rows - 1) * view.row_stride;
    std::printf("lower left corner at %.3f %.3f %.3f m\n", view.x[corner], view.y[corner], view.z[corner]);

    // Or into its vertex buffer, as seen from the camera.
    struct Vertex {
        float position[3];
        float normal[3];
    };
    std::vector<Vertex> vertices(rows * columns);
    check(cloth.copy_positions_f32({0.0, 0.0, 0.0},
                                   taut::attribute(vertices.data(), vertices.size(), &Vertex::position)));
    check(cloth.copy_normals_f32(taut::attribute(vertices.data(), vertices.size(), &Vertex::normal)));
    const Vertex &middle = vertices[rows / 2 * columns + columns / 2];
    std::printf("in the middle it faces %.3f %.3f %.3f\n", middle.normal[0], middle.normal[1], middle.normal[2]);

    taut_strain strain{};
    check(cloth.strain(strain));
    const std::uint64_t hash = state_hash(cloth);
    std::printf("largest stretch %.2f %%\n", 100.0 * strain.largest);
    std::printf("state hash %016llx\n", static_cast<unsigned long long>(hash));

    // Rewind and do the second half again: the same bits, or rollback netcode would drift.
    check(cloth.restore(snapshot.data(), snapshot.size()));
    check(cloth.step_many(frames - frames / 2));
    return state_hash(cloth) == hash ? 0 : 1;
}

} // namespace

int main(int argc, char **argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s FIELD\n", argv[0]);
        return 2;
    }
    try {
        return drape(argv[1]);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
