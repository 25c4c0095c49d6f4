/// \file
/// Private to the responses that find the first contact of a path: one particle in one step.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/contact_query.h"
#include "ricochet/collision/moving_sweep.h"
#include "ricochet/collision/safe_position.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/impact_resolver.h"
#include "ricochet/response/motion_log.h"
#include "ricochet/response/reference_frame.h"

namespace ricochet {

/// Whether a contact that was found on an approximate path deserves a path that ends there. Each brings that nearer to
/// the way that it stands for, by its fourth power where it is a cubic between two states of that.
class RefinementBudget {
public:
    /// tried: where the contact is on the path; there: where the way is at that time, whose contact offset is given.
    [[nodiscard]] bool may_improve(const Vec3& tried, const Vec3& there, double offset) {
        return length(there - tried) > kTouchingOffsets * offset && ++looks_ <= kMost;
    }

private:
    static constexpr int kMost = 12;
    int looks_ = 0;
};

/// A particle's state within a step, the time that is left of it, and the outcome so far. It moves the particle along
/// paths in certified segments, and nothing else does. The state is given in the world, or in the frame of a body that
/// the particle rides on; what is stored is its position in the world.
class ParticleStep {
public:
    ParticleStep(const ResponseRules& rules, MovingParticle& particle, double duration, MoveScratch& scratch)
        : rules_(&rules),
          particle_(particle),
          scratch_(scratch),
          reference_(rules.bodies),
          geometry_(rules.world, scratch.contacts.plane_cache),
          impact_(rules, particle, scratch, outcome_, reference_),
          log_(rules, particle, scratch, reference_),
          start_(particle.state.position),
          stored_{particle.state.position, particle.stored_time},
          first_segment_(scratch.segments.size()),
          duration_(duration),
          remaining_(duration),
          resting_speed_(rules.settings.resting_speed) {}
    ParticleStep(const ParticleStep&) = delete;
    ParticleStep& operator=(const ParticleStep&) = delete;

    /// Moves the particle along the flight: to its end, or to a safe position at the contact that is returned. It is
    /// frozen where it cannot be followed. With a look-ahead the outcome tells how long it remains free.
    std::optional<Contact> follow(const Flight& flight, const Integrator& integrator, const LookAhead* look_ahead,
                                  const ContactCandidates& candidates);
    /// The same in contact with surfaces.
    std::optional<Contact> follow(const Flight& flight);
    /// The same for a path whose velocity is the particle's, along surfaces that hold it where there are any.
    std::optional<Contact> follow(const Path& path, std::span<const SurfaceId> supports = {}) {
        return follow(path, supports, [](double, const Path&) { return std::optional<Path>(); });
    }
    /// The same for a path that is only an approximation: shorter(time, path) says which path to try next where one has
    /// come to a contact at a time, or nothing where the path is close enough there.
    template <class Shorter>
    std::optional<Contact> follow(const Path& path, std::span<const SurfaceId> supports, const Shorter& shorter);
    /// Calls found(surface) for all surfaces near the particle: planes, shapes, triangles, each in ascending order.
    template <class Found>
    void visit_near(const Found& found);
    /// The same of the surfaces of a frame near a position there. beside: as ContactQuery::beside.
    template <class Found>
    void visit_near_in(const SurfaceGeometry& geometry, const Vec3& position, double beside, const Found& found);
    /// Lets time pass where the particle is, s. Returns what comes to it there.
    std::optional<Contact> wait(double duration, std::span<const SurfaceId> supports = {});
    /// Gives up the time that is left.
    void stop();
    /// Back along its own segments to where the step began, where nothing that moves is near.
    void return_to_start();
    /// To the end of a line that certainly meets nothing.
    void go_clear(const Path& line);
    /// True if a collider that moves, or a frame that carries the particle, may come to its position in the time left.
    [[nodiscard]] bool is_near_bodies() const {
        return is_among_bodies(line_path(particle_.state.position, Vec3{}, remaining_));
    }

    // Where colliders move.

    /// From now on the state is that in the frame of a body, by whose rules it goes on; `contact` too. rules: of that
    /// frame.
    void enter(BodyId body, const ResponseRules& rules, Contact* contact);
    /// From now on it is that in the world again.
    void leave(const ResponseRules& rules, Contact* contact);
    /// Until end_substep(): the step ends at this time, s, or where it ends anyway. After that the body's velocity may
    /// be another.
    void begin_substep(double until);
    void end_substep();
    /// The frame that the state is given in.
    [[nodiscard]] const ReferenceFrame& reference() const { return reference_; }
    /// Returns the first contact of a ball of the given radius, in m, on a path in the world. Moves nothing. supports:
    /// see ContactQuery::supports.
    [[nodiscard]] std::optional<Contact> first_contact(const Path& path, double radius,
                                                       std::span<const SurfaceId> supports) {
        return first_contact_among_bodies({path, radius, nullptr, {}, supports});
    }
    /// Moves it in no time to a position in the world, where that is a free link; else it stays.
    void shift_to(const Vec3& position);
    /// Where the clock of the particle stood still in steps before: makes it go on, if it can. False where it cannot.
    [[nodiscard]] bool catch_up();
    /// At the end of the move.
    void store_position();

