#include "ricochet/simulation/active_mover.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "ricochet/collision/overlap.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/rollback.h"
#include "ricochet/simulation/cloud_motion.h"
#include "ricochet/simulation/heat_stage.h"
#include "ricochet/simulation/sleeping_islands.h"

namespace ricochet {

namespace {

/// Numbers of particles between the prefetch of a particle, of its candidates and of their corners, and its move.
constexpr std::size_t kPrefetchDistance = 6;
constexpr std::size_t kTrianglePrefetchDistance = 4;
constexpr std::size_t kVertexPrefetchDistance = 2;

/// Returns true if the particle flies on without contact.
bool flies_on(const MovingParticle& moved, const MoveOutcome& outcome) {
    return moved.contact.count == 0 && moved.contact.cascade_left == 0.0 && outcome.end == MoveEnd::moving;
}

}  // namespace

void ActiveMover::move(const ActiveSet& active, const TimeSpan& step, std::vector<BlockRecord>& blocks) {
    blocks.resize(std::max(blocks.size(), active.blocks()));
    parallel_for_blocks(active.blocks(), 1, [&](std::size_t block, std::size_t, std::size_t) {
        move_block(active.block(block), step, blocks[block]);
    });
}

void ActiveMover::move_block(std::span<const std::uint32_t> active, const TimeSpan& step, BlockRecord& record) {
    thread_local MoveScratch scratch;
    prepare(scratch);
    for (std::size_t k = 0; k < active.size(); ++k) {
        prefetch(active, k);
        if (clouds_ != nullptr && clouds_->leads(active[k])) continue;
        move_one(active[k], step, scratch, record);
    }
    record_lists(scratch, record);
}

void ActiveMover::move_one(std::size_t i, const TimeSpan& step, MoveScratch& scratch, BlockRecord& record,
                           const Lead* lead) {
    const TimeSpan life = life_in(i, step);
    if (life.end <= life.begin) return;
    parts_.response.rules().poll();
    grow_core(i, life.begin);
    MovingParticle particle = load(i, life.begin);
    if (lead != nullptr) particle.planned = &lead->flight, particle.state.coupling = &lead->pull;
    particle.step_end = life.end;
    scratch.segments.clear();
    const std::size_t first_record = scratch.records.size();
    const std::size_t first_hit = scratch.hits.size();
    const std::size_t first_load = scratch.loads.size();
    const Flight* const plan = lead != nullptr ? &lead->flight : parts_.coupled.flight_of(i);
    // A planned flight's duration need not be the difference of the clock's times to the last bit.
    const bool as_planned = plan != nullptr && life.begin == step.begin && life.end == step.end;
    const double duration = as_planned ? plan->path.duration : life.end - life.begin;
    scratch.flown.clear();
    scratch.motions.clear();
    scratch.impacts.clear();
    const RecordedMotion before{particle.state.position, particle.state.velocity, particle.spin};
    const bool wants_deviation = as_planned && parts_.coupled.wants_deviation_of(i);
    scratch.record_flown = wants_deviation || parts_.passages != nullptr;
    const MoveOutcome outcome = parts_.response.move(particle, duration, scratch);
    if (wants_deviation)
        record_deviation(i, particle, outcome, scratch.flown, impulse_of(std::span(scratch.hits).subspan(first_hit)));
    if (parts_.meter != nullptr) {
        parts_.meter->note(i, particle.state, scratch, first_record, first_load, record.heat);
    }
    if (parts_.check != nullptr) {
        const RecordedMotion after{particle.state.position, particle.state.velocity, particle.spin};
        parts_.check->check(i, parts_.store.particles(), particle.state, {life.end, particle.stored_time},
                            scratch.segments, record.violations, {before, after, scratch.motions});
        RunCheck::check_rebounds(particle.id, scratch.impacts, record.violations);
    }
    for (std::size_t k = first_record; particle.state.whole_radius > 0.0 && k < scratch.records.size(); ++k) {
        scratch.records[k].radius = particle.state.whole_radius;
    }
    if (i < bounces_.size()) bounces_[i] += outcome.meetings();
    const MoveImpulses impulses{std::span(scratch.hits).subspan(first_hit), {}, {}};
    const Vec3 from = parts_.store.particles().position[i];
    write_back(i, particle, outcome, life.end, impulses, record, lead != nullptr);
    note_passages(i, from, scratch.flown, scratch.segments, record);
}

void ActiveMover::note_passages(std::size_t i, const Vec3& from, std::span<const FlownPiece> flown,
                                std::span<const Segment> segments, BlockRecord& record) const {
    if (parts_.passages == nullptr) return;
    const Particles& particles = parts_.store.particles();
    const MovedParticle moved{particles.id[i], particles.mass[i], from, particles.position[i]};
    if (parts_.passages->needs_segments()) {
        parts_.passages->trace(moved, segments, record.passages);
    } else {
        parts_.passages->trace(moved, flown, record.passages);
    }
}

void ActiveMover::apply_velocity_change(std::size_t i, const Vec3& change, double time, double duration,
                                        const Coupling& pull, MoveScratch& scratch) {
    MovingParticle particle = load(i, time);
    particle.state.coupling = &pull;
    parts_.response.apply_correction(particle, change, duration, scratch);
    parts_.store.particles().velocity[i] = particle.state.velocity;
    parts_.store.particles().spin[i] = parts_.store.spin_of(i, particle);
}

/// Lets the core of a sphere in overlap grow with its distance to the surfaces, at the time of its stored position. In
/// contact the core keeps its radius.
void ActiveMover::grow_core(std::size_t i, double time) {
    ParticleStore& store = parts_.store;
    if (!store.cores().has(i) || store.is_fixed(i)) return;
    const Particles& particles = store.particles();
    if (particles.support[i][0] != kNoSupport) return;
    const Vec3& position = particles.position[i];
    const double radius = particles.radius[i];
    const std::optional<Overlap> overlap = deepest_overlap(
        parts_.response.rules().world, parts_.response.rules().bodies, position, radius, store.stored_time(i, time));
    if (overlap) {
        store.set_core(i, std::max(store.cores().radius(i), core_radius(*overlap, position, radius)));
    } else {
        store.release_from_overlap(i);
    }
}

bool ActiveMover::set_out(std::size_t i, const TimeSpan& step, IslandMember& member) {
    const TimeSpan life = life_in(i, step);
    if (life.end <= life.begin) return false;
    grow_core(i, life.begin);
    member.particle = i;
    member.moving = load(i, life.begin);
    if (life.begin != step.begin || life.end != step.end) member.moving.planned = nullptr;
    member.end = life.end;
    member.is_fixed = parts_.store.is_fixed(i);
    member.is_free = parts_.schedule.is_in_free_flight(i);
    member.keeps_path = parts_.passages != nullptr;
    return true;
}

void ActiveMover::write_back(IslandMember& member, const TimeSpan& step, BlockRecord& record) {
    const std::size_t i = member.particle;
    MovingParticle& moving = member.moving;
    const TimeSpan life = life_in(i, step);
    if (parts_.check != nullptr && !member.is_fixed) {
        const Particles& p = parts_.store.particles();
        const Vec3 spin = parts_.store.load(i, life.begin, false).spin;
        parts_.check->check(i, p, moving.state, {life.end, moving.stored_time}, member.lists.segments,
                            record.violations,
                            {{p.position[i], p.velocity[i], spin},
                             {moving.state.position, moving.state.velocity, moving.spin},
                             member.lists.motions});
        RunCheck::check_rebounds(moving.id, member.lists.impacts, record.violations);
    }
    for (ContactRecord& contact : member.lists.records) {
        if (moving.state.whole_radius > 0.0) contact.radius = moving.state.whole_radius;
    }
    record_lists(member.lists.hits, member.lists.loads, member.lists.records, record);
    if (!member.is_fixed && life.begin == step.begin && life.end == step.end) record_deviation(member);
    if (i < bounces_.size()) bounces_[i] += member.outcome.meetings();
    if (member.is_fixed) {
        parts_.schedule.leave_alone(i);
        return;
    }
    // A sphere that slept on walls alone has pressed on them until now.
    if (parts_.store.is_asleep(i)) record.counts.lost_impulses += add_weight(i, life.begin, 1.0);
    const Vec3 from = parts_.store.particles().position[i];
    write_back(i, moving, member.outcome, life.end, {member.lists.hits, {}, member.pair_velocity_change}, record);
    note_passages(i, from, member.trajectory, member.lists.segments, record);
}

void ActiveMover::move_as_system(const ParticleRange& range, const TimeSpan& step, std::vector<BlockRecord>& blocks) {
    std::vector<SystemParticle> system(range.size());
    for (std::size_t k = 0; k < system.size(); ++k) {
        const std::size_t i = range.begin + k;
        const TimeSpan life = life_in(i, step);
        grow_core(i, life.begin);
        system[k].particle = load(i, life.begin);
        system[k].start = life.begin;
        system[k].stop = life.end;
        system[k].is_out = parts_.store.is_fixed(i);
    }
    blocks.resize(std::max(blocks.size(), blocks_of(system.size())));
    std::vector<MoveScratch> scratch(blocks.size());
    for (MoveScratch& block : scratch) prepare(block);
    move_together(parts_.response.rules(), system, step.begin, step.end, scratch, kParticleBlock);
    for (std::size_t k = 0; k < system.size(); ++k) {
        const std::size_t i = range.begin + k;
        const SystemParticle& moved = system[k];
        if (parts_.store.is_fixed(i) || moved.stop <= moved.start) continue;
        BlockRecord& record = blocks[k / kParticleBlock];
        if (parts_.check != nullptr) {
            parts_.check->check(i, parts_.store.particles(), moved.particle.state, {moved.stop, moved.stop},
                                moved.segments, record.violations);
        }
        const bool as_planned = moved.start == step.begin && moved.stop == step.end;
        if (as_planned && parts_.coupled.wants_deviation_of(i)) {
            std::vector<FlownPiece> flown;
            record_deviation(i, moved.particle, moved.outcome, flown, moved.surface_impulse);
        }
        const Vec3 from = parts_.store.particles().position[i];
        write_back(i, moved.particle, moved.outcome, moved.stop, {{}, moved.surface_impulse, {}}, record);
        note_passages(i, from, {}, moved.segments, record);
    }
    for (std::size_t k = 0; k < blocks.size(); ++k) record_lists(scratch[k], blocks[k]);
}

std::vector<ColliderLoad> ActiveMover::preview(const ParticleRange& range, const TimeSpan& step) {
    std::vector<std::vector<ColliderLoad>> blocks(blocks_of(range.size()));
    parallel_for_blocks(range.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        MoveScratch scratch;
        scratch.record_loads = true;
        for (std::size_t i = range.begin + begin; i < range.begin + end; ++i) {
            const TimeSpan life = life_in(i, step);
            if (parts_.store.is_fixed(i) || life.end <= life.begin) continue;
            if (!is_near_dynamic_body(parts_.store.force_input(i, life.begin), life.end - life.begin)) continue;
            MovingParticle particle = load(i, life.begin);
            particle.step_end = life.end;
            static_cast<void>(parts_.response.move(particle, life.end - life.begin, scratch));
            scratch.hits.clear();
        }
        blocks[block] = std::move(scratch.loads);
    });
    std::vector<ColliderLoad> all;
    for (const auto& loads : blocks) all.insert(all.end(), loads.begin(), loads.end());
    return all;
}

