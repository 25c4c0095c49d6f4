#include "ricochet/simulation/active_mover.h"

#include <optional>
#include <utility>

#include "ricochet/collision/overlap.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/rollback.h"
#include "ricochet/simulation/cloud_motion.h"

namespace ricochet {

namespace {

/// Distances, in particles, from a prefetch to the move. Three stages are needed, because neighbours in space are
/// scattered in memory: a particle's data, then its candidate triangles, then their corners.
constexpr std::size_t kPrefetchDistance = 6;
constexpr std::size_t kTrianglePrefetchDistance = 4;
constexpr std::size_t kVertexPrefetchDistance = 2;

/// Returns true if the particle flies on without contact.
bool flies_on(const MovingParticle& moved, const MoveOutcome& outcome) {
    return moved.contact.count == 0 && moved.contact.cascade_left == 0.0 && outcome.end == MoveEnd::moving;
}

/// Returns true if a dynamic body is within reach of the particle in a duration, in s, without regard to impacts.
bool is_near_dynamic_body(const ResponseRules& rules, const ForceInput& state, double duration) {
    const double speed = length(state.velocity) + duration * length(rules.forces.acceleration(state));
    const double reach = state.radius + 2.0 * duration * speed;
    const Vec3 by{reach, reach, reach};
    const Box3 box{state.position - by, state.position + by};
    std::vector<BodyId> near;
    rules.bodies.near(box, kWorldBody, near);
    return std::ranges::any_of(near, [&](BodyId body) { return rules.bodies.is_dynamic(body); });
}

void prefetch_triangles(const ContactCandidates& candidates, const CollisionWorld& world) {
    if (!candidates.is_known()) return;
    for (const std::uint32_t triangle : candidates.triangles()) __builtin_prefetch(&world.triangles()[triangle]);
}

void prefetch_vertices(const ContactCandidates& candidates, const CollisionWorld& world) {
    if (!candidates.is_known()) return;
    for (const std::uint32_t triangle : candidates.triangles()) {
        for (const std::uint32_t vertex : world.triangles()[triangle]) {
            __builtin_prefetch(&world.vertices()[vertex].x);
            __builtin_prefetch(&world.vertices()[vertex].z);
        }
    }
}

void prefetch_ahead(const ActiveMover& mover, const QuerySchedule& schedule, std::span<const std::uint32_t> active,
                    std::size_t k) {
    if (k + kPrefetchDistance < active.size()) mover.prefetch(active[k + kPrefetchDistance]);
    const CollisionWorld& world = mover.response().rules().world;
    if (k + kTrianglePrefetchDistance < active.size()) {
        prefetch_triangles(schedule.candidates(active[k + kTrianglePrefetchDistance]), world);
    }
    if (k + kVertexPrefetchDistance < active.size()) {
        prefetch_vertices(schedule.candidates(active[k + kVertexPrefetchDistance]), world);
    }
}

/// Updates the core of an overlapping sphere, at the time of the stored position. It grows with the distance of the
/// surfaces, and never shrinks. It keeps its radius in contact, and is removed without an overlap.
void grow_core(ParticleStore& store, const MovingColliders& bodies, std::size_t i, double time) {
    if (!store.cores().has(i) || store.is_fixed(i)) return;
    const Particles& particles = store.particles();
    if (particles.support[i][0] != kNoSupport) return;
    const Vec3& position = particles.position[i];
    const double radius = particles.radius[i];
    const std::optional<Overlap> overlap = deepest_overlap(bodies, position, radius, store.stored_time(i, time));
    if (overlap) {
        const double core = core_radius(*overlap, position, radius);
        store.cores().set(i, std::max(store.cores().radius(i), core), store.size());
    } else {
        store.cores().release(i);
    }
}

/// Decides when a particle that has been moved until a time, in s, needs its next query.
void schedule_query(const MoverParts& parts, std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome,
                    double until, bool is_pulled) {
    if (parts.store.is_fixed(i) || parts.store.is_asleep(i)) {
        parts.schedule.leave_alone(i);
    } else if (!flies_on(moved, outcome) || parts.hooks.coupled->is_active() || is_pulled ||
               parts.store.cores().has(i)) {
        parts.schedule.forget(i, moved.clear);
    } else {
        FreeFlightForecast forecast;
        forecast.clear = moved.clear;
        if (outcome.free_for > 0.0) {
            const Particles& particles = parts.store.particles();
            forecast.free_until = std::min(until + outcome.free_for, particles.birth_time[i] + particles.lifetime[i]);
        }
        if (outcome.candidates_for != 0.0) {
            forecast.candidates_until = until + outcome.candidates_for;
            forecast.candidates = outcome.candidates;
        }
        parts.schedule.set_flying(i, forecast);
    }
}

}  // namespace

void ActiveMover::move(const ActiveSet& active, const TimeSpan& step, std::vector<BlockRecord>& blocks) {
    blocks.resize(std::max(blocks.size(), active.blocks()));
    const CloudMotion* const clouds = parts_.hooks.clouds;
    parallel_for_blocks(active.blocks(), 1, [&](std::size_t block, std::size_t, std::size_t) {
        thread_local MoveScratch scratch;
        prepare(scratch);
        const std::span<const std::uint32_t> particles = active.block(block);
        for (std::size_t k = 0; k < particles.size(); ++k) {
            prefetch_ahead(*this, parts_.schedule, particles, k);
            if (clouds != nullptr && clouds->has_parent(particles[k])) continue;
            move_one(particles[k], step, scratch, blocks[block]);
        }
        record_lists(scratch, blocks[block]);
    });
}

void ActiveMover::prepare(MoveScratch& scratch) const {
    scratch.hits.clear();
    scratch.records.clear();
    scratch.loads.clear();
    scratch.record_loads = parts_.recorder.collects_loads();
    scratch.record_contacts = parts_.recorder.collects_contacts();
    scratch.record_segments = parts_.hooks.observers.needs().segments;
    scratch.record_motions = parts_.hooks.observers.needs().motions;
}

void ActiveMover::move_one(std::size_t i, const TimeSpan& step, MoveScratch& scratch, BlockRecord& record,
                           const Lead* lead) {
    const TimeSpan life = life_in(parts_.store.particles(), i, step);
    if (life.end <= life.begin) return;
    response_.rules().poll();
    grow_core(parts_.store, response_.rules().bodies, i, life.begin);
    MovingParticle particle = load(i, life.begin);
    if (lead != nullptr) particle.planned = &lead->flight, particle.state.coupling = &lead->pull;
    particle.step_end = life.end;
    scratch.segments.clear();
    const std::size_t first_record = scratch.records.size();
    const std::size_t first_hit = scratch.hits.size();
    const std::size_t first_load = scratch.loads.size();
    const Flight* const plan = lead != nullptr ? &lead->flight : coupled().flight_of(i);
    // The duration of a planned flight can differ by rounding from the difference of the clock's times.
    const bool as_planned = plan != nullptr && life.begin == step.begin && life.end == step.end;
    const double duration = as_planned ? plan->path.duration : life.end - life.begin;
    scratch.flown.clear();
    scratch.motions.clear();
    scratch.impacts.clear();
    const RecordedMotion before = particle.recorded_motion();
    const bool wants_deviation = as_planned && coupled().wants_deviation_of(i);
    scratch.record_flown = wants_deviation || parts_.hooks.observers.needs().pieces;
    // The response `exact` tries fly_clear(), then calls ParticleMover::run().
    const MoveOutcome outcome = response_.move(particle, duration, scratch);
    if (wants_deviation)
        record_deviation(i, particle, outcome, scratch.flown, impulse_of(std::span(scratch.hits).subspan(first_hit)));
    if (const MoveObservers& observers = parts_.hooks.observers; !observers.empty()) {
        MoveReport report = report_of(i, before, particle, life.end, scratch);
        report.pieces = scratch.flown;
        report.contacts = report.contacts.subspan(first_record);
        report.loads = report.loads.subspan(first_load);
        observers.report(report, record);
    }
    for (std::size_t k = first_record; particle.state.whole_radius > 0.0 && k < scratch.records.size(); ++k) {
        scratch.records[k].radius = particle.state.whole_radius;
    }
    if (i < bounces_.size()) bounces_[i] += outcome.meetings();
    const MoveImpulses impulses{std::span(scratch.hits).subspan(first_hit), {}, {}};
    write_back(i, particle, outcome, life.end, impulses, record, lead != nullptr);
}

/// Returns the report of a move of particle i, whose lists contain only this move. before: its motion at the start.
/// end: end of its life in the substep, in s.
MoveReport ActiveMover::report_of(std::size_t i, const RecordedMotion& before, const MovingParticle& moved, double end,
                                  const MoveLists& lists) const {
    return {i,
            parts_.store.particles(),
            moved.state,
            before,
            moved.recorded_motion(),
            end,
            moved.stored_time,
            {},
            lists.segments,
            lists.motions,
            lists.impacts,
            lists.records,
            lists.loads};
}

MovingParticle ActiveMover::load(std::size_t i, double start) {
    MovingParticle particle = parts_.store.load(i, start, !parts_.schedule.is_without_contact(i));
    particle.candidates = parts_.schedule.candidates(i);
    particle.clear = parts_.schedule.clear(i);
    if (i < bounces_.size()) particle.bounces_before = bounces_[i];
    if (parts_.hooks.offspring != nullptr) {
        particle.shatter_impulse = parts_.hooks.offspring->shatter_impulse(parts_.store.particles(), i);
    }
    particle.planned = coupled().is_planned_in_contact(i) ? nullptr : coupled().flight_of(i);
    particle.state.coupling = coupled().coupling_of(i);
    return particle;
}

void ActiveMover::write_back(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome, double until,
                             const MoveImpulses& impulses, BlockRecord& record, bool is_pulled) {
    Particles& particles = parts_.store.particles();
    const auto is_fast = [&] { return length_squared(particles.velocity[i]) > kMaxSpeed * kMaxSpeed; };
    const bool was_fast = is_fast();
    const bool in_contact = !parts_.schedule.is_without_contact(i) || !flies_on(moved, outcome);
    parts_.store.store(i, moved, outcome, in_contact, !coupled().holds(i) && !is_pulled);
    if (!was_fast && is_fast()) record.note({i, length(particles.velocity[i]), runaway_cause(i, impulses)});
    if (outcome.end == MoveEnd::held) particles.accounted_until[i] = until;
    if (outcome.unsimulated_time > 0.0) record.cut_off.push_back({i, outcome.unsimulated_time});
    schedule_query(parts_, i, moved, outcome, until, is_pulled);
    record.add(outcome);
}

void ActiveMover::apply_velocity_change(std::size_t i, const Vec3& change, double time, double duration,
                                        const Coupling* pull, MoveScratch& scratch) {
    MovingParticle particle = load(i, time);
    if (pull != nullptr) particle.state.coupling = pull;
    response_.apply_correction(particle, change, duration, scratch);
    parts_.store.particles().velocity[i] = particle.state.velocity;
    parts_.store.particles().spin[i] = parts_.store.spin_of(i, particle);
}

bool ActiveMover::load_member(std::size_t i, const TimeSpan& step, IslandMember& member) {
    const TimeSpan life = life_in(parts_.store.particles(), i, step);
    if (life.end <= life.begin) return false;
    grow_core(parts_.store, response_.rules().bodies, i, life.begin);
    member.particle = i;
    member.moving = load(i, life.begin);
    if (life.begin != step.begin || life.end != step.end) member.moving.planned = nullptr;
    member.end = life.end;
    member.is_fixed = parts_.store.is_fixed(i);
    member.is_free = parts_.schedule.is_in_free_flight(i);
    member.keeps_path = parts_.hooks.observers.needs().pieces;
    return true;
}

void ActiveMover::write_back(IslandMember& member, const TimeSpan& step, BlockRecord& record) {
    const std::size_t i = member.particle;
    MovingParticle& moving = member.moving;
    const TimeSpan life = life_in(parts_.store.particles(), i, step);
    if (const MoveObservers& observers = parts_.hooks.observers; !observers.empty() && !member.is_fixed) {
        const Particles& p = parts_.store.particles();
        const Vec3 spin = parts_.store.load(i, life.begin, false).spin;
        MoveReport report = report_of(i, {p.position[i], p.velocity[i], spin}, moving, life.end, member.lists);
        report.pieces = member.trajectory;
        observers.report(report, record);
    }
    for (ContactRecord& contact : member.lists.records) {
        if (moving.state.whole_radius > 0.0) contact.radius = moving.state.whole_radius;
    }
    record_lists(member.lists, record);
    if (!member.is_fixed && life.begin == step.begin && life.end == step.end) record_deviation(member);
    if (i < bounces_.size()) bounces_[i] += member.outcome.meetings();
    if (member.is_fixed) {
        parts_.schedule.leave_alone(i);
        return;
    }
    // A sphere that has slept on surfaces alone has pressed on them until now, so its weight is added.
    if (parts_.store.is_asleep(i)) record.counts.lost_impulses += add_weight(i, life.begin, 1.0);
    write_back(i, moving, member.outcome, life.end, {member.lists.hits, {}, member.pair_velocity_change}, record);
}

void ActiveMover::move_as_system(const ParticleRange& range, const TimeSpan& step, std::vector<BlockRecord>& blocks) {
    std::vector<SystemParticle> system(range.size());
    for (std::size_t k = 0; k < system.size(); ++k) {
        const std::size_t i = range.begin + k;
        const TimeSpan life = life_in(parts_.store.particles(), i, step);
        grow_core(parts_.store, response_.rules().bodies, i, life.begin);
        system[k].particle = load(i, life.begin);
        system[k].start = life.begin;
        system[k].stop = life.end;
        system[k].is_out = parts_.store.is_fixed(i);
    }
    blocks.resize(std::max(blocks.size(), blocks_of(system.size())));
    std::vector<MoveScratch> scratch(blocks.size());
    for (MoveScratch& block : scratch) prepare(block);
    move_together(response_.rules(), system, step.begin, step.end, scratch, kParticleBlock);
    for (std::size_t k = 0; k < system.size(); ++k) {
        const std::size_t i = range.begin + k;
        const SystemParticle& moved = system[k];
        if (parts_.store.is_fixed(i) || moved.stop <= moved.start) continue;
        BlockRecord& record = blocks[k / kParticleBlock];
        if (!parts_.hooks.observers.empty()) {
            MoveReport report{i, parts_.store.particles(), moved.particle.state};
            report.end = report.stored_time = moved.stop;
            report.segments = moved.segments;
            parts_.hooks.observers.report(report, record);
        }
        const bool as_planned = moved.start == step.begin && moved.stop == step.end;
        if (as_planned && coupled().wants_deviation_of(i)) {
            std::vector<FlownPiece> flown;
            record_deviation(i, moved.particle, moved.outcome, flown, moved.surface_impulse);
        }
        write_back(i, moved.particle, moved.outcome, moved.stop, {{}, moved.surface_impulse, {}}, record);
    }
    for (std::size_t k = 0; k < blocks.size(); ++k) record_lists(scratch[k], blocks[k]);
}

std::vector<ColliderLoad> ActiveMover::preview(const ParticleRange& range, const TimeSpan& step) {
    std::vector<std::vector<ColliderLoad>> blocks(blocks_of(range.size()));
    parallel_for_blocks(range.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        MoveScratch scratch;
        scratch.record_loads = true;
        for (std::size_t i = range.begin + begin; i < range.begin + end; ++i) {
            const TimeSpan life = life_in(parts_.store.particles(), i, step);
            if (parts_.store.is_fixed(i) || life.end <= life.begin) continue;
            const ForceInput state = parts_.store.force_input(i, life.begin);
            if (!is_near_dynamic_body(response_.rules(), state, life.end - life.begin)) continue;
            MovingParticle particle = load(i, life.begin);
            particle.step_end = life.end;
            static_cast<void>(response_.move(particle, life.end - life.begin, scratch));
            scratch.hits.clear();
        }
        blocks[block] = std::move(scratch.loads);
    });
    std::vector<ColliderLoad> all;
    for (const auto& loads : blocks) all.insert(all.end(), loads.begin(), loads.end());
    return all;
}

}  // namespace ricochet
