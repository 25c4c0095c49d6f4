/// \file
/// Exact test whether points are inside a closed mesh, for many points of one mesh.
///
/// The test counts the crossings of the upward ray (along z) from the point. The point is treated as moved by an
/// infinitesimal amount along y and by a still smaller amount along x. The ray therefore hits neither edges nor
/// vertices (symbolic perturbation: H. Edelsbrunner, E. P. Muecke, "Simulation of Simplicity", ACM Transactions on
/// Graphics 9, 1990). Signs come from the exact predicates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/inside_rule.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Returns true if the mesh separates an inside from an outside, as defined in closed_surface.h.
[[nodiscard]] bool is_closed(const TriangleMesh& mesh);

/// The interior of a closed mesh (closed_surface.h). Thread-safe.
class MeshInterior {
public:
    explicit MeshInterior(std::shared_ptr<const TriangleMesh> mesh);
    /// Uses known triangles to leave out, instead of computing them. left_out: ClosedSurface::left_out of the mesh.
    MeshInterior(std::shared_ptr<const TriangleMesh> mesh, const std::vector<std::uint32_t>& left_out);

    /// Returns true if the point is inside, exactly. A point on the surface itself is not inside.
    [[nodiscard]] bool contains(const Vec3& point, InsideRule rule = InsideRule::parity) const;
    /// Returns the winding number at a finite point within box(), without the triangles of one shell. `shell_of` is the
    /// shell of each triangle. The result is exact for the infinitesimally moved point.
    [[nodiscard]] std::int64_t winding_without(const Vec3& point, const std::vector<std::uint32_t>& shell_of,
                                               std::uint32_t shell) const;
    [[nodiscard]] const Box3& box() const { return box_; }

private:
    /// The range of columns that a triangle covers, along x and y.
    struct Columns {
        std::array<std::size_t, 2> first;
        std::array<std::size_t, 2> last;
    };
    [[nodiscard]] Columns columns_of(const Triangle& t) const;
    [[nodiscard]] std::size_t entries(const std::vector<std::uint32_t>& left_out) const;
    [[nodiscard]] std::size_t cell_of(double value, int axis) const;
    void fill_columns(const std::vector<std::uint32_t>& left_out);

    std::shared_ptr<const TriangleMesh> mesh_;
    Box3 box_;
    std::size_t cells_ = 1;  // columns along x and along y
    std::vector<std::uint32_t> column_begin_;
    std::vector<std::uint32_t> column_triangles_;
};

}  // namespace ricochet
