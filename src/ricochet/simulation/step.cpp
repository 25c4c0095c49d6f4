// One step: emit, move, give birth, retire.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/rollback.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {
namespace {

/// Hits from the fetch of a triangle's totals from memory to their change.
constexpr std::size_t kHitPrefetchDistance = 8;

}  // namespace

void Simulation::step() {
    if (!finished()) impl_->step();
}

void Simulation::advance(std::uint64_t count, const std::function<bool()>& go_on) {
    if (count > 1) impl_->begin_deferring();
    try {
        bool goes_on = true;
        for (std::uint64_t k = 0; k < count && goes_on && !finished(); ++k) {
            impl_->step();
            goes_on = !go_on || go_on();
        }
    } catch (...) {
        impl_->end_deferring();
        throw;
    }
    impl_->end_deferring();
}

// What is inside a step must not go on: particles in free flight may be a step ahead of what was foreseen.
void Simulation::Impl::step() {
    if (inside_step) {
        throw RunError("a step of this simulation has ended with an error; make it anew or restore a saved state");
    }
    inside_step = true;
    const double from = time_at(statistics.steps);
    const double to = time_at(statistics.steps + 1);
    emit(from, to);
    if (check) check->watch_spawned(particles);
    move_all(from, to);
    retire(to);
    ++statistics.steps;
    inside_step = false;
}

// Particles that are born of particles inside the step are moved from their births to its end, with their own children
// in turn.
void Simulation::Impl::move_all(double from, double to) {
    records.clear();
    last_violations.clear();
    std::size_t first = 0;
    const std::uint64_t emitted_before = statistics.emitted;
    do {
        const std::size_t end = particles.size();
        if (offspring) offspring->before_move(particles, first);
        move_from(first, from, to);
        if (offspring) spawn_children(from, to);
        if (check) check->watch_spawned(particles);
        first = end;
    } while (first < particles.size());
    if (statistics.emitted > emitted_before && coupled.is_active()) coupled.bind(particles);
    if (options.record_contacts) sort_records();
}

void Simulation::Impl::spawn_children(double from, double to) {
    OffspringCounts counts;
    for (Particle& child : offspring->after_move(world, particles, from, to, std::move(pass_records), counts)) {
        add(std::move(child));
    }
    statistics.children += counts.children;
    statistics.births_refused_by_depth += counts.refused_by_depth;
    statistics.births_refused_by_population += counts.refused_by_population;
}

// Particles that act on each other are planned together first; an adaptive plan may cut the step into parts. The
// newborn join them with the next step.
void Simulation::Impl::move_from(std::size_t first, double from, double to) {
    const std::size_t count = particles.size() - first;
    pass_records.clear();
    const bool is_planned = coupled.is_active() && first == 0;
    for (double now = from; now < to;) {
        const double whole = to - now;
        const double planned = is_planned ? coupled.plan(particles, now, whole) : whole;
        const double next = planned < whole ? now + planned : to;
        std::vector<BlockCounts> blocks;
        move_part(first, now, next, blocks);
        take_over(blocks, to);
        now = next;
    }
    if (is_planned) coupled.settle(particles);
    statistics.particle_steps += count;
    statistics.unsolved_steps = coupled.unsolved_steps();
    if (options.record_contacts) records.insert(records.end(), pass_records.begin(), pass_records.end());
}

// Part by part, so that what happens to a particle stays in the order of time. `to` is the end of the step.
void Simulation::Impl::take_over(const std::vector<BlockCounts>& blocks, double to) {
    stop_runaways(blocks, to);
    for (const BlockCounts& block : blocks) block.add_to(statistics);
    add_cut_off(blocks);
    if (keeps_records()) collect_records(blocks);
    if (check) collect_violations(blocks);
}

void Simulation::Impl::move_part(std::size_t first, double from, double to, std::vector<BlockCounts>& blocks) {
    if (options.response == ResponseKind::rollback && options.rollback.global) {
        move_system(first, from, to, blocks);
        return;
    }
    ActiveSet due = advance_free_flights(first, from, to, blocks);
    sort_by_position(due);
    grow_to(blocks, due.parts());
    parallel_for_blocks(due.parts(), 1, [&](std::size_t part, std::size_t, std::size_t) {
        move_active(due.part(part), from, to, blocks[part]);
    });
}

