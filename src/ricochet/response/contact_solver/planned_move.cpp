#include "ricochet/response/contact_solver/planned_move.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/carried_particle.h"
#include "ricochet/response/contact_solver/wall_contacts.h"
#include "ricochet/response/particle_step.h"
#include "ricochet/response/path_motion.h"

namespace ricochet {
namespace {

/// Corrections of the end of a chord. Local: the segment is certified.
constexpr int kCorrections = 3;

/// Corrections of the end of a chord between moving surfaces and others. If each pass leaves three quarters of the
/// error, as in a wedge, 1e-4 of it remains. Local: the segment is certified.
constexpr int kCorrectionsInWedge = 32;

class PlannedMove {
public:
    PlannedMove(const ResponseRules& rules, MovingParticle& particle, const PlannedMotion& plan, MoveScratch& scratch)
        : rules_(rules),
          particle_(particle),
          plan_(plan),
          scratch_(scratch),
          step_(rules, particle, plan.duration, scratch) {}

    MoveOutcome run();

private:
    void collect_impulses();
    void follow();
    [[nodiscard]] Path next_line() const;
    void divert(const Contact& contact);
    [[nodiscard]] bool touches(SurfaceId surface) const;
    [[nodiscard]] Vec3 along_those_met(const Vec3& velocity) const;
    [[nodiscard]] const ContactSurface* most_approached(const Vec3& velocity) const;
    void cut_across();
    void find_walls(const Vec3& center, double time, std::vector<WallContact>& found) const;
    [[nodiscard]] bool keep_off_walls(Vec3& end, double time) const;
    [[nodiscard]] Vec3 velocity_of(const ContactSurface& surface) const {
        return rules_.bodies.empty() ? Vec3{} : step_.impact().surfaces().velocity_of(surface);
    }
    [[nodiscard]] CollisionWorld::Nearest nearest(SurfaceId surface, const Vec3& p, double time) const;
    [[nodiscard]] Vec3 kept_off(Vec3 end, double time, std::span<const SurfaceId> surfaces) const;
    [[nodiscard]] std::vector<SurfaceId> passed_by(const Path& line);
    void come_off(const Contact& contact);
    void hold(SurfaceId surface);

