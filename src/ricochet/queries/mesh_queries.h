/// \file
/// Exact questions about one mesh, without any particle, for many rays, points and ways at once: what does a ray hit
/// first, or everywhere; what is inside; what is nearest; what does a moving point or sphere meet.
///
/// Whether something is hit, and what comes first, is decided exactly for the doubles given: a hit or a miss is
/// certain, also at edges and vertices, also far from the origin. Answers are the same bits for any number of threads
/// and any order of the questions. Surfaces are hit from both sides; a ray that begins on the surface hits it at
/// distance 0. Triangles without area take no part: their neighbours' edges cover them.
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

/// What stands for a triangle where there is none.
inline constexpr std::int64_t kNoHit = -1;

/// Where something hits the mesh, one entry a question. Where nothing is hit: triangle kNoHit, distance infinite, point
/// NaN.
struct MeshHits {
    std::vector<std::int64_t> triangle;  ///< index; of several hit at the same point: the smallest
    std::vector<double> distance;        ///< m from the origin of a ray; of a sweep: fraction of its way, in [0, 1]
    std::vector<Vec3> point;             ///< m, on the triangle, rounded
};

/// All hits of rays: those of ray i are [first[i], first[i + 1]), in the order along the ray.
struct AllMeshHits {
    std::vector<std::uint64_t> first;  ///< one more than rays
    MeshHits hits;
    std::vector<std::int8_t> crossing;  ///< +1 where the ray leaves through the surface (along its normal), -1 where it
                                        ///< enters, 0 where it only touches
    std::vector<std::uint8_t> in_plane;  ///< 1 where the ray runs in the planes of all triangles that it meets there
};

/// Points of the mesh nearest to points.
struct NearestPoints {
    std::vector<std::int64_t> triangle;
    std::vector<double> distance;  ///< m, with an error of some 2^-50 of itself
    std::vector<Vec3> point;       ///< m
};

/// Rays: as many directions as origins. most: m, how far each ray reaches; none for all (they are infinite), or one for
/// all, or one each.
struct RayBatch {
    std::span<const Vec3> origins;
    /// Of any length above 0. Components below 2^-287 of the largest count as zero, as do coordinates below 2^-287 m.
    std::span<const Vec3> directions;
    std::span<const double> most = {};
};

/// A mesh to ask about. Copies share what they ask. May be asked from any number of threads at once; each question uses
/// all threads that ThreadLimit allows. All questions throw InputError, naming the first entry that cannot be: what is
/// not finite, coordinates beyond 1e75, a direction of length 0, lengths that do not fit.
class MeshQueries {
public:
    /// Throws InputError for a mesh without triangles, indices past the end, and vertices that are not finite or beyond
    /// 1e75.
    explicit MeshQueries(TriangleMesh mesh);
    // Moves are copies, so that there is none that cannot be asked.
    MeshQueries(const MeshQueries&) = default;
    MeshQueries& operator=(const MeshQueries&) = default;
    ~MeshQueries() = default;

    [[nodiscard]] const TriangleMesh& mesh() const;
    /// The same triangles with vertices elsewhere: the hierarchy keeps its shape and is fitted again, which costs less
    /// than a new one. Answers are those of a new one. Copies of this object keep asking the old vertices. Throws as
    /// the constructor does, and for another number of vertices; then nothing has changed.
    void set_vertices(std::span<const Vec3> vertices);
    /// Returns true if there is an inside: every edge belongs to an even number of triangles. Vertices at equal
    /// positions are one vertex, and triangles that repeat an earlier one count once. The winding of the triangles has
    /// no influence; where it changes, the signs of crossings and of the volume mean nothing.
    [[nodiscard]] bool is_closed() const;

    /// The first hit of every ray.
    [[nodiscard]] MeshHits first_hits(const RayBatch& rays) const;
    /// Every place where a ray meets the surface, once: what triangles share, an edge or a vertex, is one place, and so
    /// is a way along the surface, which is where it begins.
    [[nodiscard]] AllMeshHits all_hits(const RayBatch& rays) const;
    /// How many these are.
    [[nodiscard]] std::vector<std::uint64_t> count_hits(const RayBatch& rays) const;
    /// 1 for rays that hit anything; cheaper than first_hits().
    [[nodiscard]] std::vector<std::uint8_t> occluded(const RayBatch& rays) const;

    /// Returns 1 for points inside a closed mesh, exactly, and 0 for points on its surface. Throws InputError if the
    /// mesh is open, or if the rule needs a consistent winding and there is none.
    [[nodiscard]] std::vector<std::uint8_t> inside(std::span<const Vec3> points,
                                                   InsideRule rule = InsideRule::parity) const;
    /// Winding numbers of the mesh around points: 1 inside a closed mesh wound outward, -1 if it is wound inward, 0
    /// outside, and added up where shells overlap and triangles repeat. Around points beside an open mesh the part of
    /// all directions in which its back faces the point, less that in which its front does. The error is at most some
    /// 2^-32 for each boundary edge, and 2^-50 as a rule.
    [[nodiscard]] std::vector<double> winding_numbers(std::span<const Vec3> points) const;
    /// The nearest points of the mesh; triangle kNoHit where none is within `within` (m, >= 0).
    [[nodiscard]] NearestPoints closest_points(std::span<const Vec3> points,
                                               double within = std::numeric_limits<double>::infinity()) const;
    /// Returns distances from the surface, m, negative inside by the rule. The sign is exact. Throws as inside() does.
    [[nodiscard]] std::vector<double> signed_distances(std::span<const Vec3> points,
                                                       InsideRule rule = InsideRule::parity) const;

    /// What points (radius 0) or spheres on straight ways meet first. radii: m, one for all or one each. For points the
    /// closed segment between the two positions decides, exactly. `distance` is the fraction of the way, `point` the
    /// mesh's. A sphere that overlaps the mesh from the start is stopped when it approaches.
    [[nodiscard]] MeshHits sweep(std::span<const Vec3> from, std::span<const Vec3> to,
                                 std::span<const double> radii) const;
    /// The same while the mesh's vertices go straight from where they are to `vertices_after`: no contact is missed. A
    /// point on the mesh at the start meets it at fraction 0. A sphere that overlaps a triangle from the start and does
    /// not approach it then is stopped where it comes nearer than at the start, and where it meets it again after it
    /// has come off; that it has is seen every 64th of the way.
    [[nodiscard]] MeshHits sweep_moving(std::span<const Vec3> from, std::span<const Vec3> to,
                                        std::span<const double> radii, std::span<const Vec3> vertices_after) const;

private:
    std::shared_ptr<const MeshIndex> index_;
};

}  // namespace ricochet
