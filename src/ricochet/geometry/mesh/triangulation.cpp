#include "ricochet/geometry/mesh/triangulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/ear_clipper.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

using Corners = std::span<const std::uint32_t>;

bool has_repeats(Corners corners, std::vector<std::uint32_t>& scratch) {
    if (corners.size() == 3) {
        return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
    }
    scratch.assign(corners.begin(), corners.end());
    std::sort(scratch.begin(), scratch.end());
    return std::adjacent_find(scratch.begin(), scratch.end()) != scratch.end();
}

// Removes equal neighbours around the whole outline, so that a vertex repeated in a row counts once.
void remove_equal_neighbours(std::vector<std::uint32_t>& corners) {
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
}

// Returns twice the polygon's area vector (Newell's method). It is computed relative to a corner, so that a distant
// face does not cause cancellation.
Vec3 newell_normal(const std::vector<Vec3>& vertices, Corners corners) {
    const Vec3 origin = vertices[corners[0]];
    Vec3 normal;
    for (std::size_t i = 2; i < corners.size(); ++i) {
        normal += cross(vertices[corners[i - 1]] - origin, vertices[corners[i]] - origin);
    }
    return normal;
}

// Returns the axis along which the normal is longest. The projection drops this coordinate, and the other coordinates
// stay exact.
int dropped_axis(const Vec3& normal) {
    const Vec3 size = abs(normal);
    if (size.z >= size.x && size.z >= size.y) return 2;
    return size.y >= size.x ? 1 : 0;
}

Point2 project(const Vec3& p, int dropped) {
    return {p[dropped == 0 ? 1 : (dropped == 1 ? 2 : 0)], p[dropped == 0 ? 2 : (dropped == 1 ? 0 : 1)]};
}

class Triangulator {
public:
    explicit Triangulator(const PolygonMesh& mesh) : mesh_(mesh) {}

    Triangulation run() {
        const std::size_t faces = mesh_.face_count();
        result_.triangles.reserve(mesh_.corners.size() - std::min(mesh_.corners.size(), 2 * faces));
        result_.triangle_face.reserve(result_.triangles.capacity());
        for (std::size_t face = 0; face < faces; ++face) {
            cut_face(face);
            result_.triangle_face.resize(result_.triangles.size(), static_cast<std::uint32_t>(face));
        }
        return std::move(result_);
    }

private:
    void cut_face(std::size_t face) {
        const std::uint32_t first = mesh_.face_offsets[face];
        const Corners corners(mesh_.corners.data() + first, mesh_.face_offsets[face + 1] - first);
        if (corners.size() < 3 || corners.size() > kLargestPolygon) {
            throw InputError(
                fmt::format("face {} has {} corners, expected 3 to {}", face, corners.size(), kLargestPolygon));
        }
        const bool repeats = has_repeats(corners, distinct_);
        if (repeats) ++result_.faces_with_repeated_corners;
        if (corners.size() == 3) {
            result_.triangles.push_back({corners[0], corners[1], corners[2]});
            return;
        }
        distinct_.assign(corners.begin(), corners.end());
        if (repeats) remove_equal_neighbours(distinct_);
        cut_distinct();
    }

    void cut_distinct() {
        if (distinct_.size() <= 3) {
            result_.triangles.push_back({distinct_.front(), distinct_[distinct_.size() / 2], distinct_.back()});
            return;
        }
        const int dropped = dropped_axis(newell_normal(mesh_.vertices, distinct_));
        points_.clear();
        for (const std::uint32_t corner : distinct_) points_.push_back(project(mesh_.vertices[corner], dropped));
        const bool clean = distinct_.size() == 4 ? cut_quad() : cut_polygon();
        if (!clean) ++result_.crossing_faces;
    }

    // Cuts a quadrilateral along the diagonal whose two triangles have the same orientation. If this is true of both
    // diagonals, uses the one at corner 0. Returns false for an outline that crosses itself.
    bool cut_quad() {
        const std::vector<Point2>& p = points_;
        const int along_02 = orient2d(p[0], p[1], p[2]) * orient2d(p[0], p[2], p[3]);
        const int along_13 = orient2d(p[0], p[1], p[3]) * orient2d(p[1], p[2], p[3]);
        const std::vector<std::uint32_t>& c = distinct_;
        if (along_13 > along_02) {
            result_.triangles.push_back({c[0], c[1], c[3]});
            result_.triangles.push_back({c[1], c[2], c[3]});
        } else {
            result_.triangles.push_back({c[0], c[1], c[2]});
            result_.triangles.push_back({c[0], c[2], c[3]});
        }
        return std::max(along_02, along_13) >= 0;
    }

    bool cut_polygon() {
        ears_.clear();
        const bool clean = clipper_.clip(points_, ears_);
        for (const Triangle& ear : ears_) {
            result_.triangles.push_back({distinct_[ear[0]], distinct_[ear[1]], distinct_[ear[2]]});
        }
        return clean;
    }

    const PolygonMesh& mesh_;
    Triangulation result_;
    EarClipper clipper_;
    std::vector<std::uint32_t> distinct_;  // corners of the face; also scratch memory for finding repeated ones
    std::vector<Point2> points_;           // projections of distinct_
    std::vector<Triangle> ears_;           // triangles as indices into distinct_
};

}  // namespace

Triangulation triangulate(const PolygonMesh& mesh) { return Triangulator(mesh).run(); }

}  // namespace ricochet
