#include "bench/resident_memory.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "bench/case_setup.h"

namespace ricochet::bench {
namespace {

double held_by_simulation(SimulationSetup setup, const std::vector<Particle>& particles) {
    const std::uint64_t before = resident_memory_bytes();
    setup.particles = particles;
    Simulation simulation(std::move(setup));
    simulation.step();
    return std::max(0.0, static_cast<double>(resident_memory_bytes()) - static_cast<double>(before));
}

}  // namespace

std::uint64_t resident_memory_bytes() {
    (void)::malloc_trim(0);
    std::uint64_t total = 0;
    std::uint64_t resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

MemoryUse measure_memory(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh,
                         const std::vector<Particle>& particles) {
    const auto held = [&](bool with_totals, const std::vector<Particle>& who) {
        SimulationSetup setup = make_setup(c, mesh);
        setup.options.triangle_totals = with_totals;
        return held_by_simulation(std::move(setup), who);
    };
    (void)held(false, {});  // what the first simulation of a process brings for good
    const double mesh_bytes =
        static_cast<double>(sizeof(Vec3) * mesh->vertices.capacity() + sizeof(Triangle) * mesh->triangles.capacity());
    MemoryUse use;
    use.bytes_per_triangle = (mesh_bytes + held(false, {})) / static_cast<double>(mesh->triangles.size());
    use.bytes_per_particle =
        std::max(0.0, held(true, particles) - held(true, {})) / static_cast<double>(particles.size());
    return use;
}

}  // namespace ricochet::bench
