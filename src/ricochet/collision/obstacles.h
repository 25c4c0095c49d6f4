/// \file
/// What stands between two places: the collision test of methods that look at where a step has led to, and no further.
#pragma once

#include <vector>

#include "ricochet/collision/contact.h"

namespace ricochet {

/// Tests one particle's tried places, always against the same place that it comes from. Blocked means: the closed
/// segment between the two places meets a surface (decided exactly for planes and triangles), or at the tried place the
/// sphere comes nearer to a surface than its radius less half of sphere_tolerance(). What it overlaps already where it
/// comes from blocks only when it comes nearer still. A sphere that brushes past something between the two places is
/// not noticed: only the way of the centre is.
class Obstacles {
public:
    /// The radius must have been prepared (CollisionWorld::prepare_radius).
    Obstacles(const CollisionWorld& world, const Vec3& from, double radius)
        : world_(world), bvh_(world.bvh_for(radius)), from_(from), radius_(radius) {}

    /// Both places must be finite.
    [[nodiscard]] bool block(const Vec3& to) const;

    /// The surfaces that block the way to `to`, in ascending order, as a particle at `place` (which is free) sees them:
    /// each once, edges beside a face of the same normal left out. v: velocity, for surfaces met rim-on.
    void gather(const Vec3& to, const Vec3& place, const Vec3& v, std::vector<ContactSurface>& out) const;

private:
    [[nodiscard]] bool blocks(SurfaceId surface, const Vec3& to) const;
    [[nodiscard]] ContactSurface seen_from(SurfaceId surface, const Vec3& place, const Vec3& v) const;
    template <class Found>
    void for_each_blocker(const Vec3& to, Found&& found) const;

    const CollisionWorld& world_;
    const TriangleBvh& bvh_;
    Vec3 from_;
    double radius_;
};

}  // namespace ricochet
