#include "ricochet/response/exact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "ricochet/collision/parking.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates.h"
#include "ricochet/response/bounce.h"
#include "ricochet/response/contact_mode.h"

namespace ricochet {
namespace {

/// Passes over the surfaces of a corner until none is approached; sharper corners lose their velocity into the corner.
constexpr int kCornerPasses = 16;
/// Stretches of sliding after one impact before the particle is set free again; only curved sliding needs more than
/// two.
constexpr int kMostSlides = 64;

/// States beyond this cannot be followed: the predicates would leave the range of doubles.
bool can_be_followed(const Path& path) {
    double reach = max_abs(path.c[0]);
    double power = path.duration;
    for (int k = 1; k <= path.degree; ++k, power *= path.duration) {
        reach += power * max_abs(path.c[static_cast<std::size_t>(k)]);
    }
    return reach <= kLargestCoordinate && max_abs(path.c[1]) <= kLargestCoordinate && is_finite(path.end);
}

}  // namespace

/// One particle on its way through one step.
class Mover {
public:
    Mover(const ExactResponse& rules, ForceInput& state, double duration, MoveScratch& scratch)
        : rules_(rules),
          state_(state),
          scratch_(scratch),
          search_(rules.world_, scratch.contacts),
          start_(state.position),
          remaining_(duration) {}

    /// The loop that moves one particle: fly until something is in the way, answer, go on with the time that is left.
    MoveOutcome run() {
        Flight flight = begin_flight(rules_.settings_.integrator, rules_.forces_, state_, remaining_);
        for (;;) {
            std::optional<Contact> contact = follow(flight);
            while (contact && has_budget()) contact = answer(flight, *contact);
            if (contact) outcome_.unsimulated_time = remaining_;
            if (contact || remaining_ <= 0.0) return outcome_;
            flight = resume_flight(rules_.settings_.integrator, rules_.forces_, state_, flight, remaining_);
        }
    }

private:
    bool has_budget() const { return outcome_.bounces < rules_.settings_.bounce_budget; }

    /// Moves the particle along the flight: to its end, or to the contact that is returned.
    std::optional<Contact> follow(const Flight& flight) {
        const Path& path = flight.path;
        if (!can_be_followed(path)) {
            outcome_.frozen = true;
            remaining_ = 0.0;
            return std::nullopt;
        }
        std::optional<Contact> contact = search_.search(path);
        if (contact && contact->time == 0.0 && search_.blocker(path.c[0], path.c[0])) {
            leave_surface(flight);
            return std::nullopt;
        }
        if (contact) {
            const Parking parking = park(search_, path, *contact);
            outcome_.stayed += parking.stayed ? 1 : 0;
            state_.position = parking.position;
        } else {
            const Travel travelled = travel(search_, path, path.duration, path.end);
            state_.position = travelled.reached;
            if (travelled.blocker) contact = contact_of_blocker(search_, path, travelled);
        }
        const double elapsed = contact ? contact->time : path.duration;
        state_.velocity = velocity_at(flight, elapsed);
        state_.time += elapsed;
        remaining_ = std::max(0.0, remaining_ - elapsed);
        return contact;
    }

    /// A particle that was put exactly on a surface has no side yet: it gets the one that the normal points to.
    void leave_surface(const Flight& flight) {
        state_.velocity = velocity_at(flight, 0.0);
        if (const auto place = step_off(search_, state_.position)) {
            start_ = *place;
            state_.position = *place;
            return;
        }
        outcome_.unsimulated_time = remaining_;
        remaining_ = 0.0;
    }

    /// Responds to an impact. Returns the next contact when the particle slid into one.
    std::optional<Contact> answer(const Flight& flight, const Contact& contact) {
        ++outcome_.bounces;
        forget_what_is_left();
        for (const ContactSurface& surface : contact.all()) remember(surface);
        const Vec3 arriving = state_.velocity;
        reflect(contact);
        const ContactSurface* const support = support_of(flight, contact, arriving);
        const bool is_slow = support != nullptr && length(arriving) < rules_.settings_.resting_speed;
        slow_contacts_ = is_slow ? slow_contacts_ + 1 : 0;
        if (support == nullptr) return std::nullopt;
        if (slow_contacts_ > kMostSlowContacts) {
            rest(support->surface, acceleration_now(flight));
            return std::nullopt;
        }
        return stay_in_contact(flight, *support, arriving);
    }

