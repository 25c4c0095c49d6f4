/// \file
/// Exact geometric queries on one mesh, without particles, for many rays, points and sweeps at once. They find the
/// first hit or all hits of a ray, inside points, nearest points, and the first contact of moving points and spheres.
///
/// Hits and their order are decided exactly for the given doubles: a hit or a miss is certain, also at edges and
/// vertices, and far from the origin. Results have the same bits for any number of threads and any order of the
/// queries. Surfaces are hit from both sides. A ray that begins on the surface hits it at distance 0. Triangles without
/// area are ignored, because their neighbours' edges cover them.
#pragma once

#include <cstddef>
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
    std::vector<double> distance;        ///< from the origin of a ray, in m; for a sweep the fraction of its path, in
                                         ///< [0, 1]
    std::vector<Vec3> point;             ///< in m, on the triangle, rounded
};

/// All hits of rays. Ray i has the hits [first[i], first[i + 1]), in the order along the ray.
struct AllMeshHits {
    std::vector<std::uint64_t> first;  ///< one entry more than rays
    MeshHits hits;
    std::vector<std::int8_t> crossing;   ///< +1 if the ray leaves through the surface (along its normal), -1 if it
                                         ///< enters, 0 if it only touches
    std::vector<std::uint8_t> in_plane;  ///< 1 if the ray lies in the planes of all triangles that it meets there
};

/// Points of the mesh nearest to given points.
struct NearestPoints {
    std::vector<std::int64_t> triangle;
    std::vector<double> distance;  ///< in m, with a relative error of some 2^-50
    std::vector<Vec3> point;       ///< in m
};

/// Batch of rays, with as many directions as origins. most: range of each ray, in m. It is empty (infinite for all),
/// has one entry for all rays, or one per ray.
struct RayBatch {
    std::span<const Vec3> origins;
    /// Nonzero vectors of any length. Components below 2^-287 of the largest count as zero, as do coordinates below
    /// 2^-287 m.
    std::span<const Vec3> directions;
    std::span<const double> most = {};
};

/// A mesh to query. Copies share its data structures. Any number of threads may use it at once; each query uses all
/// threads that ThreadLimit allows. All queries throw InputError, naming the first invalid entry: a value that is not
/// finite, a coordinate beyond 1e75, a direction of length 0, or a wrong number of entries.
class MeshQueries {
public:
    /// Throws InputError for a mesh without triangles, for indices past the end, and for vertices that are not finite
    /// or beyond 1e75.
    explicit MeshQueries(TriangleMesh mesh);
    // A move is a copy, so that no moved-from object without a mesh exists.
    MeshQueries(const MeshQueries&) = default;
    MeshQueries& operator=(const MeshQueries&) = default;
    ~MeshQueries() = default;

    [[nodiscard]] const TriangleMesh& mesh() const;
    /// Moves the vertices and keeps the triangles. The hierarchy keeps its shape and is refitted, which costs less than
    /// a new one. Results equal the results of a new object. Copies of this object keep the old vertices. Throws like
    /// the constructor, and for another number of vertices; then nothing has changed.
    void set_vertices(std::span<const Vec3> vertices);
    /// Returns true if the mesh has an inside: every edge belongs to an even number of triangles. Vertices at equal
    /// positions are one vertex, and triangles that repeat an earlier one count once. The winding of the triangles has
    /// no influence. If it is inconsistent, the signs of crossings and of the volume mean nothing.
    [[nodiscard]] bool is_closed() const;

    /// Returns the first hit of every ray.
    [[nodiscard]] MeshHits first_hits(const RayBatch& rays) const;
    /// Returns every hit of every ray once. Triangles that share the edge or vertex at which they are hit give one hit.
    /// A path along the surface is also one hit, at its start.
    [[nodiscard]] AllMeshHits all_hits(const RayBatch& rays) const;
    /// Returns the number of hits of each ray.
    [[nodiscard]] std::vector<std::uint64_t> count_hits(const RayBatch& rays) const;
    /// Returns 1 for rays that hit anything. It is cheaper than first_hits().
    [[nodiscard]] std::vector<std::uint8_t> occluded(const RayBatch& rays) const;

    /// Returns 1 for points inside a closed mesh, exactly, and 0 for points on its surface. Throws InputError if the
    /// mesh is open, or if the rule needs a consistent winding and there is none.
    [[nodiscard]] std::vector<std::uint8_t> inside(std::span<const Vec3> points,
                                                   InsideRule rule = InsideRule::parity) const;
    /// Returns winding numbers of the mesh around points: 1 inside a closed mesh wound outward, -1 if it is wound
    /// inward, 0 outside. They add up if shells overlap and triangles repeat. For an open mesh they are the
    /// fraction of all directions that see its back, less the fraction that see its front. The error is usually some
    /// 2^-50, and at most some 2^-32 for each boundary edge.
    [[nodiscard]] std::vector<double> winding_numbers(std::span<const Vec3> points) const;
    /// Returns the nearest points of the mesh, with triangle kNoHit if none is within `within` (in m, >= 0).
    [[nodiscard]] NearestPoints closest_points(std::span<const Vec3> points,
                                               double within = std::numeric_limits<double>::infinity()) const;
    /// Returns distances from the surface, in m, negative inside by the rule. The sign is exact. Throws like inside().
    [[nodiscard]] std::vector<double> signed_distances(std::span<const Vec3> points,
                                                       InsideRule rule = InsideRule::parity) const;

    /// Returns the first contacts of points (radius 0) or spheres on straight paths. radii: in m, one for all or one
    /// each. For points the closed segment between the two positions decides, exactly. `distance` is the fraction of
    /// the path, `point` lies on the mesh. A sphere that overlaps the mesh from the start is stopped if it approaches.
    [[nodiscard]] MeshHits sweep(std::span<const Vec3> from, std::span<const Vec3> to,
                                 std::span<const double> radii) const;
    /// Returns the first contacts while the mesh's vertices move straight to `vertices_after`. No contact is missed. A
    /// point on the mesh at the start hits it at fraction 0.
    /// A sphere that overlaps a triangle from the start without approaching it is stopped when it comes nearer than at
    /// the start. It is also stopped when it hits the triangle again after it has separated. The separation is tested
    /// at every 64th of the path.
    [[nodiscard]] MeshHits sweep_moving(std::span<const Vec3> from, std::span<const Vec3> to,
                                        std::span<const double> radii, std::span<const Vec3> vertices_after) const;

private:
    std::shared_ptr<const MeshIndex> index_;
};

}  // namespace ricochet
