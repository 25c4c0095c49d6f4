/// \file
/// Signed distances of points from the colliders of a scene: the side, the distance and the closest point.
///
/// Planes, balls and cylinders use their formulas. Meshes use the nearest triangle, whose side is decided by
/// pseudonormals (geometry/mesh/pseudonormals.h). The side is correct for meshes that bound a solid and are wound
/// outward. For other meshes it is the side of the nearest sheet, and it is not defined at open edges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/geometry/mesh/pseudonormals.h"

namespace ricochet {

/// The point of a collider's surface that is closest to a point p.
struct SurfacePoint {
    Vec3 point;             ///< on the surface, in m
    Vec3 direction;         ///< unit vector from the surface to p, or the surface's own normal if p lies on it
    double distance = 0.0;  ///< in m, >= 0
    /// Side of the surface that p is on. +1: in front, where its normal points; outside of a ball, a cylinder or a
    /// closed mesh wound outward. -1: behind. 0: on the surface, or undecided (sheets back to back).
    int side = 0;
    SurfaceId surface = 0;  ///< nearest surface; one of them if there are several
    std::uint32_t collider = 0;
    bool on_rim = false;  ///< true if the nearest feature is an open edge or its end, where the side is not defined
};

/// Signed distances of one collision world. Immutable; safe from any number of threads. The nearest triangle is the
/// smallest under (squared distance in doubles, face before edge before vertex, surface), whatever the broad phase
/// proposes. A point on a face's rim that is as near as its face counts as a point of the face.
class SignedDistance {
public:
    /// The world must outlive this object.
    explicit SignedDistance(const CollisionWorld& world);

    /// Returns the point of one collider that is closest to a finite point p. Returns nothing if it is farther away
    /// than `within` (in m, >= 0, may be infinite) or if the collider has no triangle with an area.
    [[nodiscard]] std::optional<SurfacePoint> closest(std::uint32_t collider, const Vec3& p, double within) const;

    /// Appends the closest point of every collider that is at most `within` away, in m, in ascending order of
    /// colliders.
    void near(const Vec3& p, double within, std::vector<SurfacePoint>& out) const;

    /// Returns the number of the collider's surfaces that the closed segment [p, q] intersects. Both ends must be
    /// finite. A segment through an edge intersects both its triangles. For shapes with a formula it is 1 if the ends
    /// are on different sides, and 2 if the segment enters and leaves the shape. The decision whether there is an
    /// intersection is exact for planes and meshes. For shapes it errs on the side of an intersection, by about 2^-90.
    [[nodiscard]] std::size_t count_met(std::uint32_t collider, const Vec3& p, const Vec3& q) const;

private:
    using Kind = CollisionWorld::Kind;

    /// Triangles of a collider: [first_triangle, end_triangle) of the world's, for which pseudonormals are indexed from
    /// 0.
    struct Mesh {
        std::uint32_t collider;
        std::uint32_t first_triangle;
        std::uint32_t end_triangle;
        Pseudonormals normals;
    };

    /// The nearest triangle of a mesh so far.
    struct Candidate {
        std::uint32_t mesh;
        std::uint32_t triangle;
        ClosestPointOnTriangle nearest;
    };

    [[nodiscard]] std::uint32_t mesh_of(std::uint32_t collider) const;
    [[nodiscard]] std::uint32_t mesh_of_triangle(std::uint32_t triangle) const;
    [[nodiscard]] bool improves(const Candidate& best, Candidate& candidate, const Vec3& p) const;
    [[nodiscard]] const std::vector<Candidate>& nearest_triangles(std::uint32_t first, std::uint32_t end, const Vec3& p,
                                                                  double within) const;
    [[nodiscard]] SurfacePoint point_of(const Candidate& candidate, const Vec3& p) const;
    [[nodiscard]] std::optional<SurfacePoint> nearest_of(std::uint32_t collider, const Candidate* candidate,
                                                         const Vec3& p, double within) const;

    const CollisionWorld& world_;
    std::vector<Mesh> meshes_;  ///< in ascending order of the colliders
};

}  // namespace ricochet
