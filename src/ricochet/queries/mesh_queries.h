/// \file
/// Exact geometric queries on one mesh, without particles, for many rays, points and sweeps at once. Queries find hits
/// of rays, points inside the mesh, nearest points, and the first contact of moving points and spheres.
///
/// Hits and their order are exact for the given doubles. A hit or a miss is certain, also at edges and vertices, and
/// far from the origin. Results have the same bits for any number of threads and any order of the queries. Surfaces are
/// hit from both sides. A ray that begins on the surface hits it at distance 0. Triangles without area are ignored,
/// because the edges of their neighbours cover them.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/inside_rule.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

class MeshIndex;

/// Index that means "no triangle".
inline constexpr std::int64_t kNoHit = -1;

/// Hits of the mesh, one entry per query. An entry without a hit has triangle kNoHit, distance infinity and point NaN.
struct MeshHits {
    std::vector<std::int64_t> triangle;  ///< index; the smallest one if several are hit at the same point
    /// Distance from the origin of a ray, in m. For a sweep it is the fraction of the path, in [0, 1].
    std::vector<double> distance;
    std::vector<Vec3> point;  ///< in m, on the triangle, rounded
};

/// All hits of rays. Ray i has the hits [first[i], first[i + 1]), in the order along the ray.
struct AllMeshHits {
    std::vector<std::uint64_t> first;  ///< one entry more than there are rays
    MeshHits hits;
    /// +1 if the ray leaves through the surface (along its normal), -1 if the ray enters, 0 if it only touches.
    std::vector<std::int8_t> crossing;
    std::vector<std::uint8_t> in_plane;  ///< 1 if the ray lies in the planes of all triangles of the hit
};

/// Points of the mesh nearest to given points.
struct NearestPoints {
    std::vector<std::int64_t> triangle;
    std::vector<double> distance;  ///< in m, with a relative error of about 2^-50
    std::vector<Vec3> point;       ///< in m
};

/// Batch of rays, with as many directions as origins. most: range of each ray, in m. `most` is empty (infinite for all
/// rays), has one entry for all rays, or has one entry per ray.
struct RayBatch {
    std::span<const Vec3> origins;
    /// Nonzero vectors of any length. Components below 2^-287 of the largest count as zero, as do coordinates below
    /// 2^-287 m.
    std::span<const Vec3> directions;
    std::span<const double> most = {};
};

/// A mesh to query. Copies share the data structures. Any number of threads may use the object at once, and each query
/// runs on all threads that ThreadLimit allows. All queries throw InputError, naming the first invalid entry: a value
/// that is not finite, a coordinate beyond 1e75, a direction of length 0, or a wrong number of entries.
class MeshQueries {
public:
    /// Throws InputError for a mesh without triangles, for indices past the end, and for vertices that are not finite
    /// or beyond 1e75.
    explicit MeshQueries(TriangleMesh mesh);
    // A move is a copy, so that every object, also a moved one, has a mesh.
    MeshQueries(const MeshQueries&) = default;
    MeshQueries& operator=(const MeshQueries&) = default;
    ~MeshQueries() = default;

    [[nodiscard]] const TriangleMesh& mesh() const;
    /// Moves the vertices and keeps the triangles. The hierarchy keeps its structure and is refitted, which takes less
    /// time than a new build. Results equal the results of a new object. Copies of this object keep the old vertices.
    /// Throws like the constructor, and for a different number of vertices. After an exception, nothing has changed.
    void set_vertices(std::span<const Vec3> vertices);
    /// Returns true if the mesh has an inside: every edge belongs to an even number of triangles. Vertices at equal
    /// positions are one vertex, and triangles that repeat an earlier one count once. The winding of the triangles has
    /// no influence. If the winding is inconsistent, the signs of crossings and of the volume are meaningless.
    [[nodiscard]] bool is_closed() const;

    /// Returns the first hit of every ray.
    [[nodiscard]] MeshHits first_hits(const RayBatch& rays) const;
    /// Returns every hit of every ray once. If the ray hits several triangles at an edge or vertex that they share,
    /// they give one hit. A section of the ray along the surface also gives one hit, at the start of the section.
    [[nodiscard]] AllMeshHits all_hits(const RayBatch& rays) const;
    /// Returns the number of hits of each ray.
    [[nodiscard]] std::vector<std::uint64_t> count_hits(const RayBatch& rays) const;
    /// Returns 1 for rays that hit the mesh, else 0. This takes less time than first_hits().
    [[nodiscard]] std::vector<std::uint8_t> occluded(const RayBatch& rays) const;

    /// Returns 1 for points inside a closed mesh, exactly, and 0 for points on its surface. Throws InputError if the
    /// mesh is open, or if the rule needs a consistent winding and the mesh has none.
    [[nodiscard]] std::vector<std::uint8_t> inside(std::span<const Vec3> points,
                                                   InsideRule rule = InsideRule::parity) const;
    /// Returns winding numbers of the mesh around points: 1 inside a closed mesh wound outward, -1 if it is wound
    /// inward, 0 outside. The numbers of overlapping shells and repeated triangles add up. For an open mesh the number
    /// is the fraction of all directions from the point that hit the back of the surface. The fraction that hits its
    /// front is subtracted. The error is usually about 2^-50, and at most about 2^-32 for each boundary edge.
    [[nodiscard]] std::vector<double> winding_numbers(std::span<const Vec3> points) const;
    /// Returns the nearest points of the mesh. The triangle is kNoHit if no point of the mesh is within `within` (in m,
    /// >= 0).
    [[nodiscard]] NearestPoints closest_points(std::span<const Vec3> points,
                                               double within = std::numeric_limits<double>::infinity()) const;
    /// Returns distances from the surface, in m. Distances are negative for points that are inside by the rule. The
    /// sign is exact. Throws like inside().
    [[nodiscard]] std::vector<double> signed_distances(std::span<const Vec3> points,
                                                       InsideRule rule = InsideRule::parity) const;

    /// Returns the first contacts of points (radius 0) or spheres on straight paths. radii: in m, one for all paths or
    /// one for each. For points, an exact test of the closed segment between the two positions decides whether there is
    /// a contact. In the result, `distance` is the fraction of the path, and `point` is on the mesh. A sphere that
    /// overlaps the mesh at the start has a contact if it approaches.
    [[nodiscard]] MeshHits sweep(std::span<const Vec3> from, std::span<const Vec3> to,
                                 std::span<const double> radii) const;
    /// Returns the first contacts while the mesh's vertices move straight to `vertices_after`. No contact is missed. A
    /// point that is on the mesh at the start hits the mesh at fraction 0.
    /// A sphere can overlap a triangle at the start without approaching it. Such a sphere has a contact when it comes
    /// nearer to the triangle than at the start. It also has a contact when it hits the triangle again after a
    /// separation. Separation is tested at every 64th of the path.
    [[nodiscard]] MeshHits sweep_moving(std::span<const Vec3> from, std::span<const Vec3> to,
                                        std::span<const double> radii, std::span<const Vec3> vertices_after) const;

private:
    std::shared_ptr<const MeshIndex> index_;
};

}  // namespace ricochet
