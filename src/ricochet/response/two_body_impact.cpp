#include "ricochet/response/two_body_impact.h"

#include "ricochet/core/bisection.h"
#include "ricochet/core/symmetric_matrix.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Number of halvings in the bisection for the friction that adds no energy; 53 find it to the last bit. Local: it ends
/// below rounding.
constexpr int kHalvings = 53;

/// One impact on a body. Its result is the impulse on the particle.
class Impact {
public:
    Impact(const Motion& before, const ForceInput& state, const DynamicSurface& surface)
        : state_(state),
          body_(surface.body),
          point_(state.position - state.radius * surface.normal),
          normal_(surface.normal),
          friction_(surface.law.friction),
          sticking_friction_(surface.law.sticking_friction()) {
        const Vec3 relative = before.velocity - surface.velocity;
        approach_ = -dot(relative, normal_);
        wanted_ = (1.0 + surface.law.restitution) * approach_;
        // Friction depends on the slip of the sphere's surface.
        slip_ = slip_velocity({relative, before.spin}, state.radius, normal_);
        const double speeds = length(before.velocity) + length(surface.velocity) + state.radius * length(before.spin);
        if (length(slip_) <= kSlipRounding * speeds) slip_ = {};  // a rounding error has no direction
        opposed_ = (1.0 + surface.law.tangential_restitution) * slip_;
    }

    [[nodiscard]] double approach() const { return approach_; }

    /// Returns the impulse on the particle, in N s. Friction opposes the initial slip until it has stopped. From then
    /// on friction prevents slip, or opposes the slip that the rest of the impulse would cause without friction.
    /// Source: E. J. Routh, "The Advanced Part of a Treatise on the Dynamics of a System of Rigid Bodies", chapter on
    /// impulses.
    [[nodiscard]] Vec3 impulse() const {
        if (friction_ == 0.0) return impulse_with({}, {});
        const Vec3 stop = impulse_for(wanted_ * normal_ - opposed_);
        if (is_in_cone(stop) && !gains(stop)) return stop;
        const double speed = length(opposed_);
        if (!(speed > 0.0)) return impulse_after({}, stop);
        const Vec3 against = (-1.0 / speed) * opposed_;
        const Vec3 sliding = impulse_with({}, friction_ * against);
        const bool turns_slip = dot(opposed_ + change(sliding), against) > 0.0;
        if (!turns_slip && dot(sliding, normal_) > 0.0 && !gains(sliding)) return sliding;
        if (!turns_slip) return most_of({}, against, friction_, [](const Vec3& /*impulse*/) { return true; });
        const Vec3 direction = normal_ + friction_ * against;
        return impulse_after((speed / dot(against, change(direction))) * direction, stop);
    }

private:
    /// Returns the change of the relative velocity, in m/s, by an impulse on the particle and its opposite on the body.
    [[nodiscard]] Vec3 change(const Vec3& impulse) const {
        const Vec3 of_particle = impulse / state_.mass;
        Vec3 along;
        if (state_.radius > 0.0) along = 2.5 * (of_particle - dot(of_particle, normal_) * normal_);
        return of_particle + along + body_.change_at(point_, impulse);
    }
    /// Returns the impulse that causes a change of the relative velocity, in N s.
    [[nodiscard]] Vec3 impulse_for(const Vec3& wanted) const {
        const Vec3 x = change({1, 0, 0});
        const Vec3 y = change({0, 1, 0});
        const Vec3 z = change({0, 0, 1});
        return SymmetricMatrix{x.x, y.y, z.z, y.x, z.x, z.y}.inverse() * wanted;
    }

    /// Returns the whole impulse, in N s. Its part `given` has stopped the initial slip. stop: the impulse that leaves
    /// no slip.
    [[nodiscard]] Vec3 impulse_after(const Vec3& given, const Vec3& stop) const {
        if (is_in_cone(stop - given)) {
            if (!gains(stop)) return stop;
            // The nearer the impulse is to `stop`, the smaller the slip.
            const double pressing = dot(stop - given, normal_);
            const Vec3 supports = (stop - given) / pressing - normal_;
            return most_of(given, supports, 1.0, [](const Vec3& /*impulse*/) { return true; });
        }
        const Vec3 smooth = impulse_with(given, {});
        const Vec3 left = opposed_ + change(smooth);
        const Vec3 along = left - dot(left, normal_) * normal_;
        const double speed = length(along);
        if (!(speed > 0.0)) return smooth;
        const Vec3 against = (-1.0 / speed) * along;
        return most_of(given, against, friction_, [&](const Vec3& impulse) {
            return dot(opposed_ + change(impulse), against) <= 0.0;  // it does not reverse the slip
        });
    }

    [[nodiscard]] bool is_in_cone(const Vec3& impulse) const {
        const double pressing = dot(impulse, normal_);
        return pressing > 0.0 && length(impulse - pressing * normal_) <= sticking_friction_ * pressing;
    }

    /// Returns the impulse, in N s, that reverses the approach: `given` plus a multiple of the normal plus `friction`.
    [[nodiscard]] Vec3 impulse_with(const Vec3& given, const Vec3& friction) const {
        const Vec3 direction = normal_ + friction;
        const double left = wanted_ - dot(normal_, change(given));
        return given + (left / dot(normal_, change(direction))) * direction;
    }

    /// Returns the impulse with the largest friction in the direction `along` that adds no energy and is allowed.
    /// `most` is the limit of friction, as a multiple of the normal component.
    template <class Is>
    [[nodiscard]] Vec3 most_of(const Vec3& given, const Vec3& along, double most, const Is& is_allowed) const {
        const auto is_sound = [&](double friction) {
            const Vec3 by = impulse_with(given, friction * along);
            // Bodies that jam would need a pull after `given`, and the sum of the two could leave the friction cone.
            return dot(by - given, normal_) > 0.0 && !gains(by) && is_allowed(by);
        };
        const double friction = is_sound(most) ? most : bisect(0.0, most, kHalvings, is_sound).low;
        return impulse_with(given, friction * along);
    }

    /// Returns true if an impulse adds kinetic energy beyond rounding. The exact energy change is zero if slip stops
    /// without losses.
    [[nodiscard]] bool gains(const Vec3& by) const {
        const double taken = 0.5 * dot(by, change(by));
        return dot(by, slip_ - approach_ * normal_) + taken > kEnergyRounding * taken;
    }

    const ForceInput& state_;
    const Mobility& body_;
    Vec3 point_;  // m, of the contact
    Vec3 normal_;
    double friction_;           // of slip
    double sticking_friction_;  // of a contact that sticks
    double approach_ = 0.0;     // m/s
    double wanted_ = 0.0;       // m/s, required change along the normal
    Vec3 slip_;                 // m/s
    Vec3 opposed_;              // m/s, the change of slip that a sticking impact needs, reversed: slip and its rebound
};

}  // namespace

Motion bounce_off_dynamic(const Motion& before, const ForceInput& state, const DynamicSurface& surface) {
    const Impact impact(before, state, surface);
    if (!(impact.approach() > 0.0)) return before;
    const Vec3 change = impact.impulse() / state.mass;
    return {before.velocity + change, before.spin + spin_change_by(change, surface.normal, state.radius)};
}

}  // namespace ricochet
