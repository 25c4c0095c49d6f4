/// \file
/// Memory of one thread that contact queries reuse, so that the loop over particles allocates nothing. The file also
/// defines the distances and normals of surfaces.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/collision/surfaces_in_time.h"
#include "ricochet/geometry/predicates/triangle_plane.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

// Distances and normals of surfaces for one thread, with a cache of triangle planes.

/// Cache of the triangle planes used last. An impact needs the planes of the same few triangles several times: for the
/// time of impact, for distances and for normals. Results do not depend on the cache. For use by one thread.
class TrianglePlaneCache {
public:
    TrianglePlaneCache() { clear(); }

    /// Empties the cache. Required before the cache is used with another world.
    void clear() { triangle_.fill(kNoTriangle); }

    /// Returns the plane of a triangle. The reference is valid until the next call.
    [[nodiscard]] const TrianglePlane& of(const CollisionWorld& world, std::uint32_t triangle) {
        const std::size_t slot = triangle % kSlots;
        if (triangle_[slot] != triangle) {
            plane_[slot] = world.plane_of_triangle(triangle);
            triangle_[slot] = triangle;
        }
        return plane_[slot];
    }

private:
    static constexpr std::size_t kSlots = 16;

    std::array<std::uint32_t, kSlots> triangle_;
    std::array<TrianglePlane, kSlots> plane_;
};

/// Distances and normals of surfaces. It has some functions of CollisionWorld, in versions that are faster for recently
/// used triangles. Each object is for one particle in one thread. World and cache must outlive it.
class SurfaceGeometry {
public:
    /// `least_offset` is the smallest contact offset, in m. Moving frames need it, because their coordinates have the
    /// rounding errors of larger coordinates.
    SurfaceGeometry(const CollisionWorld& world, TrianglePlaneCache& cache, double least_offset = 0.0)
        : world_(&world), cache_(&cache), least_offset_(least_offset) {
        cache.clear();
    }

    /// Returns the contact offset at a position, in m.
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
    [[nodiscard]] double time_over(SurfaceId surface, const Path& path, double slack) const {
        const auto triangle = world_->triangle_of(surface);
        if (!triangle) return world_->time_over(surface, path, slack);
        const TrianglePlane& plane = plane_of(*triangle);
        return triangle_exit_time(path, plane.a(), plane.b(), plane.c(), plane.unit_normal(), slack);
    }
    [[nodiscard]] const CollisionWorld& world() const { return *world_; }

private:
    const CollisionWorld* world_;
    TrianglePlaneCache* cache_;
    double least_offset_ = 0.0;
};

/// Lists of one query. The next query overwrites them.
struct ContactScratch {
    /// A surface that the path reaches.
    struct Hit {
        double time;  ///< in s
        SurfaceId surface;
        int side;  ///< side that a point comes from; unused for spheres
        bool flat;
        Vec3 normal;  ///< set for spheres; for points it is computed for the first contact only
    };
    /// A triangle that comes near after the path's end.
    struct Approach {
        std::uint32_t triangle;
        double begin;  ///< time along the look-ahead's path, in s
    };

    std::vector<std::uint32_t> triangles;  ///< candidates that may touch the path, up to the first contact found
    std::vector<std::uint32_t> planes;     ///< planes that may touch it, as indices into CollisionWorld::planes()
    std::vector<std::uint32_t> shapes;     ///< shapes that may touch it, as indices into CollisionWorld::shapes()
    std::vector<SurfaceId> overlapped;     ///< supports, and surfaces that the sphere overlaps at the path's start
    std::vector<Hit> hits;
    std::vector<Approach> approaches;
    std::vector<PathPoint> chain;  ///< ends of certified segments, see CertifiedPath
    /// Scratch memory of queries in the frames of other bodies, one each.
    std::vector<std::unique_ptr<ContactScratch>> other_frames;
    /// Lists of a path among moving colliders. MovingPieces own them during their lifetime.
    struct Sweep {
        /// A body near the path.
        struct NearBody {
            BodyId id = kWorldBody;
            double tolerance = 0.0;  ///< largest deviation of a piece from the true path in the body's coordinates, m
            double fourth = 0.0;     ///< bound of the path's fourth derivative there, in m/s^4
            double beside = 0.0;     ///< distance from a clear piece within which surfaces are queried, in m
            Path clear{};            ///< piece without contact, or its beginning, in the body's coordinates
        };
        std::vector<BodyId> near;
        std::vector<NearBody> bodies;
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
