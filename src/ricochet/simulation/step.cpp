// One step of the simulation, stage by stage.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {
namespace {

/// Sets a flag for the lifetime of the object.
class ScopedFlag {
public:
    explicit ScopedFlag(bool& flag) : flag_(flag) { flag_ = true; }
    ~ScopedFlag() { flag_ = false; }
    ScopedFlag(const ScopedFlag&) = delete;
    ScopedFlag& operator=(const ScopedFlag&) = delete;

private:
    bool& flag_;
};

/// Counts of removed particles in one block, by reason.
class LeaverCounts {
public:
    /// Counts a removed particle. `lost` is the number of impulses of its weight that were too large for the totals.
    void add(RemovalReason departure, std::uint64_t lost) {
        ++counts_[static_cast<std::size_t>(departure)];
        lost_impulses_ += lost;
    }
    void add_to(SimulationStatistics& statistics) const {
        const auto of = [this](RemovalReason departure) { return counts_[static_cast<std::size_t>(departure)]; };
        statistics.expired += of(RemovalReason::expired);
        statistics.absorbed += of(RemovalReason::absorbed);
        statistics.shattered += of(RemovalReason::shattered);
        statistics.out_of_bounds += of(RemovalReason::out_of_bounds);
        statistics.lost_impulses += lost_impulses_;
    }

private:
    std::array<std::uint64_t, 5> counts_{};  // by departure
    std::uint64_t lost_impulses_ = 0;
};

}  // namespace

void Simulation::step() {
    impl().return_point.invalidate();
    if (!finished()) impl().step();
}

void Simulation::advance(std::uint64_t count, const std::function<bool()>& go_on,
                         const std::function<bool()>& goes_on_within) {
    if (count > 1 && impl().may_defer()) impl().free_flights.begin_deferring();
    // Ranks that share a run stop together, between steps.
    const bool may_stop = goes_on_within && impl().share.is_alone();
    if (!may_stop) impl().return_point.invalidate();
    try {
        bool goes_on = true;
        for (std::uint64_t k = 0; k < count && goes_on && !finished(); ++k) {
            may_stop ? impl().step_unless_stopped(goes_on_within) : impl().step();
            goes_on = !go_on || go_on();
        }
    } catch (...) {
        impl().free_flights.end_deferring();
        throw;
    }
    impl().free_flights.end_deferring();
}

bool Simulation::Impl::may_defer() const {
    return acceleration.look_ahead && acceleration.deferred_steps && !bounds && modules.allow_deferred_steps();
}

// Moves all particles over the step. Newly spawned children are moved from their birth time to the end of the step.
// Children can spawn children, so this repeats until a generation spawns none.
void Simulation::Impl::step() {
    const TimeSpan step = begin_step();
    const ScopedFlag stepping(is_stepping);
    stop.poll();
    balance_ranks();
    emit_particles(step);
    std::optional<ParticleRange> generation = ParticleRange{0, store.size()};
    do {
        move_generation(*generation, step);
        generation = spawn_children(step);
    } while (generation);
    retire_particles(step.end);
    modules.each([&](Module& module) { module.verify(step); });
    end_step();
    report_contacts();
}

void Simulation::Impl::refuse_after_error() {
    throw RunError(
        "the last step or restore() of this simulation has ended with an error; make it anew or restore a saved state");
}

// Begins a step. Throws after an error inside an earlier step, because particles in free flight may then be a step
// ahead of the others.
TimeSpan Simulation::Impl::begin_step() {
    if (is_reporting) throw RunError("a contact callback must not step its simulation");
    if (inside_step) refuse_after_error();
    inside_step = true;
    recorder.begin_step();
    birth_records.clear();
    schedule.begin_step(recorder.statistics().steps);
    const TimeSpan step = clock.span_of(recorder.statistics().steps);
    modules.each([&](Module& module) { module.begin_step(step); });
    if (bodies) bodies->begin_step(step.begin, step.end);
    return step;
}

// Moves a spawn generation over the step, in one or more substeps. Each substep is recorded separately, so that the
// events of a particle stay in the order of time.
void Simulation::Impl::move_generation(const ParticleRange& generation, const TimeSpan& step) {
    recorder.begin_generation();
    modules.each([&](Module& module) { module.before_generation(generation, step); });
    for (double now = step.begin; now < step.end;) {
        stop.poll();
        const TimeSpan part = modules.plan(generation, {now, step.end});
        std::vector<BlockRecord> blocks;
        wake_sleepers(part);
        move_substep(generation, part, blocks);
        stop_runaways(blocks, step.end);
        record_part(generation, blocks);
        now = part.end;
    }
    modules.each([&](Module& module) { module.after_generation(generation, step); });
    recorder.end_generation(generation.size());
}

