/// \file
/// Discrete collision test between two positions, for methods that only check the end of a step.
#pragma once

#include <vector>

#include "ricochet/collision/contact.h"
#include "ricochet/collision/moving_colliders.h"

namespace ricochet {

/// Tests end positions of a particle's steps that all begin at one position. A step is blocked if the closed segment
/// between the two positions intersects a surface. This is decided exactly for planes and triangles. A step is also
/// blocked if the sphere at its end is nearer to a surface than its radius minus half of sphere_tolerance(). A surface
/// that the sphere overlaps at the beginning blocks only if the sphere comes even nearer. Surfaces that a sphere grazes
/// between the two positions are missed, because only the segment of its centre is tested.
class Obstacles {
public:
    /// The radius must have been prepared (CollisionWorld::prepare_radius).
    Obstacles(const CollisionWorld& world, const Vec3& from, double radius)
        : world_(world), bvh_(world.bvh_for(radius)), from_(from), radius_(radius) {}

    /// Returns true if a surface blocks the segment to `to`. Both positions must be finite.
    [[nodiscard]] bool block(const Vec3& to) const;

    /// Collects the surfaces that block the segment to `to`, ascending, each once, with their normals at the free
    /// position p and without seams (drop_seams()). `v` is the velocity, for surfaces that are hit edge-on.
    void gather(const Vec3& to, const Vec3& p, const Vec3& v, std::vector<ContactSurface>& out) const;

private:
    [[nodiscard]] bool blocks(SurfaceId surface, const Vec3& to) const;
    [[nodiscard]] ContactSurface contact_at(SurfaceId surface, const Vec3& p, const Vec3& v) const;
    template <class Found>
    void for_each_blocker(const Vec3& to, Found&& found) const;

    const CollisionWorld& world_;
    const TriangleBvh& bvh_;
    Vec3 from_;
    double radius_;
};

/// Returns true if no surface blocks a space-time segment of a sphere, or of a point (radius 0). Rigid colliders are
/// tested by Obstacles in their own coordinates. Deforming meshes are tested exactly, see DeformingColliders.
[[nodiscard]] bool is_segment_free(const MovingColliders& bodies, const StoredPosition& from, const StoredPosition& to,
                                   double radius);
/// Does the same for a segment of a stalled particle, see DeformingColliders::is_late_segment_free().
[[nodiscard]] bool is_late_segment_free(const MovingColliders& bodies, const StoredPosition& from,
                                        const StoredPosition& to, double radius);

}  // namespace ricochet