    /// In the frame that the state is given in.
    [[nodiscard]] const ResponseRules& rules() const { return *rules_; }
    [[nodiscard]] MovingParticle& particle() { return particle_; }
    [[nodiscard]] ForceInput& state() { return particle_.state; }
    [[nodiscard]] const SurfaceGeometry& geometry() const { return geometry_; }
    [[nodiscard]] ImpactResolver& impact() { return impact_; }
    [[nodiscard]] MotionLog& log() { return log_; }
    [[nodiscard]] MoveOutcome& outcome() { return outcome_; }
    /// m/s, of the slowest rebound that is one: the scene's, or what a body that yields makes of it.
    [[nodiscard]] double resting_speed() const { return resting_speed_; }
    void set_resting_speed(double speed) { resting_speed_ = speed; }
    /// Of an interval of contact, each of which is a problem or more to solve.
    void note_interval() { ++intervals_; }
    /// False where impacts have spent the budget of bounces. Beyond the intervals that may follow one impact each few
    /// of them spend as much as an impact: they take longer. What slides fast in a round shape that it hardly fits
    /// into, or under forces beyond measure, would spend as many again after each of its impacts.
    [[nodiscard]] bool has_budget() const {
        const std::uint32_t intervals = std::max(intervals_, kFreeIntervals) - kFreeIntervals;
        const std::uint32_t spent = particle_.bounces_before + outcome_.meetings() + intervals / kIntervalsOfBounce;
        return spent < rules_->settings.bounce_budget;
    }
    /// True while contact may have another interval.
    [[nodiscard]] bool has_intervals() const { return intervals_ < kFreeIntervals || has_budget(); }
    [[nodiscard]] double duration() const { return duration_; }    ///< s, of the whole step
    [[nodiscard]] double remaining() const { return remaining_; }  ///< s, that are left of it
    /// Where the step began: off the surface that the particle was put on, if it was.
    [[nodiscard]] const Vec3& start() const { return start_; }

private:
    /// How far a particle has come along a path among bodies.
    struct Travel {
        std::optional<Contact> contact{};  ///< what it has come to
        double elapsed = 0.0;              ///< s
    };

    [[nodiscard]] bool can_follow(const Path& path);
    [[nodiscard]] bool is_among_bodies(const Path& path) const;
    [[nodiscard]] double go(const ContactQuery& query, ContactQueryResult& found);
    [[nodiscard]] double go_along(const ContactQuery& query, ContactQueryResult& found, const PathClock& clock);
    [[nodiscard]] std::optional<Contact> follow_among_bodies(const Flight& flight, const Integrator& integrator);
    [[nodiscard]] Travel travel_among_bodies(const ContactQuery& query);
    [[nodiscard]] std::optional<Contact> first_contact_among_bodies(const ContactQuery& query);
    [[nodiscard]] PathClock clock_of(const Path& path) const;
    [[nodiscard]] MovingView view_of(const Path& path) const {
        return {*rules_->bodies, reference_.body(), clock_of(path)};
    }
    void record_flown_in_world(const Path& path, double duration, const Vec3& separation_speed);
    [[nodiscard]] PathPoint here(const MovingView& view) const { return view.stored(stored_.position, 0.0); }
    void turn_contact(Contact* contact, const ReferenceFrame& from, const ReferenceFrame& to) const;
    [[nodiscard]] bool carry_on(BodyId frame, double until);
    [[nodiscard]] bool carry(BodyId frame, const Vec3& local_position, double until, int depth);
    [[nodiscard]] bool take_segment(const StoredPosition& next);
    void advance_along_segment(const StoredPosition& next);
    [[nodiscard]] bool take_late_segment(const Vec3& position);
    [[nodiscard]] bool catch_up_directly();
    [[nodiscard]] bool is_segment_free_of_bodies(const StoredPosition& from, const StoredPosition& to) const;
    [[nodiscard]] Vec3 carried_by_mesh(SurfaceId surface, double until) const;
    [[nodiscard]] bool carry_by_mesh(SurfaceId surface, double until, int depth);
    [[nodiscard]] bool carry_by_meshes(double until);
    [[nodiscard]] bool is_segment_free(const StoredPosition& from, const StoredPosition& to) const;
    [[nodiscard]] bool is_segment_free(const SurfacesInOtherFrames& foreign, const PathPoint& from,
                                       const PathPoint& to) const {
        const PathClock& clock = foreign.view().clock();
        return is_segment_free({from.world, clock.at(from.time)}, {to.world, clock.at(to.time)});
    }
    [[nodiscard]] bool wait_out(double until);
    void wait_by_turns(double until);
    [[nodiscard]] bool wait_with_clearance(double until);
    [[nodiscard]] bool step_aside(BodyId frame, double clearance);
    [[nodiscard]] double rounding_in(BodyId frame, double until) const;
    void stop_at_contact(const ContactQuery& query, ContactQueryResult& found);
    [[nodiscard]] CertifiedPath follow_freely(const NearSurfaces& near, const ContactQuery& query);
    void leave_surface(const NearSurfaces& near);
    void stay_until(double until);
    [[nodiscard]] bool step_off_in_frame(const NearSurfaces& near);
    void record_chain(const PathClock& clock);
    void pass(double duration);
    /// Of a piece of what the particle has flown, after it.
    void record_flown(const Path& path, double duration, const Vec3& separation_speed, bool is_free) {
        if (!scratch_.record_flown) return;
        if (reference_.is_moving()) {
            record_flown_in_world(path, duration, separation_speed);
            return;
        }
        scratch_.flown.push_back(
            {path, state().time - duration, duration, separation_speed, state().velocity, is_free});
    }