void Simulation::Impl::record_part(const ParticleRange& generation, const std::vector<BlockRecord>& blocks) {
    recorder.record(blocks);
    if (!share.is_alone()) share.note(blocks, particles().id);
    std::vector<ColliderLoad> loads;
    for (const BlockRecord& block : blocks) loads.insert(loads.end(), block.loads.begin(), block.loads.end());
    modules.each([&](Module& module) { module.record(generation, blocks, loads); });
    recorder.add_loads(loads, *colliders);
}

/// Wakes sleeping particles near moving colliders. Other sleeping particles stay asleep, because their supports are at
/// rest.
void Simulation::Impl::wake_sleepers(const TimeSpan& part) {
    if (!bodies || !store.may_sleep()) return;
    for (std::size_t i = 0; i < store.size(); ++i) {
        if (!store.is_asleep(i) || store.is_fixed(i) || !schedule.is_left_alone(i)) continue;
        const Vec3& position = particles().position[i];
        const double radius = particles().radius[i];
        const double reach = radius + kWakingReach * (radius + max_abs(position)) + kSmallestContactOffset;
        const Vec3 by{reach, reach, reach};
        if (bodies->all_stay_out({position - by, position + by})) continue;
        recorder.statistics().lost_impulses += mover.add_weight(i, part.begin, 1.0);
        schedule.forget(i);
        free_flights.wake(i);
    }
}

void Simulation::Impl::move_substep(const ParticleRange& generation, const TimeSpan& part,
                                    std::vector<BlockRecord>& blocks) {
    modules.each([&](Module& module) { module.before_substep(generation, part); });
    if (options.response == ResponseKind::rollback && options.rollback.global) {
        mover.move_as_system(generation, part, blocks);
    } else {
        ActiveSet active = free_flights.advance(generation, part, blocks);
        order_active_set(active);
        mover.move(active, part, blocks);
        if (!share.is_alone()) balancer.note(work_of(generation, active.size(), blocks));
    }
    modules.each([&](Module& module) { module.after_substep(generation, part, blocks); });
}

WorkCounts Simulation::Impl::work_of(const ParticleRange& generation, std::size_t queried,
                                     const std::vector<BlockRecord>& blocks) const {
    WorkCounts counts;
    counts.queried = queried;
    counts.idle = schedule.count_left_alone(generation.begin, generation.end);
    counts.flying = generation.size() - std::min(generation.size(), counts.queried + counts.idle);
    for (const BlockRecord& block : blocks) counts.contacts += block.counts.contacts;
    return counts;
}

// Divides and sorts the active set for speed. Only the sums of penetration depths depend on the blocks of the active
// set, and the response `exact` has no penetrations. Other responses keep the blocks of all particles.
void Simulation::Impl::order_active_set(ActiveSet& active) const {
    if (options.response != ResponseKind::exact) return;
    active.cut_evenly();
    if (acceleration.spatial_order && active.is_worth_sorting(store.size(), world.triangles().size())) {
        active.sort_by_position(particles().position, world.triangle_bounds());
    }
}

void Simulation::Impl::retire_particles(double time) {
    modules.each([&](Module& module) { module.before_removal(time); });
    const EndOfStepCounts counts = retirement.count(time);
    if (counts.leaving > 0) remove_leavers(time);
    SimulationStatistics& statistics = recorder.statistics();
    statistics.resting = counts.resting;
    statistics.asleep = store.may_sleep() ? counts.held : 0;
}

void Simulation::Impl::remove_leavers(double time) {
    SimulationStatistics& statistics = recorder.statistics();
    std::vector<std::uint8_t> keep(store.size(), 1);
    std::vector<LeaverCounts> blocks(blocks_of(store.size()));
    parallel_for_blocks(store.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const RemovalReason departure = retirement.removal_reason(i, time);
            if (departure == RemovalReason::none) continue;
            keep[i] = 0;
            const double death = particles().birth_time[i] + particles().lifetime[i];
            blocks[block].add(departure, mover.add_weight(i, std::min(time, death), 1.0));
        }
    });
    for (const LeaverCounts& counts : blocks) counts.add_to(statistics);
    compact(keep);
}

void Simulation::Impl::compact(const std::vector<std::uint8_t>& keep) {
    schedule.compact(keep);
    free_flights.compact(keep);
    store.compact(keep);
    modules.each([&](Module& module) { module.compact(keep); });
    bind_modules();
}

void Simulation::Impl::end_step() {
    recorder.end_step();
    SimulationStatistics& statistics = recorder.statistics();
    statistics.unsolved_steps = 0;
    modules.each([&](const Module& module) { module.count(statistics); });
    ++statistics.steps;
    if (!share.is_alone()) share.end_step(store.size(), *colliders);
    inside_step = false;
}

}  // namespace ricochet
