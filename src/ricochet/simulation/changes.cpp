// What users change between two steps.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/simulation/impl.h"
#include "ricochet/simulation/validation.h"

namespace ricochet {

std::uint64_t Simulation::add_particle(Particle particle) { return add_particles(std::span(&particle, 1)).front(); }

std::vector<std::uint64_t> Simulation::add_particles(std::span<const Particle> particles) {
    impl_->require_between_steps();
    for (std::size_t k = 0; k < particles.size(); ++k) {
        validate(particles[k], k, impl_->particles().attributes.columns().size());
    }
    const std::uint64_t most = options().most_particles;
    const std::uint64_t room = most - std::min<std::uint64_t>(most, impl_->store.size());
    if (particles.size() > room) {
        throw InputError(fmt::format("add_particles: found {} particles, expected at most {}: most_particles is {}",
                                     particles.size(), room, most));
    }
    impl_->reserve(particles.size());
    std::vector<std::uint64_t> ids;
    for (Particle particle : particles) {
        particle.birth_time = time();
        particle.origin = Origin{};
        impl_->add(std::move(particle));
        ids.push_back(impl_->particles().id.back());
    }
    if (impl_->coupled.is_active()) impl_->coupled.bind(impl_->particles());
    if (impl_->check) impl_->check->watch_spawned(impl_->particles());
    return ids;
}

bool Simulation::remove_particle(std::uint64_t id) { return remove_particles(std::span(&id, 1)) == 1; }

std::size_t Simulation::remove_particles(std::span<const std::uint64_t> ids) {
    impl_->require_between_steps();
    std::vector<std::uint64_t> sorted(ids.begin(), ids.end());
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint8_t> keep(impl_->store.size(), 1);
    std::size_t removed = 0;
    SimulationStatistics& statistics = impl_->recorder.statistics();
    for (std::size_t i = 0; i < keep.size(); ++i) {
        if (!std::binary_search(sorted.begin(), sorted.end(), impl_->particles().id[i])) continue;
        keep[i] = 0;
        ++removed;
        statistics.lost_impulses += impl_->mover.add_weight(i, time(), 1.0);
        statistics.resting -= impl_->particles().resting[i];
        statistics.asleep -= impl_->store.is_asleep(i) ? 1 : 0;
    }
    statistics.removed += removed;
    if (removed > 0) impl_->compact(keep);
    return removed;
}

// What was known of free flights, and what has let particles sleep, was known for the forces until now.
void Simulation::set_forces(std::vector<std::unique_ptr<Force>> forces) {
    impl_->require_between_steps();
    validate(std::span(forces));
    if (options().flow != nullptr && !forces.empty()) {
        throw InputError(
            fmt::format("set_forces: found {} forces, expected none: a flow carries the particles", forces.size()));
    }
    impl_->free_flights.end_deferring();
    SimulationStatistics& statistics = impl_->recorder.statistics();
    for (std::size_t i = 0; i < impl_->store.size(); ++i) {
        statistics.lost_impulses += impl_->mover.add_weight(i, time(), 1.0);
        impl_->store.wake(i);
    }
    statistics.asleep = 0;
    impl_->forces = ForceField(std::move(forces));
    impl_->store.set_may_sleep(impl_->acceleration.sleeping && impl_->forces.is_steady());
    impl_->forget_queries();
}

void Simulation::on_contact(ContactCallback callback) {
    impl_->require_between_steps();
    impl_->callback = std::move(callback);
    impl_->recorder.show_contacts(options().record_contacts || impl_->callback);
}

void Simulation::Impl::require_between_steps() const {
    if (!inside_step) return;
    throw RunError("particles, forces and callbacks of a simulation can be changed between its steps only");
}

void Simulation::Impl::report_contacts() {
    if (!callback || recorder.contact_records().empty()) return;
    is_reporting = true;
    try {
        callback(recorder.contact_records());
    } catch (...) {
        is_reporting = false;
        throw;
    }
    is_reporting = false;
}

}  // namespace ricochet
