/// \file
/// Private to the exact response: a mesh that deforms, as contact that lasts sees it.
#pragma once

#include <functional>
#include <vector>

#include "ricochet/collision/contact.h"
#include "ricochet/collision/deforming_colliders.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// One place at which a particle touches a mesh that deforms.
struct DeformedContact {
    ContactSurface surface;
    /// All triangles that are touched there with this normal, with that one: an edge is not felt beside them.
    std::vector<SurfaceId> all;
};

/// What a particle touches of meshes that deform, at its present time: faces first, no normal twice. departure: m/s
/// along the normal, relative to the surface, above which it has left. A point is held by the triangles that it is
/// over, and next to their rims by those only that do not lie behind one of them: beyond a convex edge is nothing.
[[nodiscard]] std::vector<DeformedContact> touched_surfaces(const DeformingColliders& deforming,
                                                            const ForceInput& particle, double separation_speed);

/// What the turning of a triangle, or its rim, adds to the rates of contact, m/s^2: of the distance, and of the slip
/// (SupportSurface::curvature and slip_curvature). Its points are not accelerated between keys. With the normal n,
/// which changes by n' = omega x n, the gap n . (x - q) - r to its point q below a particle with the velocity v - q' =
/// s relative to that changes by n . a + 2 n' . s - r |n'|^2; that to a corner by n . a + |s|^2 / r, and that to an
/// edge of the direction e by n . a + (|s|^2 - (s . e + r n . e')^2) / r.
struct CurvatureTerms {
    double curvature = 0.0;
    Vec3 slip_curvature;
};
[[nodiscard]] CurvatureTerms curvature_of(const DeformingColliders& deforming, const ForceInput& particle,
                                          const ContactSurface& surface);

/// How far a position is from the nearest of a contact's triangles at a time, on the side that its normal points to.
struct SurfaceHeight {
    Vec3 normal;         ///< unit
    double above = 0.0;  ///< m
};
[[nodiscard]] SurfaceHeight height_above(const DeformingColliders& deforming, const DeformedContact& contact,
                                         const Vec3& position, double time);

/// s along a way that begins at a time and lasts so long, until which it is over one of the triangles of a contact,
/// with a face, or no further beyond all of their rims than it begins, or its duration: a little later than that where
/// it leaves them. position_at: m, by s since it began.
[[nodiscard]] double time_over(const DeformingColliders& deforming, const DeformedContact& contact,
                               const std::function<Vec3(double)>& position_at, double duration, double begin);

}  // namespace ricochet
