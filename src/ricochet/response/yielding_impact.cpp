#include "ricochet/response/yielding_impact.h"

#include <cmath>

#include "ricochet/core/symmetric_matrix.h"

namespace ricochet {
namespace {

/// Halvings in search of the friction that lets no energy in: to the last bit.
constexpr int kHalvings = 53;

/// How both yield at the contact to an impulse on the particle, N s, and its opposite on the body.
class Contact {
public:
    Contact(const ForceInput& state, const YieldingSurface& surface)
        : state_(state), surface_(surface), where_(state.position - state.radius * surface.normal) {}

    /// The change of the velocity between them, m/s.
    [[nodiscard]] Vec3 change(const Vec3& impulse) const {
        const Vec3 of_particle = impulse / state_.mass;
        Vec3 along;
        if (state_.radius > 0.0) along = 2.5 * (of_particle - dot(of_particle, surface_.normal) * surface_.normal);
        return of_particle + along + surface_.body.change_at(where_, impulse);
    }
    /// The impulse that makes a change.
    [[nodiscard]] Vec3 impulse_for(const Vec3& wanted) const {
        const Vec3 x = change({1, 0, 0});
        const Vec3 y = change({0, 1, 0});
        const Vec3 z = change({0, 0, 1});
        return SymmetricMatrix{x.x, y.y, z.z, y.x, z.x, z.y}.inverse() * wanted;
    }

private:
    const ForceInput& state_;
    const YieldingSurface& surface_;
    Vec3 where_;
};

}  // namespace

Motion bounce(const Motion& before, const ForceInput& state, const YieldingSurface& surface) {
    const Vec3& n = surface.normal;
    const Contact contact(state, surface);
    const Vec3 relative = before.velocity - surface.velocity;
    const double approach = -dot(relative, n);
    if (!(approach > 0.0)) return before;
    const double wanted = (1.0 + surface.restitution) * approach;
    // What friction sees: the slip of the surface of a sphere.
    const Vec3 slip = slip_velocity({relative, before.spin}, state.radius, n);
    const auto impulse_with = [&](const Vec3& friction) {
        const Vec3 direction = n + friction;
        return (wanted / dot(n, contact.change(direction))) * direction;
    };
    Vec3 impulse = impulse_with({});
    if (surface.friction > 0.0 && slip != Vec3{}) {
        const auto gain = [&](const Vec3& by) {
            return dot(by, slip - approach * n) + 0.5 * dot(by, contact.change(by));
        };
        const Vec3 stop = contact.impulse_for(wanted * n - slip);
        const double pressing = dot(stop, n);
        if (pressing > 0.0 && length(stop - pressing * n) <= surface.friction * pressing && gain(stop) <= 0.0) {
            impulse = stop;
        } else {
            const Vec3 against = (-1.0 / length(slip)) * slip;
            const auto is_sound = [&](double friction) {
                const Vec3 by = impulse_with(friction * against);
                return dot(by, n) > 0.0 && gain(by) <= 0.0 && dot(slip + contact.change(by), against) <= 0.0;
            };
            double low = 0.0;
            double high = surface.friction;
            if (is_sound(high)) low = high;
            for (int k = 0; k < kHalvings && low < high; ++k) {
                const double middle = 0.5 * (low + high);
                (is_sound(middle) ? low : high) = middle;
            }
            impulse = impulse_with(low * against);
        }
    }
    const Vec3 change = impulse / state.mass;
    return {before.velocity + change, before.spin + spin_change_by(change, n, state.radius)};
}

}  // namespace ricochet