/// Returns false if the particle cannot reach a dynamic body without an impact on something else.
bool ActiveMover::is_near_dynamic_body(const ForceInput& state, double duration) const {
    const ResponseRules& rules = parts_.response.rules();
    const double speed = length(state.velocity) + duration * length(rules.forces.acceleration(state));
    const double reach = state.radius + 2.0 * duration * speed;
    const Vec3 by{reach, reach, reach};
    const Box3 box{state.position - by, state.position + by};
    std::vector<BodyId> near;
    rules.bodies->near(box, kWorldBody, near);
    return std::any_of(near.begin(), near.end(), [&](BodyId body) { return rules.bodies->is_dynamic(body); });
}

// Returns the part of the step in which the particle lives.
TimeSpan ActiveMover::life_in(std::size_t i, const TimeSpan& step) const {
    const Particles& particles = parts_.store.particles();
    return {std::max(step.begin, particles.birth_time[i]),
            std::min(step.end, particles.birth_time[i] + particles.lifetime[i])};
}

MovingParticle ActiveMover::load(std::size_t i, double start) {
    MovingParticle particle = parts_.store.load(i, start, !parts_.schedule.is_without_contact(i));
    particle.candidates = parts_.schedule.candidates(i);
    if (i < bounces_.size()) particle.bounces_before = bounces_[i];
    if (parts_.offspring != nullptr) {
        particle.shatter_impulse = parts_.offspring->shatter_impulse(parts_.store.particles(), i);
    }
    particle.planned = parts_.coupled.is_planned_in_contact(i) ? nullptr : parts_.coupled.flight_of(i);
    particle.state.coupling = parts_.coupled.coupling_of(i);
    return particle;
}

