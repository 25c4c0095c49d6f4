// How particles come into a simulation: from emitters, and spawned by particles.
#include <algorithm>
#include <iterator>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {

// Births of all emitters are merged by (birth time, emitter), which fixes the ids for any time step.
void Simulation::Impl::emit_particles(const TimeSpan& step) {
    std::vector<Particle> born;
    for (Emitter& emitter : emitters) {
        std::vector<Particle> births = emitter.births(step.begin, step.end);
        born.insert(born.end(), std::make_move_iterator(births.begin()), std::make_move_iterator(births.end()));
    }
    std::stable_sort(born.begin(), born.end(),
                     [](const Particle& a, const Particle& b) { return a.birth_time < b.birth_time; });
    const std::uint64_t room = options.most_particles - std::min<std::uint64_t>(options.most_particles, store.size());
    const std::size_t allowed = std::min<std::uint64_t>(born.size(), room);
    recorder.statistics().births_refused_by_population += born.size() - allowed;
    reserve(allowed);
    for (std::size_t k = 0; k < allowed; ++k) add(std::move(born[k]));
    if (allowed > 0 && coupled.is_active()) coupled.bind(particles());
    if (check) check->watch_spawned(particles());
}

/// Returns the children.
ParticleRange Simulation::Impl::spawn_children(const TimeSpan& step) {
    const ParticleRange none{store.size(), store.size()};
    if (!offspring) return none;
    OffspringCounts counts;
    for (Particle& child :
         offspring->after_move(world, store.particles(), step.begin, step.end, recorder.batch_contacts(), counts)) {
        add(std::move(child));
    }
    SimulationStatistics& statistics = recorder.statistics();
    statistics.children += counts.children;
    statistics.births_refused_by_depth += counts.refused_by_depth;
    statistics.births_refused_by_population += counts.refused_by_population;
    const ParticleRange children{none.begin, store.size()};
    if (!children.empty() && coupled.is_active()) coupled.bind(particles());
    if (check) check->watch_spawned(particles());
    return children;
}

void Simulation::Impl::reserve(std::size_t more) {
    store.reserve(more);
    schedule.reserve(more);
    free_flights.reserve(more);
}

void Simulation::Impl::add(Particle&& particle) {
    world.prepare_radius(particle.radius);
    if (starts_in_overlap(particle)) ++recorder.statistics().started_inside;
    schedule.append(particle.pinned);
    free_flights.append();
    store.append(std::move(particle));
    const std::size_t i = store.size() - 1;
    if (response->keeps_sides() && is_finite(particles().position[i])) {
        response->first_sides(particles().position[i], store.sides_of(i));
    }
    ++recorder.statistics().emitted;
}

bool Simulation::Impl::starts_in_overlap(const Particle& particle) const {
    const Vec3 position = flush_tiny(particle.position);
    if (!is_finite(position) || max_abs(position) > kLargestCoordinate) return false;
    ContactScratch scratch;
    const SurfaceGeometry geometry(world, scratch.plane_cache);
    const Path path = line_path(position, Vec3{}, 0.0);
    return find_first_contact(geometry, {path, particle.radius}, scratch).near.starts_in_overlap();
}

}  // namespace ricochet
