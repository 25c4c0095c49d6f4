// Changes by users between two steps.
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/simulation/impl.h"
#include "ricochet/simulation/memory_estimate.h"
#include "ricochet/simulation/validation.h"

namespace ricochet {

std::uint64_t Simulation::add_particle(Particle particle) { return add_particles(std::span(&particle, 1)).front(); }

std::vector<std::uint64_t> Simulation::add_particles(std::span<const Particle> particles) {
    impl().control.begin_change();
    impl().share.require_alone("add_particles");
    for (std::size_t k = 0; k < particles.size(); ++k) {
        const auto columns = impl().particles().attributes.columns();
        validate(particles[k], k, columns.size());
        if (options().particle_contacts) validate_sphere(particles[k], k, *options().particle_contacts, columns);
    }
    Population& population = impl().population;
    const std::uint64_t most = options().most_particles;
    const std::uint64_t room = room_below(most, population.size());
    if (particles.size() > room) {
        throw InputError(fmt::format("add_particles: found {} particles, expected at most {}: most_particles is {}",
                                     particles.size(), room, most));
    }
    if (particles.size() > population.memory().room(population.size())) {
        require_memory(population.memory().bytes_each() * static_cast<double>(particles.size()),
                       fmt::format("add_particles: {} particles", particles.size()));
    }
    population.reserve(particles.size());
    std::vector<std::uint64_t> ids;
    for (Particle particle : particles) {
        particle.birth_time = time();
        particle.origin = Origin{};
        particle.id = population.store().next_id();
        ids.push_back(particle.id);
        Particle* const added = &particle;
        population.add({&added, 1});
    }
    population.bind();
    return ids;
}

Particles Simulation::release_particles() {
    Particles released = impl().particles();
    std::swap(released, impl().population.store().particles());
    return released;
}

bool Simulation::remove_particle(std::uint64_t id) { return remove_particles(std::span(&id, 1)) == 1; }

std::size_t Simulation::remove_particles(std::span<const std::uint64_t> ids) {
    impl().control.begin_change();
    impl().share.require_alone("remove_particles");
    std::vector<std::uint64_t> sorted(ids.begin(), ids.end());
    std::ranges::sort(sorted);
    Population& population = impl().population;
    std::vector<std::uint8_t> keep(population.size(), 1);
    std::size_t removed = 0;
    SimulationStatistics& statistics = impl().recorder.statistics();
    for (std::size_t i = 0; i < keep.size(); ++i) {
        if (!std::ranges::binary_search(sorted, impl().particles().id[i])) continue;
        keep[i] = 0;
        ++removed;
        statistics.lost_impulses += impl().mover.add_weight(i, time(), 1.0);
        statistics.resting -= impl().particles().resting[i];
        statistics.asleep -= population.store().is_asleep(i) ? 1 : 0;
    }
    statistics.removed += removed;
    if (removed > 0) population.compact(keep);
    return removed;
}

// Ends free flights and wakes sleepers, because both were decided with the previous forces.
void Simulation::set_forces(std::vector<std::unique_ptr<Force>> forces) {
    impl().control.begin_change();
    if (options().flow != nullptr && !forces.empty()) {
        throw InputError(
            fmt::format("set_forces: found {} forces, expected none: a flow carries the particles", forces.size()));
    }
    ForceField field(std::move(forces));  // throws for a null pointer, before anything changes
    if (field.needs_temperature() && !particles().attributes.find(kTemperatureAttribute)) {
        throw InputError(
            "set_forces: found thermal buoyancy, expected the attribute \"temperature\" to be declared for it");
    }
    Population& population = impl().population;
    population.flights().end_deferring();
    SimulationStatistics& statistics = impl().recorder.statistics();
    for (std::size_t i = 0; i < population.size(); ++i) {
        statistics.lost_impulses += impl().mover.add_weight(i, time(), 1.0);
        population.store().wake(i);
    }
    statistics.asleep = 0;
    impl().modules.each([&](Module& module) { module.wake_all(time()); });
    impl().forces = std::move(field);
    population.allow_sleep();
    population.forget_queries();
}

void Simulation::on_contact(ContactCallback callback) {
    impl().control.require_between_steps();
    impl().reporter.set(std::move(callback));
    impl().recorder.show_contacts(options().record_contacts || impl().reporter.is_set());
}

}  // namespace ricochet
