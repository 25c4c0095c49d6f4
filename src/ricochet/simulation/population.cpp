// Changes of the number of particles: by emitters, by particles that spawn others, and by the user.
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ricochet/collision/overlap.h"
#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/active_mover.h"
#include "ricochet/simulation/clear_segment.h"
#include "ricochet/simulation/impl.h"
#include "ricochet/simulation/memory_estimate.h"
#include "ricochet/simulation/retirement.h"
#include "ricochet/simulation/validation.h"

namespace ricochet {

void Simulation::Impl::emit_particles(const TimeSpan& step) {
    std::optional<SpawnOccupancy> among;
    const BirthTests tests = birth_tests(among, step);
    const BirthLimits limits{step.end, room_below(options.most_particles, share.living(store.size())),
                             room_below(most_that_fit, store.size()), store.next_id()};
    StepBirths births(emitters, limits, tests, share);
    if (!births.make()) refuse_to_grow(store.size(), particle_bytes);
    if (share.is_first()) {
        recorder.statistics().births_refused_by_overlap += births.refused_by_overlap();
        recorder.statistics().births_refused_by_population += births.refused_by_population();
    }
    reserve(births.here().size());
    add_all(births.here());
    store.set_next_id(limits.first_id + births.count());
    share.add_births(births.count());
    if (births.count() > 0) bind_modules();
}

/// Returns the children on this rank, or nothing if no rank has any.
std::optional<ParticleRange> Simulation::Impl::spawn_children(const TimeSpan& step) {
    if (!offspring) return std::nullopt;
    const std::size_t first = store.size();
    const std::uint64_t first_id = store.next_id();
    OffspringCounts counts;
    std::vector<Child> children =
        offspring->after_move(world, store.particles(), step.begin, step.end, recorder.batch_contacts(), share, counts);
    std::vector<Particle*> born;
    for (Child& child : children) {
        child.particle.id = first_id + child.number;
        born.push_back(&child.particle);
    }
    add_all(born, [&](std::size_t k) {
        if (children[k].cloud) clouds->join(store.size() - 1, *children[k].cloud);
        if (response->keeps_sides()) inherit_sides(store.size() - 1, children[k]);
    });
    store.set_next_id(first_id + counts.children);
    share.add_births(counts.children);
    if (share.is_first()) {
        SimulationStatistics& statistics = recorder.statistics();
        statistics.children += counts.children - counts.refused_by_overlap;
        statistics.births_refused_by_overlap += counts.refused_by_overlap;
        statistics.births_refused_by_depth += counts.refused_by_depth;
        statistics.births_refused_by_population += counts.refused_by_population;
    }
    if (counts.children > 0) bind_modules();
    return counts.children > 0 ? std::optional(ParticleRange{first, store.size(), true}) : std::nullopt;
}

/// A child belongs to its parent's sides of surfaces, whatever sides it begins on.
void Simulation::Impl::inherit_sides(std::size_t i, const Child& child) {
    if (!is_finite(particles().position[i])) return;
    std::copy(child.parent_sides.begin(), child.parent_sides.end(), store.sides_of(i).begin());
    response->inherit_sides({child.parent_start, particles().position[i], particles().radius[i], child.goes_on},
                            store.sides_of(i));
}

void Simulation::Impl::reserve(std::size_t more) {
    store.reserve(more);
    schedule.reserve(more);
    free_flights.reserve(more);
}

/// Returns the tests of an emitter's births: a sphere must overlap no surface, and no other sphere that it can meet. A
/// test is empty if nothing can be overlapped.
BirthTests Simulation::Impl::birth_tests(std::optional<SpawnOccupancy>& room, const TimeSpan& step) const {
    BirthTests tests;
    if (pairs || world.surface_count() > 0) {
        tests.alone = [this](const Particle& particle) {
            stop.poll();
            return !overlap_of(particle);
        };
    }
    if (!pairs) return tests;
    tests.among = [this, &room, step](const Particle& particle) {
        if (!(particle.radius > 0.0) || !is_finite(particle.position)) return true;
        if (!room) room = spawn_occupancy(step);
        const ForceInput input{particle.position, particle.velocity, particle.mass, particle.radius,
                               particle.birth_time};
        const FlyingBall ball{particle.birth_time, particle.radius, particle.position, particle.velocity,
                              response->rules().forces.acceleration(input)};
        if (!room->has_room(ball)) return false;
        room->add(ball);
        return true;
    };
    return tests;
}

/// Returns the occupancy of the spheres present, which continue their motion from the start of the step.
SpawnOccupancy Simulation::Impl::spawn_occupancy(const TimeSpan& step) const {
    SpawnOccupancy room(step.end);
    for (std::size_t i = 0; i < store.size(); ++i) {
        const double radius = particles().radius[i];
        if (!(radius > 0.0) || particles().frozen[i] != 0) continue;
        const bool stays = particles().pinned[i] != 0 || particles().resting[i] != 0;
        const Vec3 pull = stays ? Vec3{} : response->rules().forces.acceleration(store.force_input(i, step.begin));
        room.add({step.begin, radius, particles().position[i], stays ? Vec3{} : particles().velocity[i], pull});
    }
    return room;
}

SpawnTest Simulation::Impl::spawn_test() const {
    return [this](const Particle& parent, const Particle& child) {
        const Vec3 position = flush_tiny(child.position);
        return is_clear_at(world, bodies.get(), child.birth_time, parent.position, position) && !overlap_of(child);
    };
}

const CollisionWorld& Simulation::Impl::world_of(std::size_t collider) const {
    const bool is_framed = bodies && !bodies->deforming().is_mesh(collider);
    return is_framed ? bodies->world(bodies->body_of_collider(collider)) : world;
}

// Changes by users between two steps.

std::uint64_t Simulation::add_particle(Particle particle) { return add_particles(std::span(&particle, 1)).front(); }

std::vector<std::uint64_t> Simulation::add_particles(std::span<const Particle> particles) {
    impl().require_between_steps();
    impl().return_point.invalidate();
    impl().share.require_alone("add_particles");
    for (std::size_t k = 0; k < particles.size(); ++k) {
        const auto columns = impl().particles().attributes.columns();
        validate(particles[k], k, columns.size());
        if (options().particle_contacts) validate_sphere(particles[k], k, *options().particle_contacts, columns);
    }
    const std::uint64_t most = options().most_particles;
    const std::uint64_t room = room_below(most, impl().store.size());
    if (particles.size() > room) {
        throw InputError(fmt::format("add_particles: found {} particles, expected at most {}: most_particles is {}",
                                     particles.size(), room, most));
    }
    if (particles.size() > room_below(impl().most_that_fit, impl().store.size())) {
        require_memory(impl().particle_bytes * static_cast<double>(particles.size()),
                       fmt::format("add_particles: {} particles", particles.size()));
    }
    impl().reserve(particles.size());
    std::vector<std::uint64_t> ids;
    for (Particle particle : particles) {
        particle.birth_time = time();
        particle.origin = Origin{};
        impl().add(std::move(particle));
        ids.push_back(impl().particles().id.back());
    }
    impl().bind_modules();
    return ids;
}

Particles Simulation::release_particles() {
    Particles released = impl().particles();
    std::swap(released, impl().store.particles());
    return released;
}

bool Simulation::remove_particle(std::uint64_t id) { return remove_particles(std::span(&id, 1)) == 1; }

std::size_t Simulation::remove_particles(std::span<const std::uint64_t> ids) {
    impl().require_between_steps();
    impl().return_point.invalidate();
    impl().share.require_alone("remove_particles");
    std::vector<std::uint64_t> sorted(ids.begin(), ids.end());
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint8_t> keep(impl().store.size(), 1);
    std::size_t removed = 0;
    SimulationStatistics& statistics = impl().recorder.statistics();
    for (std::size_t i = 0; i < keep.size(); ++i) {
        if (!std::binary_search(sorted.begin(), sorted.end(), impl().particles().id[i])) continue;
        keep[i] = 0;
        ++removed;
        statistics.lost_impulses += impl().mover.add_weight(i, time(), 1.0);
        statistics.resting -= impl().particles().resting[i];
        statistics.asleep -= impl().store.is_asleep(i) ? 1 : 0;
    }
    statistics.removed += removed;
    if (removed > 0) impl().compact(keep);
    return removed;
}

// Free flights and sleep were decided for the forces until now.
void Simulation::set_forces(std::vector<std::unique_ptr<Force>> forces) {
    impl().require_between_steps();
    impl().return_point.invalidate();
    if (options().flow != nullptr && !forces.empty()) {
        throw InputError(
            fmt::format("set_forces: found {} forces, expected none: a flow carries the particles", forces.size()));
    }
    ForceField field(std::move(forces));  // refuses null pointers before anything changes
    if (field.needs_temperature() && !particles().attributes.find(kTemperatureAttribute)) {
        throw InputError(
            "set_forces: found thermal buoyancy, expected the attribute \"temperature\" to be declared for it");
    }
    impl().free_flights.end_deferring();
    SimulationStatistics& statistics = impl().recorder.statistics();
    for (std::size_t i = 0; i < impl().store.size(); ++i) {
        statistics.lost_impulses += impl().mover.add_weight(i, time(), 1.0);
        impl().store.wake(i);
    }
    statistics.asleep = 0;
    impl().modules.each([&](Module& module) { module.wake_all(time()); });
    impl().forces = std::move(field);
    impl().store.set_may_sleep(impl().acceleration.sleeping && impl().forces.is_steady() &&
                               !(impl().bodies && options().verify));
    impl().forget_queries();
}

void Simulation::on_contact(ContactCallback callback) {
    impl().require_between_steps();
    impl().has_new_callback = impl().is_reporting;
    impl().callback = std::move(callback);
    impl().recorder.show_contacts(options().record_contacts || impl().callback);
}

void Simulation::Impl::require_between_steps() const {
    if (!inside_step) return;
    if (!is_stepping) refuse_after_error();
    throw RunError("particles, forces and callbacks of a simulation can be changed between its steps only");
}

void Simulation::Impl::report_contacts() {
    if (!callback || recorder.contact_records().empty()) return;
    // The callback can replace itself, and must not be destroyed by that while it runs.
    ContactCallback running = std::exchange(callback, {});
    is_reporting = true;
    has_new_callback = false;
    const auto end = [&] {
        is_reporting = false;
        if (!has_new_callback) callback = std::move(running);
    };
    try {
        running(recorder.contact_records());
    } catch (...) {
        end();
        throw;
    }
    end();
}

// A free flight ends before the particle's life.
RemovalReason Retirement::removal_reason(std::size_t i, double time) const {
    const RemovalReason by_bounds = is_outside(i) ? RemovalReason::out_of_bounds : RemovalReason::none;
    if (schedule_.is_in_free_flight(i)) return by_bounds;
    const Particles& particles = store_.particles();
    if (particles.absorbed[i] == kShattered) return RemovalReason::shattered;
    if (particles.absorbed[i] != 0) return RemovalReason::absorbed;
    if (particles.birth_time[i] + particles.lifetime[i] <= time) return RemovalReason::expired;
    return by_bounds;
}

EndOfStepCounts Retirement::count(double time) const {
    std::vector<EndOfStepCounts> blocks(blocks_of(store_.size()));
    parallel_for_blocks(store_.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        blocks[block] = count_block(begin, end, time);
    });
    EndOfStepCounts all;
    for (const EndOfStepCounts& block : blocks) {
        all.leaving += block.leaving;
        all.resting += block.resting;
        all.held += block.held;
    }
    return all;
}

EndOfStepCounts Retirement::count_block(std::size_t begin, std::size_t end, double time) const {
    const Particles& particles = store_.particles();
    EndOfStepCounts counts;
    for (std::size_t i = begin; bounds_ && i < end; ++i) {
        counts.leaving += schedule_.is_in_free_flight(i) && is_outside(i) ? 1 : 0;
    }
    schedule_.visit_all_but_free_flights(begin, end, [&](std::size_t i) {
        const bool leaves = removal_reason(i, time) != RemovalReason::none;
        counts.leaving += leaves ? 1 : 0;
        counts.resting += leaves ? 0 : particles.resting[i];
        counts.held += leaves ? 0 : particles.held[i];
    });
    return counts;
}

}  // namespace ricochet
