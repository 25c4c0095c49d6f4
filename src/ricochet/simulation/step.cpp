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
    return acceleration.look_ahead && acceleration.deferred_steps && !check && !offspring && !bounds &&
           !coupled.is_active() && !pairs && !heat;
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
    check_spheres(step.begin, step.end);
    check_end(step.end);
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
    if (clouds) clouds->begin_step();
    const TimeSpan step = clock.span_of(recorder.statistics().steps);
    if (driven.is_active()) driven.begin_step();
    if (driven.is_active()) driven.plan(step.begin, step.end, oldest_position());
    if (bodies) bodies->begin_step(step.begin, step.end);
    return step;
}

// Moves a spawn generation over the step, in one or more substeps. Each substep is recorded separately, so that the
// events of a particle stay in the order of time.
void Simulation::Impl::move_generation(const ParticleRange& generation, const TimeSpan& step) {
    recorder.begin_generation();
    if ((driven.is_active() || coupled.is_active()) && !generation.are_children) mover.begin_step();
    if (offspring) offspring->before_move(particles(), generation.begin, store.sides_from(generation.begin));
    if (heat) heat->before_move(particles(), generation, step);
    if (clouds) clouds->before_move(generation);
    std::vector<HeatGain> gains;
    for (double now = step.begin; now < step.end;) {
        stop.poll();
        const TimeSpan part = plan_substep(generation, {now, step.end});
        std::vector<BlockRecord> blocks;
        wake_sleepers(part);
        move_substep(generation, part, blocks);
        if (coupled.is_active() && !generation.are_children) {
            const CoupledMotion::Correction correction = coupled.correct_velocities(store.particles());
            mover.apply_correction(correction.corrections, part, blocks);
            if (correction.runaway) {
                blocks.emplace_back().note({*correction.runaway, correction.runaway_speed, RunawayCause::others});
            }
        }
        stop_runaways(blocks, step.end);
        record_part(generation, blocks);
        for (const BlockRecord& block : blocks) gains.insert(gains.end(), block.heat.begin(), block.heat.end());
        now = part.end;
    }
    if (coupled.is_active() && !generation.are_children) coupled.settle(particles());
    if (heat) heat->after_move(store.particles(), generation, step, std::move(gains));
    recorder.end_generation(generation.size());
}

TimeSpan Simulation::Impl::plan_substep(const ParticleRange& generation, const TimeSpan& rest) {
    return driven.is_active() ? plan_driven_motion(generation, rest) : plan_coupled_motion(generation, rest);
}

// Plans the next substep of the bodies. Children repeat the substeps that the other particles have already taken, with
// the bodies on the same paths.
TimeSpan Simulation::Impl::plan_driven_motion(const ParticleRange& generation, const TimeSpan& rest) {
    TimeSpan part = rest;
    if (!generation.are_children) {
        part.end = driven.next_substep_end(part.begin, part.end);
        driven.plan(part.begin, part.end, oldest_position());
        if (bodies) part.end = settle_driven_motion(generation, part);
    } else {
        part.end = driven.repeat_substep(part.begin);
    }
    if (bodies) bodies->begin_step(part.begin, part.end);
    return part;
}

// Plans a substep until the planned loads agree with the loads that the particles exert in it. Returns the end of the
// substep, in s.
double Simulation::Impl::settle_driven_motion(const ParticleRange& generation, TimeSpan part) {
    for (int round = 0;; ++round) {
        bodies->begin_step(part.begin, part.end);
        const std::vector<ColliderLoad> preview = mover.preview(generation, part);
        const bool goes_on = driven.plan_again(preview, driven.cut_by(preview), round);
        part.end = driven.planned_end();
        if (!goes_on) return part.end;
    }
}

// Returns the earliest time, in s, at which any particle's position is stored. It is at most the start of the step,
// because children may start there.
double Simulation::Impl::oldest_position() const {
    const double now = clock.time_at(recorder.statistics().steps);
    double oldest = now;
    for (std::size_t i = 0; i < store.size(); ++i) oldest = std::min(oldest, store.stored_time(i, now));
    return oldest;
}

