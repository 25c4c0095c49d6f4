#include "ricochet/geometry/mesh/mesh_interior.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/box_tools.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// Local, because only the cost depends on it.
constexpr double kMaxCells = 1024.0;  // along either axis; a million columns suffice for any mesh

/// Largest number of entries in the column lists: per triangle, and in addition for every mesh. With fewer entries, the
/// columns of ordinary meshes would be too wide. With more, large triangles on top of each other would take too much
/// memory.
constexpr std::size_t kEntriesPerTriangle = 64;
constexpr std::size_t kEntries = std::size_t{1} << 20;

Point2 flat(const Vec3& p) { return {p.x, p.y}; }

// Returns true if the horizontal ray from the moved point p to the right crosses the edge from a to b, seen from above.
bool crosses_right(const Vec3& a, const Vec3& b, const Vec3& p) {
    const bool a_is_above = a.y > p.y;  // p is moved up, so a point with equal y is below p
    if (a_is_above == (b.y > p.y)) return false;
    const Vec3& low = a_is_above ? b : a;
    const Vec3& high = a_is_above ? a : b;
    int turn = orient2d(flat(low), flat(high), flat(p));  // +1: p is on the left
    if (turn == 0) turn = high.x > low.x ? 1 : (high.x < low.x ? -1 : 0);
    return turn > 0;  // 0: the edge runs along y, and the moved point is to the right of it
}

// Returns +1 if the upward ray from the moved point crosses the triangle along its normal, -1 if against the normal,
// else 0.
int crossing(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
    const bool covers = crosses_right(a, b, p) ^ crosses_right(b, c, p) ^ crosses_right(c, a, p);
    if (!covers) return 0;
    const int turn = orient2d(flat(a), flat(b), flat(c));
    return turn != 0 && orient3d(a, b, c, p) == -turn ? turn : 0;  // the normal's z has the sign of the turn
}

bool is_on(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
    return box_around(a, b, c).contains(p) && point_on_triangle(p, a, b, c);
}

}  // namespace

bool is_closed(const TriangleMesh& mesh) { return closed_surface(mesh).closed; }

MeshInterior::MeshInterior(std::shared_ptr<const TriangleMesh> mesh)
    : MeshInterior(mesh, closed_surface(*mesh).left_out) {}

MeshInterior::MeshInterior(std::shared_ptr<const TriangleMesh> mesh, const std::vector<std::uint32_t>& left_out)
    : mesh_(std::move(mesh)), box_(bounds(*mesh_)) {
    cells_ =
        static_cast<std::size_t>(std::clamp(std::sqrt(static_cast<double>(mesh_->triangles.size())), 1.0, kMaxCells));
    const std::size_t most = kEntries + kEntriesPerTriangle * mesh_->triangles.size();
    while (cells_ > 1 && entries(left_out) > most) cells_ /= 2;
    fill_columns(left_out);
}

MeshInterior::Columns MeshInterior::columns_of(const Triangle& t) const {
    const Box3 box = box_around(mesh_->vertices[t[0]], mesh_->vertices[t[1]], mesh_->vertices[t[2]]);
    return {{cell_of(box.lower.x, 0), cell_of(box.lower.y, 1)}, {cell_of(box.upper.x, 0), cell_of(box.upper.y, 1)}};
}

/// Returns the number of entries in the lists of all columns.
std::size_t MeshInterior::entries(const std::vector<std::uint32_t>& left_out) const {
    std::size_t count = 0;
    for_each_counted(*mesh_, left_out, [&](std::uint32_t t) {
        const auto [first, last] = columns_of(mesh_->triangles[t]);
        count += (last[0] - first[0] + 1) * (last[1] - first[1] + 1);
    });
    return count;
}

// The index is monotone in the value. The column of a point is therefore among the columns of every triangle above or
// below the point.
std::size_t MeshInterior::cell_of(double value, int axis) const {
    const double width = box_.upper[axis] - box_.lower[axis];
    if (!(width > 0.0)) return 0;
    const double cell = (value - box_.lower[axis]) / width * static_cast<double>(cells_);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(cells_ - 1)));
}

void MeshInterior::fill_columns(const std::vector<std::uint32_t>& left_out) {
    column_begin_.assign(cells_ * cells_ + 1, 0);
    const auto for_each_column = [&](auto&& use) {
        for_each_counted(*mesh_, left_out, [&](std::uint32_t t) {
            const auto [first, last] = columns_of(mesh_->triangles[t]);
            for (std::size_t y = first[1]; y <= last[1]; ++y) {
                for (std::size_t x = first[0]; x <= last[0]; ++x) use(y * cells_ + x, t);
            }
        });
    };
    for_each_column([&](std::size_t k, std::uint32_t /*triangle*/) { ++column_begin_[k + 1]; });
    for (std::size_t k = 1; k < column_begin_.size(); ++k) column_begin_[k] += column_begin_[k - 1];
    column_triangles_.resize(column_begin_.back());
    std::vector<std::uint32_t> next(column_begin_.begin(), column_begin_.end() - 1);
    for_each_column([&](std::size_t k, std::uint32_t t) { column_triangles_[next[k]++] = t; });
}

bool MeshInterior::contains(const Vec3& point, InsideRule rule) const {
    if (!is_finite(point) || !box_.contains(point)) return false;
    const std::size_t column = cell_of(point.y, 1) * cells_ + cell_of(point.x, 0);
    std::int64_t crossings = 0;
    std::int64_t winding = 0;
    for (std::uint32_t k = column_begin_[column]; k < column_begin_[column + 1]; ++k) {
        const Triangle& t = mesh_->triangles[column_triangles_[k]];
        const Vec3& a = mesh_->vertices[t[0]];
        const Vec3& b = mesh_->vertices[t[1]];
        const Vec3& c = mesh_->vertices[t[2]];
        if (is_on(a, b, c, point)) return false;
        const int sign = crossing(a, b, c, point);
        crossings += sign != 0 ? 1 : 0;
        winding += sign;
    }
    return rule == InsideRule::parity ? crossings % 2 != 0 : winding != 0;
}

std::int64_t MeshInterior::winding_without(const Vec3& point, const std::vector<std::uint32_t>& shell_of,
                                           std::uint32_t shell) const {
    const std::size_t column = cell_of(point.y, 1) * cells_ + cell_of(point.x, 0);
    std::int64_t winding = 0;
    for (std::uint32_t k = column_begin_[column]; k < column_begin_[column + 1]; ++k) {
        if (shell_of[column_triangles_[k]] == shell) continue;
        const auto& [a, b, c] = mesh_->triangles[column_triangles_[k]];
        winding += crossing(mesh_->vertices[a], mesh_->vertices[b], mesh_->vertices[c], point);
    }
    return winding;
}

}  // namespace ricochet
