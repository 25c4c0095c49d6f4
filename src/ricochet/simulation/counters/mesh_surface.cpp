#include "ricochet/simulation/counters/mesh_surface.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "ricochet/core/box_tools.h"
#include "ricochet/geometry/mesh/mesh_interior.h"
#include "ricochet/geometry/predicates/exact_arithmetic.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {
namespace {

/// Rounding of a coordinate on a path, and of a height above a triangle, relative to the largest coordinate. It only
/// decides which triangles need exact tests. Local: larger than the rounding errors of this arithmetic.
constexpr double kRounding = 0x1p-46;
/// Most chords of one leg. A path that stays in the plane of a triangle reaches this number. Local: limits the time of
/// one leg; a larger number changes only where such a path leaves the triangle.
constexpr int kMostChords = 4096;

/// Returns the sign of the first component of u x v that is not 0; 0 if the vectors are parallel. Exact.
int first_sign_of_cross(const ExactDifference& u, const ExactDifference& v) {
    for (int axis = 0; axis < 3; ++axis) {
        const int sign = detail::exact_cross_component(u, v, axis).sign();
        if (sign != 0) return sign;
    }
    return 0;
}

/// Returns the side of the edge from a to b on which the moved line from p to q passes.
int moved_side_of_edge(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
    const int side = orient3d(p, q, a, b);
    return side != 0 ? side : -first_sign_of_cross(ExactDifference(b, a), ExactDifference(q, p));
}

Corners3 corners_of(const TriangleMesh& mesh, const Triangle& t) {
    return {flush_tiny(mesh.vertices[t[0]]), flush_tiny(mesh.vertices[t[1]]), flush_tiny(mesh.vertices[t[2]])};
}

}  // namespace

int moved_side_of(const Corners3& triangle, const Vec3& point) {
    const auto& [a, b, c] = triangle;
    const int side = orient3d(a, b, c, point);
    return side != 0 ? side : first_sign_of_cross(ExactDifference(b, a), ExactDifference(c, a));
}

int passage_through(const Corners3& triangle, const Vec3& p, const Vec3& q) {
    const auto& [a, b, c] = triangle;
    const int side = moved_side_of(triangle, p);
    if (side == moved_side_of(triangle, q)) return 0;
    const int first = moved_side_of_edge(p, q, a, b);
    if (moved_side_of_edge(p, q, b, c) != first || moved_side_of_edge(p, q, c, a) != first) return 0;
    return side;
}

/// Search for the passages along one leg. Its last chord ends at the stored position, because the path itself can end
/// behind the surface that the particle has hit, by rounding. The search halves the leg until each chord is certainly
/// free, or deviates from the path only by rounding.
class MeshSurface::LegSearch {
public:
    LegSearch(const MeshSurface& mesh, const PathLeg& leg, std::vector<Found>& found)
        : mesh_(mesh), leg_(leg), found_(found) {}

    void run() {
        const Path& path = leg_.path;
        const Chord whole{0.0, leg_.duration, flush_tiny(path.c[0]), flush_tiny(leg_.next)};
        const Vec3 end = path.position(leg_.duration);
        rounding_ = kRounding * std::max({max_abs(whole.from), max_abs(whole.to), max_abs(end)});
        correction_ = length(whole.to - end);
        Triangles triangles;
        mesh_.tree_.near(box_of(whole), [&](std::uint32_t k) { triangles.push_back(k); });
        search(whole, triangles);
    }

private:
    using Triangles = std::vector<std::uint32_t>;

    /// Returns the largest distance between a chord and its part of the path, with rounding, in m.
    [[nodiscard]] double reach(const Chord& chord) const {
        return leg_.path.sagitta(chord.begin, chord.end) + correction_ + rounding_;
    }

    /// Returns a box around a chord and its part of the path.
    [[nodiscard]] Box3 box_of(const Chord& chord) const {
        return grown(box_around(chord.from, chord.to), reach(chord));
    }