void ActiveMover::write_back(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome, double until,
                             const MoveImpulses& impulses, BlockRecord& record, bool is_pulled) {
    Particles& particles = parts_.store.particles();
    const auto is_fast = [&] { return length_squared(particles.velocity[i]) > kMaxSpeed * kMaxSpeed; };
    const bool was_fast = is_fast();
    const bool in_contact = !parts_.schedule.is_without_contact(i) || !flies_on(moved, outcome);
    parts_.store.store(i, moved, outcome, in_contact, !parts_.coupled.holds(i) && !is_pulled);
    if (!was_fast && is_fast()) record.note({i, length(particles.velocity[i]), runaway_cause(i, impulses)});
    if (outcome.end == MoveEnd::held) particles.accounted_until[i] = until;
    if (outcome.unsimulated_time > 0.0) record.cut_off.push_back({i, outcome.unsimulated_time});
    schedule_query(i, moved, outcome, until, is_pulled);
    record.add(outcome);
}

void ActiveMover::schedule_query(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome, double until,
                                 bool is_pulled) {
    if (parts_.store.is_fixed(i) || parts_.store.is_asleep(i)) {
        parts_.schedule.leave_alone(i);
    } else if (!flies_on(moved, outcome) || parts_.coupled.is_active() || is_pulled || parts_.store.cores().has(i)) {
        parts_.schedule.forget(i);
    } else {
        FreeFlightForecast forecast;
        if (outcome.free_for > 0.0) {
            const Particles& particles = parts_.store.particles();
            forecast.free_until = std::min(until + outcome.free_for, particles.birth_time[i] + particles.lifetime[i]);
        }
        if (outcome.candidates_for != 0.0) {
            forecast.candidates_until = until + outcome.candidates_for;
            forecast.candidates = outcome.candidates;
        }
        parts_.schedule.set_flying(i, forecast);
    }
}