    const Material& material_of(SurfaceId surface) const {
        const std::uint32_t collider = rules_.world_.name_of(surface).collider;
        return rules_.materials_[rules_.world_.colliders()[collider].material];
    }

    void push(SurfaceId surface, const Vec3& velocity_change, bool impact) {
        scratch_.hits.push_back({surface, state_.time, -state_.mass * velocity_change, impact});
    }

    /// Bounces off every surface of the contact that is approached, until none is.
    void reflect(const Contact& contact) {
        bool any_push = false;
        for (int pass = 0; pass < kCornerPasses; ++pass) {
            bool approached = false;
            for (const ContactSurface& surface : contact.all()) {
                if (!(dot(state_.velocity, surface.normal) < 0.0)) continue;
                const Material& material = material_of(surface.surface);
                const Vec3 before = state_.velocity;
                state_.velocity = bounce(before, surface.normal, material.restitution, material.friction);
                push(surface.surface, state_.velocity - before, pass == 0);
                approached = true;
                any_push = true;
            }
            if (!approached) {
                if (!any_push) push(contact.first().surface, Vec3{}, true);  // a touch without approach still counts
                return;
            }
        }
        std::array<Vec3, 3> normals;
        int count = 0;
        for (const ContactSurface& surface : contact.all()) {
            if (count < 3) normals[static_cast<std::size_t>(count++)] = surface.normal;
        }
        const Vec3 before = state_.velocity;
        state_.velocity = project_off(before, {normals.data(), static_cast<std::size_t>(count)});
        push(contact.first().surface, state_.velocity - before, false);
    }

    /// The surface that the particle is pressed onto most, when all its rebounds are so slow that the cascade of
    /// bounces becomes contact; null when it flies on.
    const ContactSurface* support_of(const Flight& flight, const Contact& contact, const Vec3& arriving) const {
        if (remaining_ <= 0.0) return nullptr;
        const Vec3 a = acceleration_now(flight);
        const ContactSurface* support = nullptr;
        double hardest = 0.0;
        for (const ContactSurface& surface : contact.all()) {
            const double restitution = material_of(surface.surface).restitution;
            const double pressing = std::max(0.0, -dot(a, surface.normal));
            // What the step's own kick put into the velocity is not the speed of an impact.
            const double approach = -dot(arriving, surface.normal) - pressing * flight.kick_duration;
            const double slowest = restitution < 1.0 ? rules_.settings_.resting_speed : 0.0;
            if (approach > 0.0 && restitution * approach >= slowest) return nullptr;
            if (restitution >= 1.0 || pressing <= hardest) continue;
            hardest = pressing;
            support = &surface;
        }
        return support;
    }

    Vec3 acceleration_now(const Flight& flight) const {
        return flight.kick_duration > 0.0 ? flight.acceleration : rules_.forces_.acceleration(state_);
    }

    /// Slides or rests until the step ends, the surface ends, or something else is met.
    std::optional<Contact> stay_in_contact(const Flight& flight, const ContactSurface& support, const Vec3& arriving) {
        const double friction = material_of(support.surface).friction;
        land(arriving, friction, support.surface);
        const std::span<const Vec3> normals{touched_normals_.data(), static_cast<std::size_t>(touched_count_)};
        for (int stretch = 0; stretch < kMostSlides && remaining_ > 0.0; ++stretch) {
            const Vec3 a = flight.kick_duration > 0.0 ? Vec3{} : rules_.forces_.acceleration(state_);
            if (dot(a, support.normal) > 0.0) return std::nullopt;  // nothing presses any more
            const double grip = flight.kick_duration > 0.0 ? 0.0 : friction;
            const Slide slide = plan_slide(state_.velocity, a, normals, grip, remaining_);
            if (slide.at_rest) {
                rest(support.surface, a);
                return std::nullopt;
            }
            const Flight sliding = sliding_flight(slide, support);
            if (sliding.path.duration <= 0.0) return std::nullopt;
            push(support.surface, sliding.path.duration * (slide.acceleration - a), false);
            if (auto next = follow(sliding)) return next;
            if (sliding.path.duration < slide.duration) return std::nullopt;  // the surface ended
            if (slide.stops) drop_heading(slide.velocity);
        }
        return std::nullopt;
    }