void Simulation::Impl::stop_runaways(const std::vector<BlockCounts>& blocks, double to) const {
    std::optional<std::size_t> first;
    for (const BlockCounts& block : blocks) {
        if (block.runaway && (!first || *block.runaway < *first)) first = block.runaway;
    }
    if (!first) return;
    const std::size_t i = *first;
    throw DivergedError(fmt::format(
        "by t = {:.6g} s forces have brought particle {} to {:.3g} m/s, beyond the speed of light: the motion has "
        "diverged; use a shorter time step, the integrator implicit_euler, or weaker forces",
        to, particles.id[i], length(particles.velocity[i])));
}

void Simulation::Impl::collect_violations(const std::vector<BlockCounts>& blocks) {
    std::vector<Violation> found;
    for (const BlockCounts& block : blocks) {
        found.insert(found.end(), block.violations.begin(), block.violations.end());
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Violation& a, const Violation& b) { return a.particle < b.particle; });
    statistics.violations += found.size();
    last_violations.insert(last_violations.end(), found.begin(), found.end());
    const std::size_t kept = std::min(found.size(), kMostViolations - violations.size());
    violations.insert(violations.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept));
}

// Added in the order of particles, whatever the order in which they were moved.
void Simulation::Impl::add_cut_off(const std::vector<BlockCounts>& blocks) {
    std::vector<CutOff> all;
    for (const BlockCounts& block : blocks) all.insert(all.end(), block.cut_off.begin(), block.cut_off.end());
    std::stable_sort(all.begin(), all.end(), [](const CutOff& a, const CutOff& b) { return a.particle < b.particle; });
    for (const CutOff& entry : all) statistics.unsimulated_time += entry.time;
    statistics.budget_exhausted += all.size();
}

void Simulation::Impl::collect_records(const std::vector<BlockCounts>& blocks) {
    for (const BlockCounts& block : blocks) {
        pass_records.insert(pass_records.end(), block.records.begin(), block.records.end());
    }
}

// Within a particle the order of impacts is that of time already, so a stable sort by (time, id) settles everything.
void Simulation::Impl::sort_records() {
    std::stable_sort(records.begin(), records.end(), [](const ContactRecord& a, const ContactRecord& b) {
        return a.time != b.time ? a.time < b.time : a.particle < b.particle;
    });
}

// All particles go back together: see rollback.h.
void Simulation::Impl::move_system(std::size_t first, double from, double to, std::vector<BlockCounts>& blocks) {
    std::vector<SystemParticle> system(particles.size() - first);
    for (std::size_t k = 0; k < system.size(); ++k) {
        const std::size_t i = first + k;
        const double start = std::max(from, particles.birth_time[i]);
        const double stop = std::min(to, particles.birth_time[i] + particles.lifetime[i]);
        system[k].particle = moving(i, start);
        system[k].start = start;
        system[k].stop = stop;
        system[k].is_out = stands_still(i);
    }
    grow_to(blocks, blocks_of(system.size()));
    std::vector<MoveScratch> scratch(blocks.size());
    for (MoveScratch& block : scratch) {
        block.record_contacts = keeps_records();
        block.record_segments = check != nullptr;
    }
    move_together(response->rules(), system, from, to, scratch, kParticleBlock);
    for (std::size_t k = 0; k < system.size(); ++k) {
        const std::size_t i = first + k;
        SystemParticle& moved = system[k];
        if (stands_still(i) || moved.stop <= moved.start) continue;
        BlockCounts& counts = blocks[k / kParticleBlock];
        if (check) check->look_at(i, particles, moved.particle.state, moved.stop, moved.segments, counts.violations);
        book(i, moved.particle, moved.outcome, moved.stop, counts);
    }
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        if (!totals.empty()) add_hits(scratch[k].hits, blocks[k]);
        blocks[k].records.insert(blocks[k].records.end(), scratch[k].records.begin(), scratch[k].records.end());
    }
}

std::span<SideMemory> Simulation::Impl::sides_of(std::size_t i) {
    if (sides.empty()) return {};
    const std::size_t colliders = world.colliders().size();
    return {sides.data() + i * colliders, colliders};
}

void Simulation::Impl::add_hits(const std::vector<SurfaceHit>& hits, BlockCounts& counts) {
    for (std::size_t k = 0; k < hits.size(); ++k) {
        if (k + kHitPrefetchDistance < hits.size()) {
            const SurfaceTotals& later = totals[hits[k + kHitPrefetchDistance].surface];
            __builtin_prefetch(&later.hits, 1);
            __builtin_prefetch(&later.z, 1);
        }
        const SurfaceHit& hit = hits[k];
        SurfaceTotals& total = totals[hit.surface];
        if (hit.impact) total.hits.fetch_add(1, std::memory_order_relaxed);
        const bool x = total.x.add(hit.impulse.x, kImpulseUnit);
        const bool y = total.y.add(hit.impulse.y, kImpulseUnit);
        const bool z = total.z.add(hit.impulse.z, kImpulseUnit);
        counts.lost_impulses += x && y && z ? 0 : 1;
    }
}