    const ResponseRules& rules_;
    MovingParticle& particle_;
    const PlannedMotion& plan_;
    MoveScratch& scratch_;
    mutable ParticleStep step_;
    std::vector<ContactSurface> met_;  // surfaces that have blocked the particle and are still touched
    std::vector<SurfaceId> held_;      // moving surfaces that push or block the particle, in ascending order
};

MoveOutcome PlannedMove::run() {
    particle_.contact = {};
    particle_.candidates = {};
    particle_.attachment.reset();
    collect_impulses();
    particle_.spin = plan_.spin;
    particle_.state.velocity = plan_.velocity;
    if (catch_up(step_)) follow();
    keep_stored_position(step_);
    scratch_.driven = true;
    step_.log().note_impact();
    scratch_.driven = false;
    return step_.outcome();
}

/// Follows the plan in straight lines. Each line ends clear of the surfaces in held_ at the end of the step.
void PlannedMove::follow() {
    if (plan_.is_clear && held_.empty() && can_be_followed(next_line())) {
        follow_clear_path(step_, next_line());
        return;
    }
    for (int k = 0; k < kMostDiversions && step_.remaining() > 0.0; ++k) {
        const Vec3 velocity = particle_.state.velocity;
        const Path path = next_line();
        const std::vector<SurfaceId> along = passed_by(path);
        const std::optional<Contact> contact = follow_path(step_, path, along);
        particle_.state.velocity = velocity;
        if (!contact) break;
        divert(*contact);
        if (!along.empty()) come_off(*contact);
        for (const ContactSurface& surface : contact->all()) hold(surface.surface);
    }
    if (step_.remaining() > 0.0) cut_across();
    if (!(step_.remaining() > 0.0)) return;
    if (step_.is_near_bodies()) {
        give_up(step_);
    } else {
        static_cast<void>(wait_in_place(step_, step_.remaining()));
    }
}

/// Returns the line of the current velocity, with its end moved clear of the surfaces in held_.
Path PlannedMove::next_line() const {
    const ForceInput& state = particle_.state;
    const double duration = step_.remaining();
    Path line = line_path(state.position, state.velocity, duration);
    if (held_.empty()) return line;
    const Vec3 end = kept_off(state.position + duration * state.velocity, particle_.step_end, held_);
    line = line_path(state.position, (end - state.position) / duration, duration);
    line.end = end;
    return line;
}

/// Moves along a chord to a position clear of the walls. Inside a sphere, a line along the surface leads into it.
void PlannedMove::cut_across() {
    const ForceInput& state = particle_.state;
    const Vec3 velocity = state.velocity;
    const double duration = step_.remaining();
    Vec3 end = state.position + duration * velocity;
    for (int pass = 0; pass < kCorrections && !keep_off_walls(end, particle_.step_end); ++pass) continue;
    end = flush_tiny(end);
    Path path = line_path(state.position, (end - state.position) / duration, duration);
    path.end = end;
    const std::optional<Contact> contact = follow_path(step_, path);
    particle_.state.velocity = velocity;
    if (contact) divert(*contact);
}

/// Moves a position off the walls that the particle would touch there at a time, in s. Makes a single pass. Returns
/// true if the particle would touch no wall at the given position, which then stays the same.
bool PlannedMove::keep_off_walls(Vec3& end, double time) const {
    std::vector<WallContact> walls;
    find_walls(end, time, walls);
    const double offset = 2.0 * contact_offset(end);
    std::erase_if(walls, [&](const WallContact& wall) { return wall.gap >= offset; });
    for (const WallContact& wall : walls) end += (2.0 * offset - wall.gap) * wall.normal;
    return walls.empty();
}

/// Finds the walls that the particle would touch at a position and a time, in s.
void PlannedMove::find_walls(const Vec3& center, double time, std::vector<WallContact>& found) const {
    const double radius = particle_.state.radius;
    const double reach = 4.0 * contact_offset(center);
    const SurfaceGeometry geometry(rules_.world, scratch_.contacts.plane_cache);
    static_cast<void>(find_wall_contacts(rules_.bodies, geometry, {time, time}, center, radius, reach, found));
}

/// Records the planned effects of walls at the start of the step.
void PlannedMove::collect_impulses() {
    for (const WallImpulse& impulse : plan_.impulses) {
        step_.impact().ledger().record_impulse(impulse.surface, impulse.velocity_change, false, impulse.spin_change);
        hold(impulse.surface);
    }
}

/// Adds a moving surface to held_. Lines along a surface at rest stay clear of it anyway.
void PlannedMove::hold(SurfaceId surface) {
    if (rules_.bodies.body_of(surface) == kWorldBody) return;
    const auto at = std::lower_bound(held_.begin(), held_.end(), surface);
    if (at == held_.end() || *at != surface) held_.insert(at, surface);
}

/// Returns the point nearest to p of a surface at a time, in s.
CollisionWorld::Nearest PlannedMove::nearest(SurfaceId surface, const Vec3& p, double time) const {
    return SurfacesInTime(rules_.bodies, kWorldBody, time).nearest(surface, {p, 0.0, p});
}

/// Moves a position off the given surfaces at a time, in s, and off walls that it then touches.
Vec3 PlannedMove::kept_off(Vec3 end, double time, std::span<const SurfaceId> surfaces) const {
    const double radius = particle_.state.radius;
    bool was_put_off = false;
    for (int pass = 0; pass < kCorrectionsInWedge; ++pass) {
        bool is_off = true;
        for (const SurfaceId surface : surfaces) {
            const CollisionWorld::Nearest there = nearest(surface, end, time);
            const double missing = radius + 2.0 * contact_offset(end) - there.distance;
            if (missing <= 0.0) continue;
            end += missing * there.normal;
            is_off = false;
        }
        was_put_off = was_put_off || !is_off;
        if (was_put_off && !keep_off_walls(end, time)) is_off = false;
        if (is_off) break;
    }
    return flush_tiny(end);
}

/// Returns the surfaces in held_ that a line passes along: it ends clear of them and hardly comes nearer before.
std::vector<SurfaceId> PlannedMove::passed_by(const Path& line) {
    const double radius = particle_.state.radius;
    std::vector<SurfaceId> passed;
    for (const SurfaceId surface : held_) {
        const double at_end = nearest(surface, line.end, particle_.step_end).distance;
        if (at_end >= radius) passed.push_back(surface);
    }
    std::vector<SurfaceId> met;
    for (int k = 0; !passed.empty(); ++k) {
        if (k == kMostDiversions) return {};
        const std::optional<Contact> contact = first_contact_of_ball(step_, line, (1.0 - kChordSagitta) * radius, met);
        if (!contact) break;
        for (const ContactSurface& surface : contact->all()) {
            std::erase(passed, surface.surface);
            met.push_back(surface.surface);
        }
    }
    return passed;
}

/// Moves the particle off surfaces that are too near, because a line that a contact ends early may be too near.
void PlannedMove::come_off(const Contact& contact) {
    const ForceInput& state = particle_.state;
    std::vector<SurfaceId> near = held_;
    for (const ContactSurface& surface : contact.all()) near.push_back(surface.surface);
    const double least = state.radius - 0.5 * sphere_tolerance(state.radius, max_abs(state.position));
    const bool is_off = std::ranges::all_of(
        near, [&](SurfaceId surface) { return nearest(surface, state.position, state.time).distance >= least; });
    if (!is_off) shift_to(step_, kept_off(state.position, state.time, near));
}

/// Removes the velocity into the surfaces of a contact, and into earlier ones that are still touched.
void PlannedMove::divert(const Contact& contact) {
    std::erase_if(met_, [&](const ContactSurface& surface) { return !touches(surface.surface); });
    for (const ContactSurface& surface : contact.all()) met_.push_back(surface);
    const Vec3 before = particle_.state.velocity;
    particle_.state.velocity = along_those_met(before);
    step_.impact().ledger().record_impulse(contact.first().surface, particle_.state.velocity - before, false, Vec3{});
}

bool PlannedMove::touches(SurfaceId surface) const {
    const ForceInput& state = particle_.state;
    const double distance = nearest(surface, state.position, state.time).distance;
    return distance - state.radius <= kStillTouched * state.radius + 4.0 * contact_offset(state.position);
}

/// Returns a velocity without components into the surfaces in met_. If they block all directions, returns that of one.
Vec3 PlannedMove::along_those_met(const Vec3& velocity) const {
    ShortestShift shift;
    for (std::size_t k = 0;; ++k) {
        const Vec3 left = shift.is_empty() ? velocity : velocity + shift.vector();
        const ContactSurface* const surface = most_approached(left);
        if (surface == nullptr) return left;
        if (k == kMostSupports) return velocity_of(*surface);
        shift.add(surface->normal, -dot(velocity - velocity_of(*surface), surface->normal));
    }
}

/// Returns the surface in met_ that a velocity leads into fastest, beyond rounding, or null if it leads into none.
const ContactSurface* PlannedMove::most_approached(const Vec3& velocity) const {
    const ContactSurface* most = nullptr;
    double fastest = 0.0;
    for (const ContactSurface& surface : met_) {
        const Vec3 relative = velocity - velocity_of(surface);
        const double into = dot(relative, surface.normal);
        if (into >= fastest || into >= -kMinApproach * length(relative)) continue;
        fastest = into;
        most = &surface;
    }
    return most;
}

}  // namespace

MoveOutcome move_as_planned(const ResponseRules& rules, MovingParticle& particle, const PlannedMotion& plan,
                            MoveScratch& scratch) {
    return PlannedMove(rules, particle, plan, scratch).run();
}

}  // namespace ricochet
