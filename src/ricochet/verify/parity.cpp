#include "ricochet/verify/parity.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "ricochet/verify/triangle_tests.h"

namespace ricochet {
namespace {

using verify::planar_sign;
using verify::spatial_sign;

/// Returns planar_sign of a, b and a point on the line through a and b that is moved by (e, e^2). e is positive and
/// infinitesimal.
int perturbed_sign(const Vec3& a, const Vec3& b) {
    if (b.y != a.y) return b.y > a.y ? -1 : 1;
    return b.x > a.x ? 1 : -1;
}

using Position = std::array<double, 3>;

// Adding 0.0 turns -0.0 into 0.0, so both are the same position.
Position position(const Vec3& p) { return {p.x + 0.0, p.y + 0.0, p.z + 0.0}; }

}  // namespace

std::size_t count_open_edges(const TriangleMesh& mesh) {
    std::vector<std::pair<Position, Position>> sides;
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Position from = position(mesh.vertices[t[i]]);
            const Position to = position(mesh.vertices[t[(i + 1) % 3]]);
            if (from != to) sides.emplace_back(std::min(from, to), std::max(from, to));
        }
    }
    std::ranges::sort(sides);
    std::size_t open = 0;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i;
        while (end < sides.size() && sides[end] == sides[i]) ++end;
        open += (end - i) % 2;
        i = end;
    }
    return open;
}

ParityOracle::ParityOracle(const TriangleMesh& mesh) {
    const std::size_t open = count_open_edges(mesh);
    if (open != 0) throw std::invalid_argument("parity needs a closed mesh; open edges: " + std::to_string(open));
    const Vec3 size = mesh.triangles.empty() ? Vec3{} : bounds(mesh).size();
    if (size.x < size.y && size.x < size.z) ray_axis_ = 0;
    if (size.y <= size.x && size.y < size.z) ray_axis_ = 1;
    add_faces(mesh);
    choose_resolution();
    fill_columns();
}

Vec3 ParityOracle::permuted(const Vec3& point) const {
    return {point[(ray_axis_ + 1) % 3], point[(ray_axis_ + 2) % 3], point[ray_axis_]};
}

void ParityOracle::add_faces(const TriangleMesh& mesh) {
    faces_.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        Face face;
        for (std::size_t i = 0; i < 3; ++i) {
            face.corners[i] = permuted(mesh.vertices[t[i]]);
            face.box.include(face.corners[i]);
        }
        face.area_sign = planar_sign(0, 1, face.corners[0], face.corners[1], face.corners[2]);
        if (verify::on_one_line(face.corners[0], face.corners[1], face.corners[2])) continue;
        box_.include(face.box);
        faces_.push_back(face);
    }
}

/// Returns the columns that cover a range of coordinates. Every operation is monotone, even with rounding. A point
/// within the range therefore lies in one of these columns.
ParityOracle::CellRange ParityOracle::cells(double lower, double upper, double origin, double per_length) const {
    const auto cell = [&](double x) {
        const double scaled = std::floor((x - origin) * per_length);
        return static_cast<std::size_t>(std::clamp(scaled, 0.0, static_cast<double>(resolution_ - 1)));
    };
    return {cell(lower), cell(upper)};
}

std::size_t ParityOracle::count_entries() const {
    std::size_t entries = 0;
    for (const Face& face : faces_) {
        const CellRange x = cells(face.box.lower.x, face.box.upper.x, box_.lower.x, per_x_);
        const CellRange y = cells(face.box.lower.y, face.box.upper.y, box_.lower.y, per_y_);
        entries += (x.last - x.first + 1) * (y.last - y.first + 1);
    }
    return entries;
}