    const ResponseRules* rules_;
    MovingParticle& particle_;
    MoveScratch& scratch_;
    ReferenceFrame reference_;
    SurfaceGeometry geometry_;
    MoveOutcome outcome_;
    ImpactResolver impact_;
    MotionLog log_;
    Vec3 start_;
    StoredPosition stored_;              // where something moves
    std::optional<double> substep_end_;  // s, of begin_substep()
    double rest_after_substep_ = 0.0;    // s
    double whole_step_end_ = 0.0;        // s
    std::size_t first_segment_;          // of this step among those recorded
    double duration_;
    double remaining_;
    double resting_speed_;
    std::uint32_t intervals_ = 0;  // of contact, so far
};

template <class Shorter>
std::optional<Contact> ParticleStep::follow(const Path& path, std::span<const SurfaceId> supports,
                                            const Shorter& shorter) {
    if (!can_follow(path)) return std::nullopt;
    const Vec3 separation_speed = state().velocity;
    Path followed = path;
    const ContactQuery query{followed, state().radius, nullptr, {}, supports};
    const auto takes_shorter = [&](const std::optional<Contact>& contact) {
        const std::optional<Path> next = contact ? shorter(contact->time, followed) : std::nullopt;
        // In next to no time a cubic has coefficients beyond all bounds; the longer path will do.
        if (!next || !can_be_followed(*next)) return false;
        followed = *next;
        return true;
    };
    if (is_among_bodies(followed)) {
        while (takes_shorter(first_contact_among_bodies(query))) {
        }
        const Travel travelled = travel_among_bodies(query);
        state().velocity = followed.velocity(travelled.elapsed);
        record_flown(followed, travelled.elapsed, separation_speed, false);
        return travelled.contact;
    }
    ContactQueryResult found = find_first_contact(geometry_, query, scratch_.contacts);
    while (takes_shorter(found.contact)) found = find_first_contact(geometry_, query, scratch_.contacts);
    const double elapsed = go(query, found);
    state().velocity = followed.velocity(elapsed);
    record_flown(followed, elapsed, separation_speed, false);
    return found.contact;
}

template <class Found>
void ParticleStep::visit_near(const Found& found) {
    const double beside = reference_.is_moving() ? kTouchingOffsets * geometry_.contact_offset(state().position) : 0.0;
    visit_near_in(geometry_, state().position, beside, found);
}

template <class Found>
void ParticleStep::visit_near_in(const SurfaceGeometry& geometry, const Vec3& position, double beside,
                                 const Found& found) {
    const Path here = line_path(position, Vec3{}, 0.0);
    (void)find_first_contact(geometry, {here, state().radius, nullptr, {}, {}, beside}, scratch_.contacts);
    const CollisionWorld& world = geometry.world();
    for (const std::uint32_t k : scratch_.contacts.planes) found(world.planes()[k].surface);
    for (const std::uint32_t k : scratch_.contacts.shapes) {
        const CollisionWorld::ShapeSurface& shape = world.shapes()[k];
        for (SurfaceId part = 0; part < shape.shape.part_count(); ++part) found(shape.surface + part);
    }
    // The broad phase's own order is nobody's promise, and of many surfaces the first ones count.
    std::vector<std::uint32_t>& triangles = scratch_.contacts.triangles;
    std::sort(triangles.begin(), triangles.end());
    for (const std::uint32_t triangle : triangles) found(world.surface_of_triangle(triangle));
}

/// Puts a particle whose centre lies exactly on a surface, and so has no side yet, on the side that the normal points
/// to. near: of a path that starts there. False when no certified position was found; the particle stays then.
bool step_off_surface(const NearSurfaces& near, ForceInput& state, MoveScratch& scratch);

}  // namespace ricochet
