/// \file
/// Response of a rigid body, possibly restricted by a joint, to an impulse.
#pragma once

#include "ricochet/core/symmetric_matrix.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// An impulse, in N s, and its moment about a reference point, in N m s.
struct Wrench {
    Vec3 impulse;
    Vec3 moment;

    Wrench& operator+=(const Wrench& other) {
        impulse += other.impulse;
        moment += other.moment;
        return *this;
    }
};

/// Inverse mass and inverse inertia of a body. They are zero in the directions that a joint blocks.
struct Mobility {
    SymmetricMatrix of_mass;     ///< in 1/kg
    SymmetricMatrix of_inertia;  ///< in 1/(kg m^2), about the center
    Vec3 center;                 ///< in m; the centre of mass, or a point of the fixed axis

    /// Returns the mobility in other coordinates. map: a rotation and a translation into these coordinates.
    [[nodiscard]] Mobility seen_by(const AffineMap& map) const {
        return {congruent(map, of_mass), congruent(map, of_inertia), map.point(center)};
    }
    /// Returns the kinetic energy, in J, that a wrench about the center would give the body at rest.
    [[nodiscard]] double energy_by(const Wrench& wrench) const {
        return 0.5 * (dot(wrench.impulse, of_mass * wrench.impulse) + dot(wrench.moment, of_inertia * wrench.moment));
    }
    /// Returns the velocity change, in m/s, of the body's point at `where` due to an impulse at that point, in N s.
    [[nodiscard]] Vec3 change_at(const Vec3& where, const Vec3& impulse) const {
        const Vec3 arm = where - center;
        return of_mass * impulse + cross(of_inertia * cross(arm, impulse), arm);
    }
    /// Returns the velocity change, in m/s, of the body's point at `where` due to a wrench about the center.
    [[nodiscard]] Vec3 change_at(const Vec3& where, const Wrench& wrench) const {
        return of_mass * wrench.impulse + cross(of_inertia * wrench.moment, where - center);
    }
};

}  // namespace ricochet
