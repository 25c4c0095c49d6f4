/// \file
/// Memory of one thread that contact queries use again and again, so that the loop over particles allocates nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/collision/surface_geometry.h"

namespace ricochet {

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
    std::vector<Vec3> chain;  ///< ends of certified segments, see CertifiedPath
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