/// Chooses the number of columns: about one column per triangle, or fewer if long triangles would cover too many
/// columns.
void ParityOracle::choose_resolution() {
    if (faces_.empty()) return;
    resolution_ = 1 + static_cast<std::size_t>(std::sqrt(static_cast<double>(faces_.size())));
    for (;; resolution_ = (resolution_ + 1) / 2) {
        const Vec3 size = box_.size();
        per_x_ = size.x > 0.0 ? static_cast<double>(resolution_) / size.x : 0.0;
        per_y_ = size.y > 0.0 ? static_cast<double>(resolution_) / size.y : 0.0;
        if (resolution_ == 1 || count_entries() <= 32 * faces_.size()) return;
    }
}

void ParityOracle::fill_columns() {
    std::vector<std::uint32_t> order(faces_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
    std::ranges::stable_sort(
        order, [this](std::uint32_t a, std::uint32_t b) { return faces_[a].box.upper.z > faces_[b].box.upper.z; });
    const auto for_columns_of = [this](const Face& face, const auto& body) {
        const CellRange x = cells(face.box.lower.x, face.box.upper.x, box_.lower.x, per_x_);
        const CellRange y = cells(face.box.lower.y, face.box.upper.y, box_.lower.y, per_y_);
        for (std::size_t row = y.first; row <= y.last; ++row) {
            for (std::size_t column = x.first; column <= x.last; ++column) body(row * resolution_ + column);
        }
    };
    column_begin_.assign(resolution_ * resolution_ + 1, 0);
    for (const Face& face : faces_) {
        for_columns_of(face, [this](std::size_t column) { ++column_begin_[column + 1]; });
    }
    for (std::size_t i = 1; i < column_begin_.size(); ++i) column_begin_[i] += column_begin_[i - 1];
    column_faces_.resize(column_begin_.back());
    std::vector<std::uint32_t> next(column_begin_.begin(), column_begin_.end() - 1);
    for (const std::uint32_t index : order) {
        for_columns_of(faces_[index], [&](std::size_t column) { column_faces_[next[column]++] = index; });
    }
}

ParityOracle::Crossing ParityOracle::crossing(const Face& face, const Vec3& point) {
    const auto& [a, b, c] = face.corners;
    const std::array<int, 3> sides{planar_sign(0, 1, a, b, point), planar_sign(0, 1, b, c, point),
                                   planar_sign(0, 1, c, a, point)};
    if (face.area_sign == 0) {
        // The triangle is parallel to the ray. The perturbed ray misses the triangle, but the point may lie on it.
        if (sides != std::array<int, 3>{0, 0, 0}) return Crossing::none;
        return verify::intersects(point, point, {a, b, c}) ? Crossing::touches : Crossing::none;
    }
    for (const int side : sides) {
        if (side * face.area_sign < 0) return Crossing::none;
    }
    const int height = spatial_sign(a, b, c, point) * face.area_sign;  // sign of the point's height above the triangle
    if (height == 0) return Crossing::touches;
    if (height > 0) return Crossing::none;
    for (std::size_t i = 0; i < 3; ++i) {
        if (sides[i] == 0 && perturbed_sign(face.corners[i], face.corners[(i + 1) % 3]) != face.area_sign) {
            return Crossing::none;
        }
    }
    return Crossing::above;
}

Side ParityOracle::side(const Vec3& point) const {
    const Vec3 p = permuted(point);
    if (!box_.contains(p)) return Side::outside;
    const std::size_t column =
        cells(p.y, p.y, box_.lower.y, per_y_).first * resolution_ + cells(p.x, p.x, box_.lower.x, per_x_).first;
    bool is_inside = false;
    for (std::uint32_t i = column_begin_[column]; i < column_begin_[column + 1]; ++i) {
        const Face& face = faces_[column_faces_[i]];
        if (face.box.upper.z < p.z) break;  // all following faces are also below the point
        if (p.x < face.box.lower.x || p.x > face.box.upper.x || p.y < face.box.lower.y || p.y > face.box.upper.y)
            continue;
        switch (crossing(face, p)) {
            case Crossing::touches:
                return Side::on_surface;
            case Crossing::above:
                is_inside = !is_inside;
                break;
            case Crossing::none:
                break;
        }
    }
    return is_inside ? Side::inside : Side::outside;
}

}  // namespace ricochet
