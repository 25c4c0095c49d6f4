#include "bench/memory_use.h"

#include <malloc.h>

#include <algorithm>
#include <utility>

#include "bench/case_setup.h"

namespace ricochet::bench {
namespace {

double held_by_simulation(SimulationSetup setup, const std::vector<Particle>& particles) {
    const auto before = static_cast<double>(allocated_bytes());
    setup.particles = particles;
    Simulation simulation(std::move(setup));
    simulation.step();
    return static_cast<double>(allocated_bytes()) - before;
}

}  // namespace

std::uint64_t allocated_bytes() {
    const auto info = ::mallinfo2();
    return info.uordblks + info.hblkhd;
}

void return_freed_memory() { (void)::malloc_trim(0); }

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
