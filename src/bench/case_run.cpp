#include "bench/case_run.h"

#include <fmt/format.h>
#include <malloc.h>
#include <algorithm>
#include <cstring>
#include <utility>

#include "bench/case_run.h"
#include "bench/case_setup.h"
#include "bench/timing.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"

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

namespace {

std::vector<Flight> flights_of(const Particles& particles) {
    std::vector<Flight> flights;
    flights.reserve(particles.size());
    for (const std::uint32_t i : particles.order_by_id()) {
        flights.push_back({particles.position[i], particles.velocity[i]});
    }
    return flights;
}

/// True before the steps whose stretches the references get.
bool is_snapshot(std::uint64_t step, const Case& c) {
    const std::uint64_t snapshots = std::clamp<std::uint64_t>(kReferenceFlights / c.particles, 1, c.steps);
    return step == 0 || step * snapshots / c.steps != (step - 1) * snapshots / c.steps;
}

}  // namespace

CaseRun::CaseRun(const Case& c, std::shared_ptr<const TriangleMesh> mesh)
    : case_(c), mesh_(std::move(mesh)), particles_(make_particles(c, *mesh_)) {}

Simulation CaseRun::make_simulation() const {
    SimulationSetup setup = make_setup(case_, mesh_);
    setup.particles = particles_;
    return Simulation(std::move(setup));
}

bool CaseRun::scout(const Announce& announce, std::vector<std::vector<Flight>>& states) {
    Simulation simulation = make_simulation();
    const auto keep = [&](std::span<const std::byte> bytes) {
        start_.insert(start_.end(), bytes.begin(), bytes.end());
    };
    if (case_.warm_up == 0) simulation.save(keep);
    for (std::uint64_t step = 1; step <= case_.warm_up; ++step) {
        if (!announce("warm-up", step)) return false;
        if (step == case_.warm_up) simulation.save(keep);
        simulation.step();
    }
    const SimulationStatistics before = simulation.statistics();
    for (std::uint64_t step = 0; step < case_.steps; ++step) {
        if (!announce("first run", step + 1)) return false;
        if (is_snapshot(step, case_)) states.push_back(flights_of(simulation.particles()));
        simulation.step();
    }
    course_.particle_steps = simulation.statistics().particle_steps - before.particle_steps;
    course_.contacts = simulation.statistics().contacts - before.contacts;
    course_.state_hash = simulation.state_hash();
    return true;
}

bool CaseRun::prepare(const Announce& announce) {
    if (!announce("memory", 0)) return false;
    memory_ = measure_memory(case_, mesh_, particles_);
    std::vector<std::vector<Flight>> states;
    if (!scout(announce, states)) return false;
    if (!announce("references", 0)) return false;
    reference_.emplace(*mesh_, states, NativeRays::BounceRules{case_.time_step, case_.restitution});
    // Other responses let particles into the wall, and the references would begin there.
    const std::optional<Vec3> heart = heart_of(case_.ground);
    if (heart && case_.response == ResponseKind::exact) reference_->count_leaks(*mesh_, *heart);
    return true;
}

bool CaseRun::time_simulation(CaseTimes& times, const Announce& announce) {
    Simulation simulation = make_simulation();
    std::size_t place = 0;
    simulation.restore([&](std::span<std::byte> bytes) {
        if (bytes.size() > start_.size() - place) throw RunError("the benchmark's saved state is too short");
        std::memcpy(bytes.data(), start_.data() + place, bytes.size());
        place += bytes.size();
    });
    if (!announce("simulation", 1)) return false;
    if (case_.warm_up > 0) simulation.step();  // a simulation just restored searches for every particle
    bool goes_on = true;
    const double seconds = time_of([&] {
        simulation.advance(case_.steps, [&] {
            goes_on = announce("simulation", simulation.step_index() - case_.warm_up);
            return goes_on;
        });
    });
    if (!goes_on) return false;
    if (simulation.state_hash() != course_.state_hash) {
        throw RunError(
            fmt::format("{} of suite {}: a repeat with {} threads has ended in another state than the first run",
                        case_.name, case_.suite, thread_count()));
    }
    times.simulation.push_back(seconds);
    return true;
}

bool CaseRun::time(CaseTimes& times, const Announce& announce) {
    if (!announce("collision structures", 0) || !time_simulation(times, announce)) return false;
    if (!announce("raw rays", 0)) return false;
    times.raw.push_back(time_of([&] { reference_->trace(); }));
    if (!announce("raw rays in spatial order", 0)) return false;
    times.sorted.push_back(time_of([&] { reference_->trace_sorted(); }));
    if (!announce("native bounces", 0)) return false;
    times.bounces.push_back(time_of([&] { reference_->bounce(); }));
    return true;
}

}  // namespace ricochet::bench
