/// \file
/// Distances and normals of surfaces for one thread, with a cache of triangle planes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "ricochet/collision/collision_world.h"
#include "ricochet/geometry/predicates/triangle_plane.h"

namespace ricochet {

/// The planes of the triangles that were used last. An impact uses the same few triangles again and again: for the time
/// of impact, for distances, for normals. Results do not depend on what is cached. For one thread.
class TrianglePlaneCache {
public:
    TrianglePlaneCache() { clear(); }

    /// Needed before the cache serves another world.
    void clear() { triangle_.fill(kNoTriangle); }

    /// Valid until the next call.
    [[nodiscard]] const TrianglePlane& of(const CollisionWorld& world, std::uint32_t triangle) {
        const std::size_t slot = triangle % kSlots;
        if (triangle_[slot] != triangle) {
            const auto [a, b, c] = world.corners_of_triangle(triangle);
            std::construct_at(&plane_[slot], a, b, c);
            triangle_[slot] = triangle;
        }
        return plane_[slot];
    }

private:
    static constexpr std::size_t kSlots = 16;

    std::array<std::uint32_t, kSlots> triangle_;
    std::array<TrianglePlane, kSlots> plane_;
};

/// Distances and normals of surfaces: CollisionWorld's functions of the same names, faster for triangles that were used
/// last. One object serves one particle in one thread; world and cache must outlive it.
class SurfaceGeometry {
public:
    SurfaceGeometry(const CollisionWorld& world, TrianglePlaneCache& cache) : world_(&world), cache_(&cache) {
        cache.clear();
    }

    [[nodiscard]] const TrianglePlane& plane_of(std::uint32_t triangle) const { return cache_->of(*world_, triangle); }
    [[nodiscard]] Vec3 unit_normal_of(SurfaceId surface, const Vec3& p) const {
        const auto triangle = world_->triangle_of(surface);
        return triangle ? plane_of(*triangle).unit_normal() : world_->unit_normal_of(surface, p);
    }
    [[nodiscard]] double signed_distance_from(SurfaceId surface, const Vec3& p) const {
        const auto triangle = world_->triangle_of(surface);
        return triangle ? plane_of(*triangle).signed_distance(p) : world_->signed_distance_from(surface, p);
    }
    [[nodiscard]] CollisionWorld::Nearest nearest(SurfaceId surface, const Vec3& p) const {
        const auto triangle = world_->triangle_of(surface);
        return triangle ? CollisionWorld::nearest(plane_of(*triangle), p) : world_->nearest(surface, p);
    }
    [[nodiscard]] const CollisionWorld& world() const { return *world_; }

private:
    const CollisionWorld* world_;
    TrianglePlaneCache* cache_;
};

}  // namespace ricochet
