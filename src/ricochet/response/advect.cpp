#include "ricochet/response/advect.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/particle_step.h"

namespace ricochet {
namespace {

/// Halvings of a step in search of the time at which the flow turns away from a wall: to the last bit of the time.
constexpr int kReleaseHalvings = 60;

/// A flow without its part into surfaces.
class FlowAlong final : public FlowField {
public:
    FlowAlong(const FlowField& flow, std::span<const Vec3> normals) : flow_(flow), normals_(normals) {}
    [[nodiscard]] Vec3 velocity(const Vec3& position, double time) const override {
        const Vec3 free = flow_.velocity(position, time);
        return normals_.empty() ? free : project_off(free, normals_);
    }
    [[nodiscard]] bool is_steady() const override { return flow_.is_steady(); }

private:
    const FlowField& flow_;
    std::span<const Vec3> normals_;
};

/// One particle that a flow carries through one step.
class Advector {
public:
    Advector(const ResponseRules& rules, MovingParticle& particle, double duration, MoveScratch& scratch)
        : rules_(rules),
          flow_(*rules.settings.flow),
          particle_(particle),
          state_(particle.state),
          step_(rules, particle, duration, scratch),
          manifold_(step_.geometry(), state_) {}

    MoveOutcome run();

private:
    void advance();
    void wait_for_release();
    void answer(const Contact& contact);
    void finish();

    [[nodiscard]] Vec3 flow_now() const { return flow_.velocity(state_.position, state_.time); }
    [[nodiscard]] bool stops_at_walls() const { return rules_.settings.walls == WallRule::stop; }
    [[nodiscard]] bool is_pressed_at(double time) const;
    [[nodiscard]] double time_to_release() const;
    [[nodiscard]] std::optional<std::size_t> hardest_pressed() const;
    [[nodiscard]] TouchRule touch_rule() const;

    [[nodiscard]] Path until_release(const Path& path, const Vec3& normal, const FlowField& along) const;
    [[nodiscard]] Path part_on_flat(const ContactSurface& support, Path path) const;
    [[nodiscard]] Path part_on_curved(const ContactSurface& support, Path path) const;

