/// \file
/// Memory of one thread that contact queries use again and again, so that the loop over particles allocates nothing;
/// with it the distances and normals of surfaces.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/collision/way_point.h"
#include "ricochet/geometry/predicates/triangle_plane.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

// Distances and normals of surfaces for one thread, with a cache of triangle planes.

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
    /// least_offset: m, of contact_offset(), where coordinates are rounded as larger ones are: in a frame that moves.
    SurfaceGeometry(const CollisionWorld& world, TrianglePlaneCache& cache, double least_offset = 0.0)
        : world_(&world), cache_(&cache), least_offset_(least_offset) {
        cache.clear();
    }

    /// The contact offset at a position, m.
    [[nodiscard]] double contact_offset(const Vec3& position) const {
        return std::max(ricochet::contact_offset(position), least_offset_);
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
    double least_offset_ = 0.0;
};

/// Lists of one query; a query overwrites those of the one before.
struct ContactScratch {
    /// A surface that the path reaches.
    struct Hit {
        double time;  ///< s
        SurfaceId surface;
        int side;  ///< of a point's path; unused for spheres
        bool flat;
        Vec3 normal;  ///< for spheres; that of points is worked out for the first contact only
    };
    /// A triangle that comes near after the path's end.
    struct Approach {
        std::uint32_t triangle;
        double begin;  ///< s along the look-ahead's path
    };

    std::vector<std::uint32_t> triangles;  ///< candidates that the path does not clear, up to the first contact found
    std::vector<std::uint32_t> planes;     ///< the same, indices into CollisionWorld::planes()
    std::vector<std::uint32_t> shapes;     ///< the same, indices into CollisionWorld::shapes()
    std::vector<SurfaceId> overlapped;     ///< surfaces that the sphere already overlaps at the path's start
    std::vector<Hit> hits;
    std::vector<Approach> approaches;
    std::vector<WayPoint> chain;  ///< ends of certified segments, see CertifiedPath
    /// Of queries in the frames of other bodies, one each.
    std::vector<std::unique_ptr<ContactScratch>> foreign;
    /// Of a path among colliders that move, see MovingSweep, which has them while it is there.
    struct Sweep {
        std::vector<BodyId> near;
        std::vector<double> tolerances;
        std::vector<double> fourth;  ///< of the bodies near: bounds of the fourth derivative in their frames, m/s^4
        std::vector<double> besides;
        std::vector<Path> clear;  ///< in the frames of the bodies near: what a piece that meets nothing is the begin of
        std::vector<double> cuts;
        std::vector<double> keys;
    };
    Sweep sweep;
    TrianglePlaneCache plane_cache;

    /// Empties the lists of a query.
    void clear() {
        triangles.clear();
        planes.clear();
        shapes.clear();
        overlapped.clear();
        hits.clear();
        approaches.clear();
    }
};

}  // namespace ricochet
