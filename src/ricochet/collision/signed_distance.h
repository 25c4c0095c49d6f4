/// \file
/// Where is a point with respect to the colliders of a scene: on which side, how far, and where is the closest point?
///
/// Planes, balls and cylinders answer by their formula. Meshes answer by the nearest triangle, whose side is judged by
/// pseudonormals (geometry/mesh/pseudonormals.h): right for meshes that bound a solid and are wound outward; everywhere
/// else it is the side of the nearest sheet, and at open edges it means nothing.
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
    Vec3 point;             ///< on the surface, m
    Vec3 direction;         ///< unit, from the surface to p; the surface's own normal where p lies on it
    double distance = 0.0;  ///< m, >= 0
    int side = 0;           ///< +1: where the surface's normal points to (outside of a ball, a cylinder, a closed mesh
                            ///< wound outward); -1: behind; 0: on it, or undecided (sheets back to back)
    SurfaceId surface = 0;  ///< a nearest one
    std::uint32_t collider = 0;
    bool on_rim = false;  ///< nearest is an open edge or its end, where sides mean nothing
};

/// Immutable; safe from any number of threads. Results depend neither on the broad phase nor on the order in which it
/// proposes triangles: nearest is the smallest under (squared distance in doubles, face before edge before vertex,
/// surface). A point on a face's rim that is as near as its face counts as the face's.
class SignedDistance {
public:
    /// The world must outlive it.
    explicit SignedDistance(const CollisionWorld& world);

    /// The point of one collider closest to p (finite); nothing when it is farther away than `within` (m, >= 0, may be
    /// infinite) or the collider has no triangle with an area.
    [[nodiscard]] std::optional<SurfacePoint> closest(std::uint32_t collider, const Vec3& p, double within) const;

    /// The same of every collider that has one within that distance, appended in ascending order of the colliders.
    /// Allocates only while `out` grows (and once a thread).
    void near(const Vec3& p, double within, std::vector<SurfacePoint>& out) const;

    /// Does the closed segment [p, q] intersect any surface of the collider? Exact for planes and meshes; errs on the
    /// side of true for shapes with a formula, by some 2^-90. Both ends must be finite.
    [[nodiscard]] bool segment_intersects(std::uint32_t collider, const Vec3& p, const Vec3& q) const;

    /// How many surfaces of the collider the closed segment [p, q] intersects; one through an edge intersects both its
    /// triangles. Of a shape with a formula 1 when the ends are on different sides, 2 when it goes in and out.
    [[nodiscard]] std::size_t count_met(std::uint32_t collider, const Vec3& p, const Vec3& q) const;

    /// Bytes held besides the world.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    enum class Kind : std::uint8_t { plane, shape, mesh, elsewhere };

    /// Where a collider is found: an index into the world's planes or shapes, or into meshes_.
    struct Part {
        Kind kind;
        std::uint32_t index;
    };

    /// A collider's triangles, [first_triangle, end_triangle) of the world's; the pseudonormals count from the first.
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

    class NearSearch;

    void add_mesh(std::uint32_t collider);
    template <class Found>
    void visit_intersected(std::uint32_t collider, const Vec3& p, const Vec3& q, Found&& found) const;
    [[nodiscard]] std::uint32_t mesh_of_triangle(std::uint32_t triangle) const;
    template <class Visit>
    void visit_near(const Vec3& p, double within, Visit&& visit) const;
    [[nodiscard]] ClosestPointOnTriangle nearest_on(std::uint32_t triangle, const Vec3& p) const;
    [[nodiscard]] bool improves(const Candidate& best, Candidate& candidate, const Vec3& p) const;
    [[nodiscard]] std::optional<Candidate> nearest_triangle(std::uint32_t mesh, const Vec3& p, double within) const;
    [[nodiscard]] std::optional<SurfacePoint> nearest_of_plane(std::uint32_t index, const Vec3& p, double within) const;
    [[nodiscard]] std::optional<SurfacePoint> nearest_of_shape(std::uint32_t index, const Vec3& p, double within) const;
    [[nodiscard]] std::optional<SurfacePoint> nearest_of_mesh(const Candidate& candidate, const Vec3& p,
                                                              double within) const;

    const CollisionWorld& world_;
    std::vector<Part> parts_;   ///< per collider
    std::vector<Mesh> meshes_;  ///< ascending
};

}  // namespace ricochet