    /// Returns the triangles of a list that a chord and its part of the path may pass.
    [[nodiscard]] Triangles near(const Chord& chord, const Triangles& list) const {
        const double margin = reach(chord);
        const Box3 box = box_of(chord);
        Triangles triangles;
        for (const std::uint32_t k : list) {
            const auto& [a, b, c] = mesh_.triangles_[k];
            const double from = dot(mesh_.normals_[k], chord.from - a);
            const double to = dot(mesh_.normals_[k], chord.to - a);
            const double error = margin + kRounding * (max_abs(a) + max_abs(chord.from));
            const bool is_apart = std::min(from, to) > error || std::max(from, to) < -error;
            if (!is_apart && overlap(box_around(a, b, c), box)) triangles.push_back(k);
        }
        return triangles;
    }

    void search(const Chord& chord, const Triangles& list) {
        const Triangles triangles = near(chord, list);
        if (triangles.empty()) return;
        const double middle = 0.5 * (chord.begin + chord.end);
        const bool is_short = middle <= chord.begin || middle >= chord.end || chords_ >= kMostChords;
        if (is_short || leg_.path.sagitta(chord.begin, chord.end) <= rounding_) {
            pass(chord, triangles);
            return;
        }
        const Vec3 point = leg_.path.position(middle);
        search({chord.begin, middle, chord.from, point}, triangles);
        search({middle, chord.end, point, chord.to}, triangles);
    }

    /// Finds the passages of a chord. Passages at the same time that cancel each other are left out: the path touches
    /// an edge there.
    void pass(const Chord& chord, const Triangles& triangles) {
        ++chords_;
        const std::size_t first = found_.size();
        for (const std::uint32_t k : triangles) {
            const auto& [a, b, c] = mesh_.triangles_[k];
            const int side = passage_through(mesh_.triangles_[k], chord.from, chord.to);
            if (side == 0) continue;
            const double fraction = crossing_fraction(chord.from, chord.to, a, b, c);
            found_.push_back({chord.begin + fraction * (chord.end - chord.begin), k, side > 0});
        }
        std::sort(found_.begin() + static_cast<std::ptrdiff_t>(first), found_.end(),
                  [](const Found& one, const Found& other) {
                      return std::tie(one.time, one.triangle) < std::tie(other.time, other.triangle);
                  });
        cancel(first);
    }

    /// Removes neighbours at the same time with opposite directions, from an index on.
    void cancel(std::size_t first) {
        std::size_t kept = first;
        for (std::size_t k = first; k < found_.size(); ++k) {
            const bool cancels = kept > first && found_[kept - 1].time == found_[k].time &&
                                 found_[kept - 1].is_forward != found_[k].is_forward;
            if (cancels) {
                --kept;
            } else {
                found_[kept++] = found_[k];
            }
        }
        found_.resize(kept);
    }

    const MeshSurface& mesh_;
    const PathLeg& leg_;
    std::vector<Found>& found_;
    double rounding_ = 0.0;    // of the path's points, m
    double correction_ = 0.0;  // distance from the end of the path to the stored position, m
    int chords_ = 0;
};

MeshSurface::MeshSurface(const MeshCounter& mesh) : is_closed_(ricochet::is_closed(*mesh.mesh)) {
    for (const Triangle& triangle : mesh.mesh->triangles) {
        const Corners3 corners = corners_of(*mesh.mesh, triangle);
        const auto& [a, b, c] = corners;
        if (are_collinear(a, b, c)) continue;
        triangles_.push_back(corners);
        normals_.push_back(unit_normal(a, b, c));
    }
    tree_.fit(triangles_.size(), [&](std::uint32_t k) {
        const auto& [a, b, c] = triangles_[k];
        return box_around(a, b, c);
    });
}

bool MeshSurface::is_missed(const Vec3& from, const Vec3& to, std::span<const FlownPiece> pieces) const {
    if (triangles_.empty()) return true;
    Box3 swept = box_around(from, to);
    for (const FlownPiece& piece : pieces) {
        for (const Vec3& point : piece.path.control_points()) swept.include(point);
    }
    const double largest = std::max(max_abs(swept.lower), max_abs(swept.upper));
    return !overlap(grown(swept, kRounding * largest), tree_.bounds());
}

void MeshSurface::find(const PathLeg& leg, std::vector<Found>& found) const { LegSearch(*this, leg, found).run(); }

}  // namespace ricochet
