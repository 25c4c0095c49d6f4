/// \file
/// Private to the exact response: deforming meshes in lasting contact.
#pragma once

#include <functional>
#include <vector>

#include "ricochet/collision/contact.h"
#include "ricochet/collision/deforming_colliders.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// One contact of a particle with a deforming mesh.
struct DeformedContact {
    ContactSurface surface;
    /// All triangles that the particle touches with this normal, including `surface`. An edge beside them is not felt.
    std::vector<SurfaceId> all;
};

/// Returns the contacts of a particle with deforming meshes at its present time. Faces come first, and no normal occurs
/// twice. separation_speed: speed along the normal relative to the surface, in m/s, above which the particle has left.
/// A point is held by the triangles below it. Next to their rims, a further triangle holds it only if it does not lie
/// behind one of them: there is nothing beyond a convex edge.
[[nodiscard]] std::vector<DeformedContact> touched_surfaces(const DeformingColliders& deforming,
                                                            const ForceInput& particle, double separation_speed);

/// Rates of contact, in m/s^2, that the turning of a triangle, or its rim, adds: to the distance and to the slip
/// (SupportSurface::curvature and slip_curvature). Points of the triangle have no acceleration between keys. Let n be
/// the normal and n' = omega x n its rate. Let q be the surface point below a particle at x, and s = v - q' the
/// velocity relative to q. Then
/// - the gap n . (x - q) - r changes by n . a + 2 n' . s - r |n'|^2,
/// - the gap to a corner changes by n . a + |s|^2 / r,
/// - the gap to an edge of direction e changes by n . a + (|s|^2 - (s . e + r n . e')^2) / r.
struct CurvatureTerms {
    double curvature = 0.0;
    Vec3 slip_curvature;
};
[[nodiscard]] CurvatureTerms curvature_of(const DeformingColliders& deforming, const ForceInput& particle,
                                          const ContactSurface& surface);

/// Returns the time since the start of a trajectory, in s, until which it stays over a triangle of a contact with a
/// face. At the most it may go as far beyond all their rims as it is at its start. Returns `duration` if it stays over
/// them. The result is a little later than the time at which it leaves them. begin: time at the start, in s.
/// position_at: position, in m, at a time since the start, in s.
[[nodiscard]] double time_over(const DeformingColliders& deforming, const DeformedContact& contact,
                               const std::function<Vec3(double)>& position_at, double duration, double begin);

}  // namespace ricochet
