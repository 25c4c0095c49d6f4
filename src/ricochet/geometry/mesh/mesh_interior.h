/// \file
/// Inside or outside of a closed mesh, exactly, for many points of one mesh.
///
/// Counts the crossings of the ray upwards (along z) from the point, which counts as moved by an infinitesimal amount
/// along y and a still smaller one along x (symbolic perturbation: H. Edelsbrunner, E. P. Muecke, "Simulation of
/// Simplicity", ACM Transactions on Graphics 9, 1990), so that the ray hits neither edges nor vertices. Signs come from
/// the exact predicates.
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

/// Returns true if the mesh separates an inside from an outside, see closed_surface.h.
[[nodiscard]] bool is_closed(const TriangleMesh& mesh);

/// Thread-safe. For closed meshes only (closed_surface.h).
class MeshInterior {
public:
    explicit MeshInterior(std::shared_ptr<const TriangleMesh> mesh);
    /// left_out: what closed_surface() says of the mesh.
    MeshInterior(std::shared_ptr<const TriangleMesh> mesh, const std::vector<std::uint32_t>& left_out);

    /// Exact; false for a point on the surface itself.
    [[nodiscard]] bool contains(const Vec3& point, InsideRule rule = InsideRule::parity) const;
    /// Winding number at a finite point within box(), without the triangles of one shell. shell_of: shell of each
    /// triangle. Exact for the point moved as above.
    [[nodiscard]] std::int64_t winding_without(const Vec3& point, const std::vector<std::uint32_t>& shell_of,
                                               std::uint32_t shell) const;
    [[nodiscard]] const Box3& box() const { return box_; }

private:
    /// Along x and y, of a triangle.
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
    std::size_t cells_ = 1;  // columns along x and y each
    std::vector<std::uint32_t> column_begin_;
    std::vector<std::uint32_t> column_triangles_;
};

}  // namespace ricochet
