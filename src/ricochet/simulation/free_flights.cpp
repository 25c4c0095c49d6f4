#include "ricochet/simulation/free_flights.h"

#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/clear_flight.h"
#include "ricochet/simulation/cloud_motion.h"

namespace ricochet {
namespace {

/// Number of particles between the prefetch of a particle and its use.
constexpr std::size_t kPrefetchDistance = 6;

}  // namespace

ActiveSet FreeFlights::advance(const ParticleRange& range, const TimeSpan& step, std::vector<BlockRecord>& blocks) {
    if (deferred_ && deferred_->is_full()) catch_up_all();
    const std::optional<Vec3>& common = rules_.forces.common_acceleration();
    const FreeFlight shared(rules_.settings.integrator, common.value_or(Vec3{}), step.end - step.begin);
    std::vector<std::size_t> sizes(blocks_of(range.size()));
    const bool records = hooks_.observers.needs().has_path();
    // In a substep, the particles would count as free in the next substeps, too.
    const bool may_fly_clear = schedule_.keeps_clear_spaces() && schedule_.is_whole_step(step);
    if (records) blocks.resize(std::max(blocks.size(), sizes.size()));
    parallel_for_blocks(range.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        begin += range.begin;
        end += range.begin;
        BlockRecord* const record = records ? &blocks[block] : nullptr;
        if (deferred_) {
            // They are advanced later.
        } else if (common && !records) {
            advance_together(begin, end, shared);
        } else {
            advance_each(begin, end, step, record);
        }
        if (may_fly_clear) fly_in_clear_spaces(begin, end, step, record);
        sizes[block] = schedule_.count_active(begin, end);
    });
    ActiveSet active(std::move(sizes));
    parallel_for_blocks(range.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        std::uint32_t* next = active.block(block).data();
        schedule_.visit_active(range.begin + begin, range.begin + end,
                               [&](std::size_t i) { *next++ = static_cast<std::uint32_t>(i); });
        if (deferred_) catch_up_active(active.block(block));
    });
    if (deferred_) deferred_->add(shared);
    return active;
}

// Contains only necessary operations, because most particles of most steps go through this loop.
void FreeFlights::advance_together(std::size_t begin, std::size_t end, const FreeFlight& flight) {
    Particles& particles = store_.particles();
    for (std::size_t i = begin; i < end; ++i) {
        if (!schedule_.is_in_free_flight(i)) continue;
        const PhaseState state = flight.step(particles.position[i], particles.velocity[i]);
        particles.position[i] = state.position;
        particles.velocity[i] = state.velocity;
    }
}

void FreeFlights::advance_each(std::size_t begin, std::size_t stop, const TimeSpan& step, BlockRecord* record) {
    Particles& particles = store_.particles();
    const std::optional<Vec3>& common = rules_.forces.common_acceleration();
    for (std::size_t i = begin; i < stop; ++i) {
        if (!schedule_.is_in_free_flight(i)) continue;
        const Vec3 acceleration = common ? *common : rules_.forces.acceleration(store_.force_input(i, step.begin));
        const FreeFlight flight(rules_.settings.integrator, acceleration, step.end - step.begin);
        const PhaseState end = flight.step(particles.position[i], particles.velocity[i]);
        if (record != nullptr) report(i, piece_to(i, end, acceleration, step), step, *record);
        particles.position[i] = end.position;
        particles.velocity[i] = end.velocity;
    }
}

/// Moves active particles whose whole step certainly stays in their free space. The result has the same bits as a
/// contact query. These particles then count as particles in free flight.
void FreeFlights::fly_in_clear_spaces(std::size_t begin, std::size_t stop, const TimeSpan& step, BlockRecord* record) {
    Particles& particles = store_.particles();
    for (std::size_t i = begin; i < stop; ++i) {
        if (!schedule_.may_fly_clear(i)) continue;
        rules_.poll();
        const std::optional<Flight> flight = clear_flight(i, step);
        if (!flight) continue;
        if (record != nullptr) {
            const double duration = flight->path.duration;
            const double start = (step.begin + duration) - duration;  // computed like the beginning of a queried flight
            report(i, {flight->path, start, duration, particles.velocity[i], flight->end_velocity, true}, step,
                   *record);
        }
        particles.position[i] = flight->path.end;
        particles.velocity[i] = flight->end_velocity;
        schedule_.fly_this_step(i);
    }
}

