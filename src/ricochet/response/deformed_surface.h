/// \file
/// Deforming meshes in lasting contact.
#pragma once

#include <functional>
#include <vector>

#include "ricochet/collision/contact.h"
#include "ricochet/collision/deforming_colliders.h"
#include "ricochet/dynamics/forces.h"

namespace ricochet {

/// One contact of a particle with a deforming mesh.
struct DeformedContact {
    ContactSurface surface;
    /// All triangles with this normal, including `surface`. Edges between them have no effect.
    std::vector<SurfaceId> all;
};

/// Returns the contacts of a particle with deforming meshes at its present time. Faces come first, and each normal
/// occurs once. separation_speed: speed along the normal relative to the surface, in m/s, above which the particle has
/// left. A point is supported by the triangles below it. Near their rims, another triangle supports it only if it does
/// not lie behind one of them. A triangle beyond a convex edge lies behind the triangle below the point.
[[nodiscard]] std::vector<DeformedContact> touched_surfaces(const DeformingColliders& deforming,
                                                            const ForceInput& particle, double separation_speed);

/// Accelerations, in m/s^2, by the rotation or the rim of a triangle. They change the distance and the slip
/// (SupportSurface::curvature and slip_curvature). Points of the triangle have no acceleration between key times. Let n
/// be the normal and n' = omega x n its rate. Let q be the surface point below a particle at x, and s = v - q' the
/// velocity relative to q. Then
/// - the gap n . (x - q) - r has the second derivative n . a + 2 n' . s - r |n'|^2,
/// - the gap to a corner has the second derivative n . a + |s|^2 / r,
/// - the gap to an edge of direction e has the second derivative n . a + (|s|^2 - (s . e + r n . e')^2) / r.
struct CurvatureTerms {
    double curvature = 0.0;
    Vec3 slip_curvature;
};
[[nodiscard]] CurvatureTerms curvature_of(const DeformingColliders& deforming, const ForceInput& particle,
                                          const ContactSurface& surface);

/// Returns the time, in s since the start of a trajectory, at which the trajectory leaves all triangles of a contact
/// with a face. It has left them when its distance from the nearest one, along the triangle's plane, is larger than at
/// the start. The result is slightly late, and at most `duration`. begin: time at the start, in s. position_at:
/// position, in m, at a time since the start, in s.
[[nodiscard]] double time_over(const DeformingColliders& deforming, const DeformedContact& contact,
                               const std::function<Vec3(double)>& position_at, double duration, double begin);

}  // namespace ricochet
