// Who has to be searched for in a step, in which order, and how each is moved.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "ricochet/core/box3.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {
namespace {

/// Order pays for neither few particles nor few triangles, whose hierarchy stays in the nearest memory anyway.
constexpr std::size_t kFewActive = 512;
constexpr std::size_t kFewTriangles = 1024;

/// Particles from the fetch of one from memory to its move.
constexpr std::size_t kPrefetchDistance = 6;

/// The same, to the triangles that it awaits, and to their corners.
constexpr std::size_t kTrianglePrefetchDistance = 4;
constexpr std::size_t kVertexPrefetchDistance = 2;

/// It may lie across two lines of the cache.
void prefetch_vector(const Vec3& v) {
    __builtin_prefetch(&v.x, 1);
    __builtin_prefetch(&v.z, 1);
}

std::uint32_t saturating_sum(std::uint32_t a, std::uint32_t b) {
    return a + std::min(b, std::numeric_limits<std::uint32_t>::max() - a);
}

}  // namespace

// Between the steps of advance() nothing looks at a particle that is_in_free_flight. But bounds and checks do in every
// step.
void Simulation::Impl::begin_deferring() {
    const bool is_watched = check || offspring || bounds || coupled.is_active();
    if (!is_watched && !deferred && options.look_ahead && forces.common_acceleration())
        deferred.emplace(particles.size());
}

void Simulation::Impl::end_deferring() {
    if (deferred) catch_up_all();
    deferred.reset();
}

void Simulation::Impl::catch_up(std::size_t i) {
    const PhaseState state = deferred->after(i, {particles.position[i], particles.velocity[i]});
    particles.position[i] = state.position;
    particles.velocity[i] = state.velocity;
}

// What they owe is worked out while the next ones are on their way from memory.
void Simulation::Impl::catch_up_part(std::span<const std::uint32_t> due) {
    for (std::size_t k = 0; k < due.size(); ++k) {
        if (k + kPrefetchDistance < due.size()) {
            prefetch_vector(particles.position[due[k + kPrefetchDistance]]);
            prefetch_vector(particles.velocity[due[k + kPrefetchDistance]]);
        }
        catch_up(due[k]);
        deferred->make_next(due[k]);
    }
}

void Simulation::Impl::catch_up_all() {
    if (deferred->is_empty()) return;
    parallel_for_blocks(particles.size(), kParticleBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (next_query_step[i] != kStill) catch_up(i);
        }
    });
    deferred->clear();
}

// Particles that meet nothing go on here. The others are due, listed in their order. Depths of penetration are added up
// by blocks of all particles, due or not; no other sum depends on how the list is cut.
ActiveSet Simulation::Impl::advance_free_flights(std::size_t first, double from, double to,
                                                 std::vector<BlockCounts>& blocks) {
    const std::size_t count = particles.size() - first;
    if (deferred && deferred->is_full()) catch_up_all();
    ActiveSet due;
    std::vector<std::size_t>& ends = due.ends;
    ends.resize(blocks_of(count));
    if (check) grow_to(blocks, ends.size());
    parallel_for_blocks(count, kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        auto* seen = check ? &blocks[block].violations : nullptr;
        ends[block] = advance_free_flights_of_block(first + begin, first + end, from, to, seen);
    });
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    due.particles.resize(ends.empty() ? 0 : ends.back());
    parallel_for_blocks(count, kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        std::uint32_t* next = due.particles.data() + (block == 0 ? 0 : ends[block - 1]);
        visit_active(first + begin, first + end, [&](std::size_t i) { *next++ = static_cast<std::uint32_t>(i); });
        if (deferred) catch_up_part(due.part(block));
    });
    if (deferred) deferred->add({options.integrator, *forces.common_acceleration(), to - from});
    if (options.response == ResponseKind::exact) due.cut_evenly();
    return due;
}

/// Returns how many are due. The loops that most particles of most steps go through: nothing but what they need.
std::size_t Simulation::Impl::advance_free_flights_of_block(std::size_t begin, std::size_t end, double from, double to,
                                                            std::vector<Violation>* seen) {
    const std::optional<Vec3>& common = forces.common_acceleration();
    const FreeFlight shared(options.integrator, common.value_or(Vec3{}), to - from);
    std::size_t due = 0;
    for (std::size_t i = begin; i < end; ++i) due += needs_query(i) ? 1 : 0;
    for (std::size_t i = begin; i < end && !deferred; ++i) {
        if (!is_in_free_flight(i)) continue;
        if (common && !check) {
            const PhaseState state = shared.step(particles.position[i], particles.velocity[i]);
            particles.position[i] = state.position;
            particles.velocity[i] = state.velocity;
        } else {
            advance_free_flight(i, common ? shared : free_flight_of(i, from, to), from, to, seen);
        }
    }
    return due;
}

FreeFlight Simulation::Impl::free_flight_of(std::size_t i, double from, double to) const {
    return {options.integrator, forces.acceleration(input(i, from)), to - from};
}