/// Returns the flight of a particle over a step, if it stays in free space, and if the mover has nothing to report.
std::optional<Flight> FreeFlights::clear_flight(std::size_t i, const TimeSpan& step) const {
    const Particles& particles = store_.particles();
    const ClearSpace& clear = schedule_.clear(i);
    const bool lives =
        particles.birth_time[i] <= step.begin && particles.birth_time[i] + particles.lifetime[i] > step.end;
    if (!lives || step.end > clear.end) return std::nullopt;
    if (hooks_.clouds != nullptr && hooks_.clouds->has_parent(i)) return std::nullopt;
    const double duration = step.end - step.begin;
    const ForceInput state = store_.force_input(i, step.begin);
    const Flight flight = begin_flight(rules_.settings.integrator, rules_.forces, state, duration);
    if (flight.is_coarse || !flies_clear(clear, state, flight, duration)) return std::nullopt;
    if (length_squared(flight.end_velocity) > kMaxSpeed * kMaxSpeed) return std::nullopt;
    return flight;
}

/// Returns the path of a free flight of particle i over a step, which is not stored yet. It has the bits of a flight
/// that made a query, so results that follow from it do not depend on the query schedule. acceleration: in m/s^2.
/// end: the particle's state at the end.
FlownPiece FreeFlights::piece_to(std::size_t i, const PhaseState& end, const Vec3& acceleration,
                                 const TimeSpan& step) const {
    const IntegratorKind kind = rules_.settings.integrator.kind;
    const Vec3& from = store_.particles().position[i];
    const Vec3& velocity = store_.particles().velocity[i];
    const double duration = step.end - step.begin;
    Path path = kicks_first(kind)                       ? line_path(from, end.velocity, duration)
                : kind == IntegratorKind::forward_euler ? line_path(from, velocity, duration)
                                                        : parabola_path(from, velocity, acceleration, duration);
    path.end = end.position;
    const double begin = (step.begin + duration) - duration;  // computed like the beginning of a queried flight
    return {path, begin, duration, velocity, end.velocity, true};
}

/// Reports a flight of particle i over a whole step that is not stored yet.
void FreeFlights::report(std::size_t i, const FlownPiece& piece, const TimeSpan& step, BlockRecord& record) const {
    const Particles& particles = store_.particles();
    ForceInput moved = store_.force_input(i, step.end);
    moved.position = piece.path.end;
    moved.velocity = piece.arrival;
    const Segment segment{particles.position[i], piece.path.end, step.begin};
    MoveReport report{i, particles, moved};
    report.end = report.stored_time = step.end;
    report.pieces = {&piece, 1};
    report.segments = {&segment, 1};
    hooks_.observers.report(report, record);
}

void FreeFlights::begin_deferring() {
    if (!deferred_ && rules_.forces.common_acceleration()) deferred_.emplace(store_.size());
}

void FreeFlights::end_deferring() {
    if (deferred_) catch_up_all();
    deferred_.reset();
}

void FreeFlights::catch_up(std::size_t i) {
    Particles& particles = store_.particles();
    const PhaseState state = deferred_->after(i, {particles.position[i], particles.velocity[i]});
    particles.position[i] = state.position;
    particles.velocity[i] = state.velocity;
}

// Integrates the deferred steps of the active set. The next particles are prefetched from memory at the same time.
void FreeFlights::catch_up_active(std::span<const std::uint32_t> active) {
    const Particles& particles = store_.particles();
    for (std::size_t k = 0; k < active.size(); ++k) {
        if (k + kPrefetchDistance < active.size()) {
            prefetch_vector(particles.position[active[k + kPrefetchDistance]]);
            prefetch_vector(particles.velocity[active[k + kPrefetchDistance]]);
        }
        catch_up(active[k]);
        deferred_->make_next(active[k]);
    }
}

void FreeFlights::catch_up_all() {
    if (deferred_->is_empty()) return;
    parallel_for(store_.size(), kParticleBlock, [&](std::size_t i) {
        if (!schedule_.is_left_alone(i)) catch_up(i);
    });
    deferred_->clear();
}

}  // namespace ricochet