std::uint64_t ActiveMover::add_weight(std::size_t i, double until, double sign) {
    SurfaceTotals& totals = parts_.recorder.totals();
    const double elapsed = until - parts_.store.particles().accounted_until[i];
    if (totals.empty() || !(elapsed > 0.0)) return 0;
    std::vector<SurfaceHit> hits;
    const std::uint64_t id = parts_.store.particles().id[i];
    if (sleeping_islands_ != nullptr && sleeping_islands_->has(id)) {
        sleeping_islands_->add_weight(id, elapsed, hits);
    } else if (parts_.store.is_asleep(i)) {
        MovingParticle sleeper = parts_.store.load(i, until, true);
        sleeper.state.coupling = parts_.coupled.coupling_of(i);
        parts_.response.add_weight(sleeper, elapsed, hits);
    }
    for (SurfaceHit& hit : hits) hit.impulse *= sign;
    return totals.add(hits);
}

void ActiveMover::press(std::span<const SurfaceHit> hits) {
    SurfaceTotals& totals = parts_.recorder.totals();
    if (!totals.empty()) parts_.recorder.statistics().lost_impulses += totals.add(hits);
}

void ActiveMover::wake(std::size_t i, double time) {
    parts_.recorder.statistics().lost_impulses += add_weight(i, time, 1.0);
    parts_.store.wake(i);
    parts_.schedule.forget(i);
}

