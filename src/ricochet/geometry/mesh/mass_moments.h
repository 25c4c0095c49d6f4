/// \file
/// Volume, centre and moments of bodies of uniform density.
#pragma once

#include "ricochet/core/symmetric_matrix.h"
#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Integrals over a body. The integrals of bodies that do not overlap can be added.
struct MassMoments {
    double volume = 0.0;     ///< in m^3
    Vec3 first;              ///< integral of the position, in m^4
    SymmetricMatrix second;  ///< integral of x x^T, in m^5

    [[nodiscard]] Vec3 center() const { return first / volume; }
    /// Returns the inertia about the centre, divided by the density, in m^5.
    [[nodiscard]] SymmetricMatrix inertia() const;

    friend MassMoments operator+(const MassMoments& a, const MassMoments& b) {
        return {a.volume + b.volume, a.first + b.first, a.second + b.second};
    }
};

/// Returns the moments of the volume inside a closed mesh whose triangles are counter-clockwise seen from outside. The
/// moments are exact for the polyhedron, up to rounding. All moments are negative for a mesh that is wound inward.
/// Method: sums over the tetrahedra between one point and each triangle. Source of the moments of a tetrahedron: S.
/// Lien, J. T. Kajiya, IEEE Computer Graphics and Applications 4 (1984).
[[nodiscard]] MassMoments moments_of(const TriangleMesh& mesh);
/// Returns the moments of the unit ball under a map.
[[nodiscard]] MassMoments moments_of_ball(const AffineMap& world_from_unit);
/// Returns the moments of the cylinder x^2 + y^2 <= 1, |z| <= 1 under a map.
[[nodiscard]] MassMoments moments_of_cylinder(const AffineMap& world_from_unit);

}  // namespace ricochet
