/// \file
/// Time to read a mesh of 100 thousand triangles from memory, by format.

#include "ricochet/geometry/mesh/mesh_reader.h"

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "generators/build_near.h"
#include "generators/rock.h"
#include "run/mesh_writer.h"

namespace ricochet {
namespace {

constexpr std::size_t kTriangles = 100'000;

/// Returns the bytes of the mesh's file.
std::string bytes_of(const TriangleMesh& mesh, const std::string& ending) {
    const auto path =
        std::filesystem::temp_directory_path() / ("ricochet-mesh-reader-bench-" + std::to_string(::getpid()) + ending);
    write_mesh(mesh, path);
    std::ifstream stream(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    std::filesystem::remove(path);
    return bytes;
}

void read(benchmark::State& state, const std::string& ending) {
    static const TriangleMesh mesh =
        meshes::build_near(kTriangles, 0.25, [](double edge) { return meshes::make_cavity({}, edge); });
    const std::string bytes = bytes_of(mesh, ending);
    for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(read_mesh("mesh" + ending, bytes));
    state.SetBytesProcessed(static_cast<std::int64_t>(bytes.size()) * state.iterations());
    state.SetItemsProcessed(static_cast<std::int64_t>(mesh.triangles.size()) * state.iterations());
}

void read_obj(benchmark::State& state) { read(state, ".obj"); }
void read_ply(benchmark::State& state) { read(state, ".ply"); }
void read_stl(benchmark::State& state) { read(state, ".stl"); }
void read_off(benchmark::State& state) { read(state, ".off"); }
BENCHMARK(read_obj)->Unit(benchmark::kMillisecond);
BENCHMARK(read_ply)->Unit(benchmark::kMillisecond);
BENCHMARK(read_stl)->Unit(benchmark::kMillisecond);
BENCHMARK(read_off)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ricochet