void ActiveMover::check_sleeper(std::size_t i, const TimeSpan& step, BlockRecord& record) const {
    if (parts_.check == nullptr) return;
    const Particles& particles = parts_.store.particles();
    const Vec3& position = particles.position[i];
    const Segment staying{position, position, step.end, step.begin, step.end};
    parts_.check->check(i, particles, parts_.store.force_input(i, step.end), {step.end, step.end}, {&staying, 1},
                        record.violations);
}

void ActiveMover::prepare(MoveScratch& scratch) const {
    scratch.hits.clear();
    scratch.records.clear();
    scratch.loads.clear();
    scratch.record_loads = parts_.recorder.collects_loads();
    scratch.record_contacts = parts_.recorder.collects_contacts();
    const bool traces_segments = parts_.passages != nullptr && parts_.passages->needs_segments();
    scratch.record_segments = parts_.check != nullptr || traces_segments;
    scratch.record_motions = parts_.check != nullptr || parts_.meter != nullptr;
}

void ActiveMover::record_lists(const MoveScratch& scratch, BlockRecord& record) {
    record_lists(scratch.hits, scratch.loads, scratch.records, record);
}

void ActiveMover::record_lists(std::span<const SurfaceHit> hits, std::span<const ColliderLoad> loads,
                               std::span<const ContactRecord> contacts, BlockRecord& record) {
    record.counts.lost_impulses += parts_.recorder.totals().add(hits);
    record.loads.insert(record.loads.end(), loads.begin(), loads.end());
    record.contact_records.insert(record.contact_records.end(), contacts.begin(), contacts.end());
}

// Prefetches in three stages, because neighbours in space are scattered in memory: the data that load() and store()
// use, then the candidates, then their corners.
void ActiveMover::prefetch(std::span<const std::uint32_t> active, std::size_t k) const {
    if (k + kPrefetchDistance < active.size()) prefetch(active[k + kPrefetchDistance]);
    if (k + kTrianglePrefetchDistance < active.size()) prefetch_triangles(active[k + kTrianglePrefetchDistance]);
    if (k + kVertexPrefetchDistance < active.size()) prefetch_vertices(active[k + kVertexPrefetchDistance]);
}

void ActiveMover::prefetch_triangles(std::size_t i) const {
    const ContactCandidates& candidates = parts_.schedule.candidates(i);
    if (!candidates.is_known()) return;
    const CollisionWorld& world = parts_.response.rules().world;
    for (const std::uint32_t triangle : candidates.triangles()) __builtin_prefetch(&world.triangles()[triangle]);
}

void ActiveMover::prefetch_vertices(std::size_t i) const {
    const ContactCandidates& candidates = parts_.schedule.candidates(i);
    if (!candidates.is_known()) return;
    const CollisionWorld& world = parts_.response.rules().world;
    for (const std::uint32_t triangle : candidates.triangles()) {
        for (const std::uint32_t vertex : world.triangles()[triangle]) {
            __builtin_prefetch(&world.vertices()[vertex].x);
            __builtin_prefetch(&world.vertices()[vertex].z);
        }
    }
}

}  // namespace ricochet
