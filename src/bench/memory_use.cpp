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
    const auto held = [&](const std::vector<Particle>& who) { return held_by_simulation(make_setup(c, mesh), who); };
    (void)held({});  // what the first simulation of a process brings for good
    const double mesh_bytes =
        static_cast<double>(sizeof(Vec3) * mesh->vertices.capacity() + sizeof(Triangle) * mesh->triangles.capacity());
    MemoryUse use;
    // Counted, not asked of the allocator: the ray library maps large blocks past it.
    const CollisionWorld world(make_setup(c, mesh).colliders);
    use.bytes_per_triangle =
        (mesh_bytes + static_cast<double>(world.memory_bytes())) / static_cast<double>(mesh->triangles.size());
    use.bytes_per_particle = std::max(0.0, held(particles) - held({})) / static_cast<double>(particles.size());
    return use;
}

}  // namespace ricochet::bench