void Simulation::Impl::record_part(const ParticleRange& generation, const std::vector<BlockRecord>& blocks) {
    recorder.record(blocks);
    if (!share.is_alone()) share.note(blocks, particles().id);
    std::vector<ColliderLoad> loads;
    for (const BlockRecord& block : blocks) loads.insert(loads.end(), block.loads.begin(), block.loads.end());
    if (!driven.is_active()) {
        recorder.add_loads(loads, *colliders);
        return;
    }
    std::vector<ColliderLoad> with_dynamic = loads;
    for (ColliderLoad& load : with_dynamic) load.work += driven.became_dynamic(load);
    recorder.add_loads(with_dynamic, *colliders);
    if (!generation.are_children) {
        driven.follow(loads);
        ++recorder.statistics().body_parts;
    } else {
        driven.take(loads);
    }
}

// Plans the coupled motion and returns the substep that is planned. Children join the coupled motion in the next step.
TimeSpan Simulation::Impl::plan_coupled_motion(const ParticleRange& generation, const TimeSpan& rest) {
    if (generation.are_children) return rest;
    const double whole = rest.end - rest.begin;
    const double planned = share.keeps_together() ? plan_on_first_rank(rest) : plan_coupled(rest);
    return {rest.begin, planned < whole ? rest.begin + planned : rest.end};
}

// Plans the coupled motion of this process's particles. Returns the planned duration, in s.
double Simulation::Impl::plan_coupled(const TimeSpan& rest) {
    const double whole = rest.end - rest.begin;
    if (!coupled.is_active()) return whole;
    // A particle under load from other spheres is assumed to keep its velocity, like one supported by a wall.
    const std::vector<std::uint8_t> pressing = pairs ? pairs->pressing() : std::vector<std::uint8_t>();
    const auto hold = [&](std::size_t i, const Vec3& pull) {
        if (!pressing.empty() && pressing[i] != 0) return Vec3{};
        return mover.supported_acceleration(i, rest.begin, pull);
    };
    return coupled.plan(particles(), rest.begin, whole, {world, materials, options.resting_speed}, hold);
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
    if (options.response == ResponseKind::rollback && options.rollback.global) {
        mover.move_as_system(generation, part, blocks);
        return;
    }
    if (pairs) pairs->solve(generation, part);
    ActiveSet active = free_flights.advance(generation, part, blocks);
    order_active_set(active);
    mover.move(active, part, blocks);
    if (clouds) clouds->move(generation, part, blocks);
    if (!share.is_alone()) balancer.note(work_of(generation, active.size(), blocks));
    if (!pairs) return;
    pairs->write_back(part, blocks);
    SimulationStatistics& statistics = recorder.statistics();
    statistics.pair_impacts += pairs->counts().impacts;
    statistics.overlap_largest = std::max(statistics.overlap_largest, pairs->counts().largest_overlap);
    recorder.add_pair_impacts(pairs->impacts());
    if (!check) return;
    recorder.add_pair_violations(RunCheck::check_meetings(pairs->meetings(), pairs->books()));
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

void Simulation::Impl::check_spheres(double begin, double end) {
    if (!check || !pairs) return;
    const bool may_be_planned = options.particle_contacts->method != PairMethod::events;
    recorder.add_pair_violations(
        check->check_spheres(particles(), {begin, end}, may_be_planned ? kMostPlannedOverlap : kMostMetOverlap));
    SimulationStatistics& statistics = recorder.statistics();
    statistics.overlap_verified = std::max(statistics.overlap_verified, check->largest_overlap());
}

// Checks the final state in the last step of the run.
void Simulation::Impl::check_end(double time) {
    if (!check || recorder.statistics().steps + 1 < clock.steps()) return;
    recorder.add_violations(check->check_end(particles(), time));
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
    if (clouds && bounds) clouds->part_from_leavers(retirement, time);
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
    if (clouds) clouds->compact(keep);
    if (check) check->compact(keep);
    if (coupled.is_active()) coupled.bind(particles());
}

void Simulation::Impl::end_step() {
    recorder.end_step();
    SimulationStatistics& statistics = recorder.statistics();
    if (coupled.is_active()) {
        statistics.springs_broken = coupled.springs().broken();
        statistics.springs_lost = coupled.springs().lost();
    }
    statistics.unsolved_steps = (coupled.is_active() ? coupled.unsolved_steps() : 0) + (pairs ? pairs->unsolved() : 0);
    ++statistics.steps;
    if (!share.is_alone()) share.end_step(store.size(), *colliders);
    inside_step = false;
}

}  // namespace ricochet