    /// The landing itself: the approach is lost, the tangential part pays friction for it.
    void land(const Vec3& arriving, double friction, SurfaceId support) {
        const std::span<const Vec3> normals{touched_normals_.data(), static_cast<std::size_t>(touched_count_)};
        Vec3 along = project_off(arriving, normals);
        const double speed = length(along);
        const double loss = friction * length(arriving - along);
        along = speed <= loss ? Vec3{} : along * (1.0 - loss / speed);
        push(support, along - state_.velocity, false);
        state_.velocity = along;
    }

    void rest(SurfaceId support, const Vec3& a) {
        push(support, -remaining_ * a, false);
        // Landing again from one gap above, step after step, it would creep downhill.
        if (length(state_.position - start_) <= kTouchingGaps * parking_gap(start_)) state_.position = start_;
        state_.velocity = Vec3{};
        state_.time += remaining_;
        remaining_ = 0.0;
        outcome_.resting = true;
    }

    /// The path of a slide, up to where the supporting surface ends; its end keeps the parking gap.
    Flight sliding_flight(const Slide& slide, const ContactSurface& support) const {
        Path path = parabola_path(state_.position, slide.velocity, slide.acceleration, slide.duration);
        if (!can_be_followed(path)) return {path, slide.acceleration, 0.0};
        const double slack = kTouchingGaps * parking_gap(state_.position);
        const double over = rules_.world_.time_over(support.surface, path, slack);
        if (over < slide.duration) path = parabola_path(state_.position, slide.velocity, slide.acceleration, over);
        const double side = dot(support.normal, rules_.world_.unit_normal_of(support.surface)) < 0.0 ? -1.0 : 1.0;
        const double height = side * rules_.world_.signed_distance_from(support.surface, path.end);
        path.end = flush_tiny(path.end + (parking_gap(path.end) - height) * support.normal);
        return {path, slide.acceleration, 0.0};
    }

    /// After braking to a stop only rounding is left along the heading.
    void drop_heading(const Vec3& started) {
        const Vec3 heading = normalized(started);
        state_.velocity -= dot(state_.velocity, heading) * heading;
        if (length(state_.velocity) <= 0x1p-40 * length(started)) state_.velocity = Vec3{};
    }

    /// Surfaces touched together decide where a pressed particle can go; at most three matter.
    void remember(const ContactSurface& surface) {
        for (int k = 0; k < touched_count_; ++k) {
            if (dot(touched_normals_[static_cast<std::size_t>(k)], surface.normal) > 1.0 - 1e-12) return;
        }
        if (touched_count_ == 3) return;
        touched_[static_cast<std::size_t>(touched_count_)] = surface.surface;
        touched_normals_[static_cast<std::size_t>(touched_count_++)] = surface.normal;
    }

    void forget_what_is_left() {
        const double reach = kTouchingGaps * parking_gap(state_.position);
        int kept = 0;
        for (int k = 0; k < touched_count_; ++k) {
            const auto i = static_cast<std::size_t>(k);
            if (!touches(touched_[i], reach)) continue;
            touched_[static_cast<std::size_t>(kept)] = touched_[i];
            touched_normals_[static_cast<std::size_t>(kept++)] = touched_normals_[i];
        }
        touched_count_ = kept;
    }

    bool touches(SurfaceId surface, double reach) const {
        if (std::fabs(rules_.world_.signed_distance_from(surface, state_.position)) > reach) return false;
        Path here = line_path(state_.position, Vec3{}, 1.0);
        return rules_.world_.time_over(surface, here, reach) > 0.0;
    }

    const ExactResponse& rules_;
    ForceInput& state_;
    MoveScratch& scratch_;
    ContactSearch search_;
    Vec3 start_;  // where the step began
    MoveOutcome outcome_;
    double remaining_;
    std::array<SurfaceId, 3> touched_{};
    std::array<Vec3, 3> touched_normals_;
    int touched_count_ = 0;
    int slow_contacts_ = 0;  // in a row, all slower than the resting speed
};

MoveOutcome ExactResponse::move(ForceInput& state, double duration, MoveScratch& scratch) const {
    return Mover(*this, state, duration, scratch).run();
}

}  // namespace ricochet
