/// \file
/// Private: a mesh with the data structures that its queries need. Structures that only some queries need are built on
/// first use.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/geometry/acceleration/triangle_bvh.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/mesh/mesh_interior.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/queries/mesh_queries.h"
#include "ricochet/queries/mesh_winding.h"

namespace ricochet {

/// Number of queries per block of parallel work.
inline constexpr std::size_t kQueryBlock = 256;

/// Mesh with its data structures. Any number of threads may use it.
class MeshIndex {
public:
    /// Throws like MeshQueries.
    explicit MeshIndex(TriangleMesh mesh);
    /// Combines the triangles of another index with new vertices, and keeps the structure of its hierarchy.
    MeshIndex(const MeshIndex& other, std::span<const Vec3> vertices);

    struct Corners {
        const Vec3& a;
        const Vec3& b;
        const Vec3& c;
    };
    [[nodiscard]] Corners corners(std::uint32_t triangle) const {
        const Triangle& t = mesh_->triangles[triangle];
        return {mesh_->vertices[t[0]], mesh_->vertices[t[1]], mesh_->vertices[t[2]]};
    }
    /// Returns true for triangles without area.
    [[nodiscard]] bool is_degenerate(std::uint32_t triangle) const {
        return !degenerate_.empty() && degenerate_[triangle] != 0;
    }
    [[nodiscard]] const TriangleMesh& mesh() const { return *mesh_; }
    [[nodiscard]] const Box3& box() const { return box_; }
    /// Returns the hierarchy for spheres up to a radius, in m. There is one hierarchy for each power of two.
    [[nodiscard]] const TriangleBvh& hierarchy(double radius = 0.0) const;
    [[nodiscard]] bool is_closed() const;
    /// Throws InputError if the mesh is open, or if the rule needs a consistent winding and the mesh has none.
    [[nodiscard]] const MeshInterior& interior(InsideRule rule) const;
    [[nodiscard]] const std::vector<BoundaryEdge>& boundary() const;

private:
    void finish();

    std::shared_ptr<const TriangleMesh> mesh_;
    std::vector<std::uint8_t> degenerate_;  ///< empty if no triangle is degenerate
    Box3 box_;
    TriangleBvh::Clusters clusters_;
    std::unique_ptr<TriangleBvh> for_points_;
    mutable std::mutex making_;
    mutable std::map<int, std::unique_ptr<TriangleBvh>> for_spheres_;  ///< by the exponent of the radius
    mutable std::optional<ClosedSurface> closed_;
    mutable std::unique_ptr<MeshInterior> interior_;
    mutable std::optional<std::vector<BoundaryEdge>> boundary_;
};

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Returns `count` results without a hit.
[[nodiscard]] MeshHits no_hits(std::size_t count);

/// Throws InputError "NAME[i]: found ..., expected ..." for the first point that is not finite or beyond 1e75.
void require_positions(std::span<const Vec3> points, const char* name);

}  // namespace ricochet
