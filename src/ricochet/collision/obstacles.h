/// \file
/// What stands between two positions: the discrete collision test of methods that only check where a step ends.
#pragma once

#include <vector>

#include "ricochet/collision/contact.h"

namespace ricochet {

/// Tests the ends of a particle's steps that all begin at one position. Blocked means: the closed segment between the
/// two positions intersects a surface (decided exactly for planes and triangles), or the sphere at the end is nearer to
/// a surface than its radius less half of sphere_tolerance(). What it overlaps already at the beginning blocks only
/// when it comes nearer still. What a sphere grazes between the two positions is missed: only the segment of its centre
/// is tested.
class Obstacles {
public:
    /// The radius must have been prepared (CollisionWorld::prepare_radius).
    Obstacles(const CollisionWorld& world, const Vec3& from, double radius)
        : world_(world), bvh_(world.bvh_for(radius)), from_(from), radius_(radius) {}

    /// Both positions must be finite.
    [[nodiscard]] bool block(const Vec3& to) const;

    /// The surfaces that block the segment to `to`, in ascending order, with their normals at the free position p: each
    /// once, without edges beside a face of the same normal. v: velocity, for surfaces that are hit edge-on.
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

}  // namespace ricochet