// A step of a particle that meets nothing: the end of the path that would be searched.
void Simulation::Impl::advance_free_flight(std::size_t i, const FreeFlight& free_flight, double from, double to,
                                           std::vector<Violation>* seen) {
    const PhaseState end = free_flight.step(particles.position[i], particles.velocity[i]);
    if (check) {
        const Segment segment{particles.position[i], end.position, from};
        ForceInput moved = input(i, to);
        moved.position = end.position;
        moved.velocity = end.velocity;
        check->look_at(i, particles, moved, to, {&segment, 1}, *seen);
    }
    particles.position[i] = end.position;
    particles.velocity[i] = end.velocity;
}

// Neighbours in space look at the same triangles.
void Simulation::Impl::sort_by_position(ActiveSet& due) const {
    const bool pays = due.particles.size() >= kFewActive && world.triangles().size() >= kFewTriangles;
    if (!options.spatial_order || !pays || options.response != ResponseKind::exact) return;
    const Box3& box = world.triangle_bounds();
    const auto bits = static_cast<unsigned>(std::bit_width(particles.size()));
    std::vector<std::uint64_t> keys(due.particles.size());
    parallel_for_blocks(keys.size(), kParticleBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = due.particles[k];
            keys[k] = morton_key(particles.position[i], box, i, bits);
        }
    });
    parallel_sort(keys);
    parallel_for_blocks(keys.size(), kParticleBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) due.particles[k] = index_of_key(keys[k], bits);
    });
}

// What moving() and store() want of a particle, whose neighbours in space lie anywhere in memory.
void Simulation::Impl::fetch(std::size_t i) const {
    prefetch_vector(particles.position[i]);
    prefetch_vector(particles.velocity[i]);
    __builtin_prefetch(&next_query_step[i], 1);
    __builtin_prefetch(&candidates[i], 1);
    __builtin_prefetch(&particles.mass[i]);
    __builtin_prefetch(&particles.radius[i]);
    __builtin_prefetch(&particles.id[i]);
    __builtin_prefetch(&particles.spin[i]);
    __builtin_prefetch(&particles.draws[i]);
    __builtin_prefetch(&particles.birth_time[i]);
    __builtin_prefetch(&particles.lifetime[i]);
    __builtin_prefetch(&particles.frozen[i]);
    __builtin_prefetch(&particles.pinned[i]);
    __builtin_prefetch(&particles.absorbed[i]);
    __builtin_prefetch(&particles.held[i]);
    __builtin_prefetch(&particles.contacts[i], 1);
}

void Simulation::Impl::prefetch_triangles(std::size_t i) const {
    if (!candidates[i].is_known()) return;
    for (const std::uint32_t triangle : candidates[i].triangles()) __builtin_prefetch(&world.triangles()[triangle]);
}

void Simulation::Impl::prefetch_vertices(std::size_t i) const {
    if (!candidates[i].is_known()) return;
    for (const std::uint32_t triangle : candidates[i].triangles()) {
        for (const std::uint32_t vertex : world.triangles()[triangle]) {
            __builtin_prefetch(&world.vertices()[vertex].x);
            __builtin_prefetch(&world.vertices()[vertex].z);
        }
    }
}

void Simulation::Impl::move_active(std::span<const std::uint32_t> due, double from, double to, BlockCounts& counts) {
    thread_local MoveScratch scratch;
    scratch.hits.clear();
    scratch.records.clear();
    scratch.record_contacts = keeps_records();
    scratch.record_segments = check != nullptr;
    for (std::size_t k = 0; k < due.size(); ++k) {
        const std::uint32_t i = due[k];
        if (k + kPrefetchDistance < due.size()) fetch(due[k + kPrefetchDistance]);
        if (k + kTrianglePrefetchDistance < due.size()) prefetch_triangles(due[k + kTrianglePrefetchDistance]);
        if (k + kVertexPrefetchDistance < due.size()) prefetch_vertices(due[k + kVertexPrefetchDistance]);
        const double start = std::max(from, particles.birth_time[i]);
        const double stop = std::min(to, particles.birth_time[i] + particles.lifetime[i]);
        if (stop <= start) continue;
        MovingParticle particle = moving(i, start);
        scratch.segments.clear();
        // A planned flight's duration need not be the difference of the clock's times to the last bit.
        const bool as_planned = particle.planned != nullptr && start == from && stop == to;
        const double duration = as_planned ? particle.planned->path.duration : stop - start;
        const MoveOutcome outcome = response->move(particle, duration, scratch);
        if (check) check->look_at(i, particles, particle.state, stop, scratch.segments, counts.violations);
        book(i, particle, outcome, stop, counts);
    }
    if (!totals.empty()) add_hits(scratch.hits, counts);
    counts.records.insert(counts.records.end(), scratch.records.begin(), scratch.records.end());
}

