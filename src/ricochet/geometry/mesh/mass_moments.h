/// \file
/// Volume, centre and moments of bodies of uniform density.
#pragma once

#include "ricochet/core/symmetric_matrix.h"
#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Integrals over a body. Those of several that do not overlap add up.
struct MassMoments {
    double volume = 0.0;     ///< m^3
    Vec3 first;              ///< of the position, m^4
    SymmetricMatrix second;  ///< of x x^T, m^5

    [[nodiscard]] Vec3 center() const { return first / volume; }
    /// The inertia about the centre over the density, m^5.
    [[nodiscard]] SymmetricMatrix inertia() const;

    friend MassMoments operator+(const MassMoments& a, const MassMoments& b) {
        return {a.volume + b.volume, a.first + b.first, a.second + b.second};
    }
};

/// Of what a closed mesh holds, with its triangles counter-clockwise seen from outside: exact for the polyhedron, to
/// rounding; turned inside out all is negative. Source: the tetrahedra from one point to all triangles; their moments
/// from S. Lien, J. T. Kajiya, IEEE Computer Graphics and Applications 4 (1984).
[[nodiscard]] MassMoments moments_of(const TriangleMesh& mesh);
/// Of the unit ball under a map.
[[nodiscard]] MassMoments moments_of_ball(const AffineMap& world_from_unit);
/// Of the cylinder x^2 + y^2 <= 1, |z| <= 1 under a map.
[[nodiscard]] MassMoments moments_of_cylinder(const AffineMap& world_from_unit);

}  // namespace ricochet
