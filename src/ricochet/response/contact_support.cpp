#include "ricochet/response/contact_support.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/contact_interval.h"
#include "ricochet/response/curved_contact.h"

namespace ricochet {

bool ContactSupport::rebounds_slowly(const Contact& contact, const Motion& arriving, const Vec3& forces,
                                     double kick_duration) const {
    const auto dies_out = [&] {
        return std::ranges::any_of(contact.all(), [&](const ContactSurface& surface) { return has_losses(surface); });
    };
    return std::ranges::all_of(contact.all(), [&](const ContactSurface& surface) {
        const Material& material = surfaces().material_of(surface.surface);
        // The velocity from the step's own kick does not count as impact speed.
        const double kicked = std::max(0.0, -dot(forces, surface.normal)) * kick_duration;
        const double approach = -dot(arriving.velocity, surface.normal) - kicked;
        if (surface.is_support || !(approach > 0.0)) return true;
        const double rebound = std::max(0.0, material.restitution_at(approach) * approach);
        if (rebound >= step_.resting_speed()) return false;  // slow_rebound() never exceeds the resting speed
        return !(rebound >= slow_rebound(surface, forces, kick_duration > 0.0, dies_out()));
    });
}

/// Returns true if bounces on the surface die out.
bool ContactSupport::has_losses(const ContactSurface& surface) const {
    return surfaces().material_of(surface.surface).can_hold(step_.resting_speed());
}

/// Returns the speed of rebounds, in m/s, below which bounces on a surface count as contact. On a surface without
/// losses, bounces die out only if another surface has losses (`dies_out`). Otherwise they count as contact if they
/// rise no higher than the touching distance, but never if kicked: the velocity contains a kick.
double ContactSupport::slow_rebound(const ContactSurface& surface, const Vec3& forces, bool kicked,
                                    bool dies_out) const {
    const double resting_speed = step_.resting_speed();
    if (has_losses(surface)) return resting_speed;
    if (kicked || surfaces().material_of(surface.surface).is_random()) return 0.0;
    if (dies_out) return resting_speed;
    const double pressing = std::max(0.0, pressing_on(surface, forces));
    return std::min(resting_speed,
                    std::sqrt(2.0 * pressing * kTouchingOffsets * step_.geometry().contact_offset(state().position)));
}

template <class PressingOf>
std::optional<ContactSurface> ContactSupport::hardest(const PressingOf& pressing_of) const {
    std::optional<ContactSurface> support;
    double hardest = 0.0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const double pressing = pressing_of(k);
        if (!(pressing > hardest)) continue;
        hardest = pressing;
        support = manifold_[k];
    }
    return support;
}

std::optional<ContactSurface> ContactSupport::after_rebounds(const Vec3& forces, double fastest) const {
    const PointAccelerations accelerations = combined_accelerations(forces, fastest);
    return hardest([&](std::size_t k) { return length(accelerations[k]); });
}

std::optional<Motion> ContactSupport::landing_on_all(const Vec3& forces) const {
    const PointAccelerations accelerations = combined_accelerations(forces, step_.resting_speed());
    const ContactManifold::SupportList supports = manifold_.supports(surfaces());
    std::array<SupportSurface, kMostSupports> surfaces;
    std::size_t count = 0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (accelerations[k] != Vec3{}) surfaces[count++] = supports.surfaces[k];
    }
    if (count < 2) return std::nullopt;
    const std::span<const SupportSurface> together(surfaces.data(), count);
    return along_surfaces(particle().motion(), state().radius, together, sticking(together));
}

Vec3 ContactSupport::velocity_after_rebounds(const Vec3& forces) const {
    const PointAccelerations accelerations = combined_accelerations(forces, step_.resting_speed());
    const double rounding = kSlowSlip * length(state().velocity);
    std::array<Vec3, kMostSupports> normals;
    std::size_t count = 0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const Vec3& normal = manifold_.normals()[k];
        if (accelerations[k] != Vec3{} && dot(state().velocity, normal) >= -rounding) normals[count++] = normal;
    }
    return along_all(state().velocity, std::span(normals).first(count));
}

