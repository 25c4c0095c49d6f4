/// \file
/// How a rigid body, or what its joint leaves of one, yields to an impulse.
#pragma once

#include "ricochet/core/symmetric_matrix.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// An impulse, N s, and its moment about a point that is agreed upon, N m s.
struct Wrench {
    Vec3 impulse;
    Vec3 moment;

    Wrench& operator+=(const Wrench& other) {
        impulse += other.impulse;
        moment += other.moment;
        return *this;
    }
};

/// The inverses of a body's mass and inertia; what a joint forbids is missing from them.
struct Mobility {
    SymmetricMatrix of_mass;     ///< 1/kg
    SymmetricMatrix of_inertia;  ///< 1/(kg m^2), about the center
    Vec3 center;                 ///< m: the centre of mass, or a point of the fixed axis

    /// The same seen through a rotation with a shift.
    [[nodiscard]] Mobility seen_by(const AffineMap& map) const {
        return {congruent(map, of_mass), congruent(map, of_inertia), map.point(center)};
    }
    /// Kinetic energy, J, that a wrench about the center would give the body, were it at rest.
    [[nodiscard]] double energy_by(const Wrench& wrench) const {
        return 0.5 * (dot(wrench.impulse, of_mass * wrench.impulse) + dot(wrench.moment, of_inertia * wrench.moment));
    }
    /// The change of velocity, m/s, of the body's point at `where` by an impulse there, N s.
    [[nodiscard]] Vec3 change_at(const Vec3& where, const Vec3& impulse) const {
        const Vec3 arm = where - center;
        return of_mass * impulse + cross(of_inertia * cross(arm, impulse), arm);
    }
    /// The same by a wrench about the center.
    [[nodiscard]] Vec3 change_at(const Vec3& where, const Wrench& wrench) const {
        return of_mass * wrench.impulse + cross(of_inertia * wrench.moment, where - center);
    }
};

}  // namespace ricochet