// The impulse of a sleeping particle's weight since it was last moved, or (sign -1) exactly that taken back.
void Simulation::Impl::add_weight(std::size_t i, double until, double sign, BlockCounts& counts) {
    const double elapsed = until - particles.accounted_until[i];
    if (totals.empty() || !is_asleep(i) || !(elapsed > 0.0)) return;
    std::vector<SurfaceHit> hits;
    response->add_weight(moving(i, until), elapsed, hits);
    for (SurfaceHit& hit : hits) hit.impulse *= sign;
    add_hits(hits, counts);
}

void Simulation::Impl::add_weights_of_sleepers(double sign) {
    const double now = time_at(statistics.steps);
    BlockCounts counts;  // an overflow is counted when the weight is booked for good
    for (std::size_t i = 0; i < particles.size(); ++i) add_weight(i, now, sign, counts);
}

bool Simulation::Impl::is_leaving(std::size_t i, double now) const {
    if (bounds && !bounds->contains(particles.position[i])) return true;
    return !is_in_free_flight(i) &&
           (particles.absorbed[i] != 0 || particles.birth_time[i] + particles.lifetime[i] <= now);
}

void Simulation::Impl::retire(double now) {
    struct Tally {
        std::uint64_t leaving = 0;
        std::uint64_t resting = 0;
        std::uint64_t held = 0;
    };
    std::vector<Tally> blocks(blocks_of(particles.size()));
    parallel_for_blocks(particles.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        Tally& tally = blocks[block];
        for (std::size_t i = begin; bounds && i < end; ++i)
            tally.leaving += is_in_free_flight(i) && is_leaving(i, now) ? 1 : 0;
        visit_all_but_free_flights(begin, end, [&](std::size_t i) {
            const bool leaves = is_leaving(i, now);
            tally.leaving += leaves ? 1 : 0;
            tally.resting += leaves ? 0 : particles.resting[i];
            tally.held += leaves ? 0 : particles.held[i];
        });
    });
    Tally all;
    for (const Tally& tally : blocks) {
        all.leaving += tally.leaving;
        all.resting += tally.resting;
        all.held += tally.held;
    }
    if (all.leaving > 0) retire_leavers(now);
    statistics.springs_broken = coupled.springs().broken();
    statistics.springs_lost = coupled.springs().lost();
    statistics.resting = all.resting;
    statistics.asleep = may_sleep ? all.held : 0;
}

void Simulation::Impl::retire_leavers(double now) {
    std::vector<std::uint8_t> keep(particles.size(), 1);
    BlockCounts counts;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (!is_leaving(i, now)) continue;
        const double death = particles.birth_time[i] + particles.lifetime[i];
        const bool absorbed = particles.absorbed[i] != 0;
        const bool shattered = particles.absorbed[i] == kShattered;
        statistics.absorbed += absorbed && !shattered ? 1 : 0;
        statistics.shattered += shattered ? 1 : 0;
        statistics.expired += !absorbed && death <= now ? 1 : 0;
        statistics.out_of_bounds += !absorbed && death > now ? 1 : 0;
        keep[i] = 0;
        add_weight(i, std::min(now, death), 1.0, counts);
    }
    statistics.lost_impulses += counts.lost_impulses;
    compact(keep);
    if (coupled.is_active()) coupled.bind(particles);
}

void Simulation::Impl::compact(const std::vector<std::uint8_t>& keep) {
    if (!sides.empty()) {
        const auto colliders = static_cast<std::ptrdiff_t>(world.colliders().size());
        auto kept = sides.begin();
        for (std::size_t i = 0; i < keep.size(); ++i) {
            const auto first = sides.begin() + static_cast<std::ptrdiff_t>(i) * colliders;
            if (keep[i] != 0) kept = std::copy_n(first, colliders, kept);
        }
        sides.erase(kept, sides.end());
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < keep.size(); ++i) {
        if (keep[i] == 0) continue;
        next_query_step[kept] = next_query_step[i];
        candidates[kept++] = candidates[i];
    }
    next_query_step.resize(kept);
    candidates.resize(kept);
    if (deferred) deferred->compact(keep);
    particles.compact(keep);
    if (check) check->compact(keep);
}

}  // namespace ricochet