/// Returns the accelerations, in m/s^2, that the surfaces of the manifold exert if they jointly support the particle.
/// Only surfaces that the particle leaves more slowly than `fastest`, in m/s, can support it. They are solved jointly,
/// because a wall may be loaded only by another surface that slopes towards it.
ContactSupport::PointAccelerations ContactSupport::combined_accelerations(const Vec3& forces, double fastest) const {
    bool has_lossless = false;
    for (std::size_t k = 0; k < manifold_.size(); ++k) has_lossless = has_lossless || !has_losses(manifold_[k]);
    const PointAccelerations accelerations = combined_accelerations(forces, fastest, true);
    if (!has_lossless) return accelerations;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (has_losses(manifold_[k]) && accelerations[k] != Vec3{}) return accelerations;
    }
    return combined_accelerations(forces, fastest, false);
}

/// Does the same. die_out: true if bounces on surfaces without losses die out because another surface has losses.
ContactSupport::PointAccelerations ContactSupport::combined_accelerations(const Vec3& forces, double fastest,
                                                                          bool die_out) const {
    const ContactManifold::SupportList supports = manifold_.supports(surfaces());
    PointAccelerations accelerations{};
    std::array<SupportSurface, kMostSupports> surfaces;
    std::array<std::size_t, kMostSupports> number{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const ContactSurface surface = manifold_[k];
        if (!(dot(state().velocity, surface.normal) <= fastest_separation(surface, forces, fastest, die_out))) continue;
        surfaces[count] = supports.surfaces[k];
        if (!surface.flat)
            surfaces[count].curvature =
                CurvedContact::curvature_of(step_.geometry(), state(), surface, state().velocity);
        number[count++] = k;
    }
    if (count == 1) {
        const ContactSurface alone = manifold_[number[0]];
        accelerations[number[0]] = std::max(0.0, pressing_on(alone, forces)) * alone.normal;
        return accelerations;
    }
    const std::span<const SupportSurface> together(surfaces.data(), count);
    const StuckSurfaces stuck = sticking(together);
    const Motion motion = along_surfaces(particle().motion(), state().radius, together, stuck);
    const FrictionLimits grip = manifold_.grip(1.0, step_.duration());
    const ContactInterval interval =
        plan_interval(motion, state().radius, forces, together, grip, step_.remaining(), stuck);
    for (std::size_t i = 0; i < count; ++i) accelerations[number[i]] = interval.reaction[i];
    return accelerations;
}

/// Returns the largest separation speed, in m/s, at which a surface still supports the particle.
double ContactSupport::fastest_separation(const ContactSurface& surface, const Vec3& forces, double fastest,
                                          bool die_out) const {
    if (has_losses(surface)) return fastest;
    const double slow = slow_rebound(surface, forces, fastest > step_.resting_speed(), die_out);
    return slow > 0.0 ? slow : -std::numeric_limits<double>::infinity();
}

/// Returns the surfaces on which the particle does not slip, except by slow separation from another surface.
StuckSurfaces ContactSupport::sticking(std::span<const SupportSurface> surfaces) const {
    const Motion motion = particle().motion();
    const double slow = kSlowSlip * speed_scale(motion, state().radius, surfaces);
    return sticking_surfaces(motion, state().radius, surfaces, slow);
}

std::optional<ContactSurface> ContactSupport::hardest_pressed(const Vec3& forces) const {
    return hardest([&](std::size_t k) { return pressing_on(manifold_[k], forces); });
}

bool ContactSupport::is_pressed(const Vec3& forces) const {
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (pressing_on(manifold_[k], forces) >= 0.0) return true;
    }
    return false;
}

double ContactSupport::pressing_on(const ContactSurface& surface, const Vec3& forces) const {
    const double by_forces = -dot(forces, surface.normal);
    if (surface.flat) return by_forces;
    return by_forces - CurvedContact::curvature_of(step_.geometry(), state(), surface, state().velocity);
}

}  // namespace ricochet