// Takes over what came out of a particle's move, and notices one that forces have brought beyond all bounds.
void Simulation::Impl::book(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome, double until,
                            BlockCounts& counts) {
    const auto is_fast = [&] { return length_squared(particles.velocity[i]) > kMaxSpeed * kMaxSpeed; };
    const bool was_fast = is_fast();
    store(i, moved, outcome);
    if (!was_fast && is_fast() && (!counts.runaway || i < *counts.runaway)) counts.runaway = i;
    if (outcome.held) particles.accounted_until[i] = until;
    if (outcome.unsimulated_time > 0.0) counts.cut_off.push_back({i, outcome.unsimulated_time});
    next_query_step[i] = step_of_next_query(i, moved, outcome, until);
    candidates[i] = candidates_of_next_query(next_query_step[i], outcome, until);
    counts.add(outcome);
}

bool Simulation::Impl::flies_on(const MovingParticle& moved, const MoveOutcome& outcome) {
    return moved.support.count == 0 && moved.support.cascade_left == 0.0 && !outcome.resting && !outcome.frozen &&
           !outcome.absorbed;
}

std::uint32_t Simulation::Impl::step_of_next_query(std::size_t i, const MovingParticle& moved,
                                                   const MoveOutcome& outcome, double until) const {
    if (stands_still(i) || is_asleep(i)) return kStill;
    if (!flies_on(moved, outcome) || coupled.is_active()) return 0;
    return 1 + (outcome.free_for > 0.0 ? end_of_free_flight(i, until + outcome.free_for) : 0);
}

// They must be all that is near in the whole step, which the last one may exceed by rounding.
ContactCandidates Simulation::Impl::candidates_of_next_query(std::uint32_t again, const MoveOutcome& outcome,
                                                             double until) const {
    if (again == kStill || again == 0 || outcome.candidates_for == 0.0) return {};
    const std::uint64_t end =
        std::max<std::uint64_t>(again, statistics.steps + 2);  // of the step, as a number of steps
    if (end >= steps && !last_is_whole()) return {};
    return until + outcome.candidates_for >= time_at(end) ? outcome.candidates : ContactCandidates{};
}

bool Simulation::Impl::last_is_whole() const {
    return options.duration == static_cast<double>(steps) * options.time_step;
}

// Not the last step when it is shorter than the others, and not that in which the particle dies.
std::uint32_t Simulation::Impl::end_of_free_flight(std::size_t i, double free_until) const {
    const double until = std::min(free_until, particles.birth_time[i] + particles.lifetime[i]);
    const std::uint64_t most = std::min<std::uint64_t>(last_is_whole() ? steps : steps - 1, kStill - 2);
    auto step = static_cast<std::uint64_t>(std::min(until / options.time_step, static_cast<double>(most)));
    while (step > 0 && time_at(step) >= until) --step;
    return static_cast<std::uint32_t>(step);
}

// Arrays that say nothing new are neither read nor written: for particles in arbitrary order each costs a cache miss.
MovingParticle Simulation::Impl::moving(std::size_t i, double start) {
    MovingParticle particle{input(i, start), particles.spin[i], particles.id[i], particles.draws[i], {}};
    particle.candidates = candidates[i];
    if (!is_plain(i)) load_contact(i, particle);
    particle.sides = sides_of(i);
    if (offspring) particle.shatter_impulse = offspring->shatter_impulse(particles, i);
    particle.planned = coupled.flight_of(i);
    particle.state.coupling = coupled.coupling_of(i);
    return particle;
}

void Simulation::Impl::load_contact(std::size_t i, MovingParticle& particle) const {
    Support& support = particle.support;
    for (const SurfaceId surface : particles.support[i]) {
        if (surface != kNoSupport) support.surfaces[support.count++] = surface;
    }
    support.cascade_left = particles.cascade_left[i];
}

void Simulation::Impl::store(std::size_t i, const MovingParticle& moving, const MoveOutcome& outcome) {
    particles.position[i] = moving.state.position;
    particles.velocity[i] = moving.state.velocity;
    if (particles.spin[i] != moving.spin) particles.spin[i] = moving.spin;
    if (particles.draws[i] != moving.draws) particles.draws[i] = moving.draws;
    if (outcome.bounces > 0) particles.contacts[i] = saturating_sum(particles.contacts[i], outcome.bounces);
    if (outcome.unsimulated_time > 0.0) particles.unsimulated_time[i] += outcome.unsimulated_time;
    if (!is_plain(i) || !flies_on(moving, outcome)) store_contact(i, moving, outcome);
}

void Simulation::Impl::store_contact(std::size_t i, const MovingParticle& moving, const MoveOutcome& outcome) {
    particles.resting[i] = outcome.resting ? 1 : 0;
    particles.held[i] = outcome.held && !coupled.holds(i) ? 1 : 0;
    particles.frozen[i] = outcome.frozen ? 1 : 0;
    particles.absorbed[i] = outcome.shattered ? kShattered : outcome.absorbed ? 1 : 0;
    particles.support[i].fill(kNoSupport);
    std::copy_n(moving.support.surfaces.begin(), moving.support.count, particles.support[i].begin());
    particles.cascade_left[i] = moving.support.cascade_left;
}

}  // namespace ricochet