    const ResponseRules& rules_;
    const FlowField& flow_;
    MovingParticle& particle_;
    ForceInput& state_;
    ParticleStep step_;
    ContactManifold manifold_;
    double next_duration_ = 0.0;          // s, of an adaptive method
    std::uint32_t surface_segments_ = 0;  // paths along surfaces; they share the budget with the impacts
};

MoveOutcome Advector::run() {
    manifold_.touch_again(particle_.contact, touch_rule());
    particle_.contact = {};
    const MoveOutcome& outcome = step_.outcome();
    while (step_.remaining() > 0.0 && !outcome.is_frozen()) {
        if (outcome.bounces + surface_segments_ >= rules_.settings.bounce_budget) {
            step_.stop();
            break;
        }
        if (stops_at_walls() && is_pressed_at(state_.time)) {
            wait_for_release();
        } else {
            advance();
        }
    }
    if (!outcome.is_frozen()) finish();
    return outcome;
}

/// One path: to the end of the step or of the surface under the particle, or to the next contact.
void Advector::advance() {
    const FlowAlong along(flow_, manifold_.normals());
    const FlowPath free =
        flow_path(rules_.settings.integrator, along, state_.position, state_.time, step_.remaining(), next_duration_);
    next_duration_ = free.next_duration;
    Path path = free.path;
    const auto pressed = can_be_followed(path) ? hardest_pressed() : std::nullopt;
    if (pressed) {
        ++surface_segments_;
        const ContactSurface support = manifold_[*pressed];
        path = support.flat ? part_on_flat(support, until_release(path, support.normal, along))
                            : part_on_curved(support, path);
        if (!(path.duration > 0.0)) {  // it is past that surface's end
            manifold_.remove(*pressed);
            return;
        }
    }
    const auto contact = step_.follow(path);
    if (step_.outcome().is_frozen()) return;
    manifold_.touch_again(touch_rule());
    if (contact) answer(*contact);
}

/// Time passes at a wall, until the flow turns away.
void Advector::wait_for_release() {
    step_.wait(time_to_release());
    if (step_.remaining() > 0.0) manifold_.clear();  // it is free
}

/// Counts an impact; its surfaces come first in the manifold.
void Advector::answer(const Contact& contact) {
    ++step_.outcome().bounces;
    manifold_.remember(contact.all());
    manifold_.replace(contact.all(), touch_rule());
    const Vec3 arriving = state_.velocity;
    const bool stops = stops_at_walls() && is_pressed_at(state_.time);
    state_.velocity = stops ? Vec3{} : project_off(flow_now(), manifold_.normals());
    for (const ContactSurface& surface : contact.all()) {
        step_.impact().push(surface.surface, Vec3{}, true);
        step_.impact().record(surface, arriving);
    }
}

/// The velocity that the particle goes on with, and what it is pressed onto.
void Advector::finish() {
    MoveOutcome& outcome = step_.outcome();
    const bool pressed = is_pressed_at(state_.time);
    state_.velocity = pressed && stops_at_walls()
                          ? Vec3{}
                          : FlowAlong(flow_, manifold_.normals()).velocity(state_.position, state_.time);
    if (!pressed) return;
    particle_.contact = manifold_.kept();
    if (state_.velocity != Vec3{}) return;
    // In a steady flow what does not move never will.
    const bool stays = flow_.is_steady() && outcome.unsimulated_time == 0.0;
    outcome.end = stays ? MoveEnd::held : MoveEnd::resting;
}

bool Advector::is_pressed_at(double time) const {
    const Vec3 g = flow_.velocity(state_.position, time);
    const auto normals = manifold_.normals();
    return std::any_of(normals.begin(), normals.end(), [&](const Vec3& normal) { return dot(g, normal) < 0.0; });
}

double Advector::time_to_release() const {
    const double remaining = step_.remaining();
    if (flow_.is_steady() || is_pressed_at(state_.time + remaining)) return remaining;
    double held = 0.0;
    double free = remaining;
    for (int k = 0; k < kReleaseHalvings; ++k) {
        const double middle = 0.5 * (held + free);
        (is_pressed_at(state_.time + middle) ? held : free) = middle;
    }
    return free;
}

/// The contact point that the flow presses the particle onto most; nothing when it presses on none.
std::optional<std::size_t> Advector::hardest_pressed() const {
    const Vec3 g = flow_now();
    std::optional<std::size_t> hardest;
    double most = 0.0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const double pressing = -dot(g, manifold_.normals()[k]);
        if (!(pressing > most)) continue;
        most = pressing;
        hardest = k;
    }
    return hardest;
}

/// Beside a rim half of what a path goes beyond it, so that at its end the surface is surely left.
TouchRule Advector::touch_rule() const {
    TouchRule rule = TouchRule::at(state_.position);
    rule.beyond_rim *= 0.5 * kEdgeOffsets / kTouchingOffsets;
    return rule;
}

/// A path along a flat surface, up to where the flow turns away from it. The cubic through both ends would dip into the
/// surface before an end that leaves it; up to there it has no part along the normal.
Path Advector::until_release(const Path& path, const Vec3& normal, const FlowField& along) const {
    Path held = path;
    const auto leaves = [&](double s) { return dot(flow_.velocity(path.position(s), state_.time + s), normal) > 0.0; };
    if (leaves(path.duration)) {
        double before = 0.0;
        double after = path.duration;
        for (int k = 0; k < kReleaseHalvings; ++k) {
            const double middle = 0.5 * (before + after);
            (leaves(middle) ? after : before) = middle;
        }
        held = flow_path(rules_.settings.integrator, along, state_.position, state_.time, after, after).path;
    }
    for (std::size_t k = 1; k < held.c.size(); ++k) held.c[k] -= dot(held.c[k], normal) * normal;
    held.end -= dot(held.end - held.c[0], normal) * normal;
    return held;
}

/// The part of a path along a flat surface up to the rim; its end keeps the contact offset.
Path Advector::part_on_flat(const ContactSurface& support, Path path) const {
    const CollisionWorld& world = rules_.world;
    Path of_contact_point = path;
    of_contact_point.c[0] -= state_.radius * support.normal;
    const double reach = kEdgeOffsets * contact_offset(state_.position);
    const double on = world.time_over(support.surface, of_contact_point, reach);
    if (on < path.duration) {
        path.end = path.position(on);
        path.duration = on;
    }
    if (!(path.duration > 0.0)) return path;
    const double side = dot(world.unit_normal_of(support.surface, path.end), support.normal) < 0.0 ? -1.0 : 1.0;
    const double height = side * world.signed_distance_from(support.surface, path.end) - state_.radius;
    const double lift = contact_offset(path.end) - height;
    // Where the flow has turned away the particle is above the surface by more than rounding. Next to the origin a
    // height above a large triangle can be all rounding.
    const bool is_rounding = std::fabs(lift) <= 0.5 * kCandidateSlack * max_abs(path.end) &&
                             height <= 2.0 * kTouchingOffsets * contact_offset(path.end);
    if (is_rounding) {
        path.end = flush_tiny(path.end + lift * support.normal);
        // A start below the contact offset must not lead into the surface.
        path.c[1] += (lift / path.duration) * support.normal;
    }
    return path;
}

/// A straight part of a path along a curved surface that turns by at most kMaxChordAngle: a tangent where the surface
/// bends away, from whose end the flow presses the particle on again; a chord where it bends towards the particle.
Path Advector::part_on_curved(const ContactSurface& support, Path path) const {
    const CollisionWorld& world = rules_.world;
    const double size = world.size_of(support.surface);
    const double bend = state_.radius > 0.0 ? std::min(size, state_.radius) : size;
    const double speed = length(path.c[1]);
    double duration = path.duration;
    if (speed > 0.0) duration = std::min(duration, kMaxChordAngle * bend / speed);
    if (duration < path.duration) {
        path.end = path.position(duration);
        path.duration = duration;
    }
    if (!(duration > 0.0)) return path;
    const CollisionWorld::Nearest there = world.nearest(support.surface, path.end);
    const double side = dot(there.normal, support.normal) < 0.0 ? -1.0 : 1.0;
    const double offset = contact_offset(path.end);
    const double lift = state_.radius + offset - side * there.distance;
    if (!(lift > 0.0)) return path;
    const Vec3 end = flush_tiny(path.end + (side * lift) * there.normal);
    // Over the seam of a flat surface the height differs by rounding only.
    if (lift > kTouchingOffsets * offset) {
        path = line_path(state_.position, (end - state_.position) / duration, duration);
    }
    path.end = end;
    return path;
}

}  // namespace

MoveOutcome AdvectResponse::move(MovingParticle& particle, double duration, MoveScratch& scratch) const {
    return Advector(rules_, particle, duration, scratch).run();
}

}  // namespace ricochet
