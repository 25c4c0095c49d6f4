#include "ricochet/geometry/mesh/triangulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// A balanced k-d tree over points; finds those near a triangle.
/// Method: J. L. Bentley, "Multidimensional binary search trees used for associative searching", CACM 18(9), 1975.
class PointTree {
public:
    /// Rebuilds with the given members, indices into `points` (which must stay alive and unchanged).
    void build(const std::vector<Point2>& points, std::vector<std::uint32_t> members);
    /// Removes a member; others are ignored.
    void remove(std::uint32_t member);

    /// Calls visit(member) for the members in boxes that the closed counter-clockwise triangle (a, b, c) touches, and
    /// maybe some others, until it returns true. Returns whether it did.
    template <typename Visit>
    bool any_near_triangle(const Point2& a, const Point2& b, const Point2& c, Visit&& visit) const {
        if (nodes_.empty()) return false;
        std::vector<std::uint32_t>& stack = stack_;
        stack.assign(1, 0);
        while (!stack.empty()) {
            const Node& node = nodes_[stack.back()];
            stack.pop_back();
            if (node.members == 0 || is_apart(node, a, b, c)) continue;
            if (node.first_child != 0) {
                stack.push_back(node.first_child + 1);
                stack.push_back(node.first_child);
                continue;
            }
            for (std::uint32_t i = node.begin; i < node.begin + node.members; ++i) {
                if (visit(members_[i])) return true;
            }
        }
        return false;
    }

private:
    struct Node {
        Point2 lower;
        Point2 upper;
        std::uint32_t begin = 0;        // leaf: members_[begin, begin + members)
        std::uint32_t members = 0;      // that are left below this node
        std::uint32_t first_child = 0;  // the other one follows; 0 for a leaf
        std::uint32_t parent = 0;
    };

    void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);
    void fit_box(Node& node) const;
    [[nodiscard]] static bool is_apart(const Node& node, const Point2& a, const Point2& b, const Point2& c);

    const std::vector<Point2>* points_ = nullptr;
    std::vector<std::uint32_t> members_;  // in the order of the leaves
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaf_of_;        // per point; kNone for points that are not members
    mutable std::vector<std::uint32_t> stack_;  // scratch of a search
};

/// Cuts polygons by clipping ears, with exact signs. Every corner is tested once at the start and when a neighbour of
/// it was clipped, against the reflex corners near its triangle, which a tree finds: close to linear time.
/// Keeps its memory from one polygon to the next.
class EarClipper {
public:
    /// Appends n - 2 triangles of indices into `points` (n >= 3 corners in either orientation; neighbours may not be
    /// the same corner, but may coincide). The triangles have the outline's winding. Returns false when the outline
    /// crosses itself: the triangles then cover it, but overlap.
    [[nodiscard]] bool clip(const std::vector<Point2>& points, std::vector<Triangle>& triangles);

private:
    // kTouching also accepts flat ears and ears with corners on their boundary, for outlines that touch themselves.
    enum class Strictness { kSimple, kTouching };

    void start(const std::vector<Point2>& points);
    [[nodiscard]] int turn_at(std::uint32_t corner) const;
    [[nodiscard]] int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    [[nodiscard]] bool is_ear(std::uint32_t corner, Strictness strictness) const;
    [[nodiscard]] bool fits_between_neighbours(std::uint32_t corner, Strictness strictness) const;
    [[nodiscard]] bool is_free_of_corners(std::uint32_t corner, Strictness strictness) const;
    void clip_all(Strictness strictness, std::vector<Triangle>& triangles);
    void clip_ear(std::uint32_t corner, std::vector<Triangle>& triangles);
    void update(std::uint32_t corner, Strictness strictness);
    void fan_the_rest(std::vector<Triangle>& triangles);

    std::vector<Point2> points_;  // mirrored if need be: the outline runs counter-clockwise
    std::vector<std::uint32_t> next_;
    std::vector<std::uint32_t> previous_;
    std::vector<char> is_reflex_;  // corners that an ear must not contain
    std::vector<char> is_queued_;  // corners that were an ear when last tested
    std::vector<std::uint32_t> queue_;
    std::uint32_t remaining_ = 0;
    std::uint32_t any_corner_ = 0;  // one that is still there
    PointTree reflex_tree_;
};

constexpr std::uint32_t kLeafSize = 8;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Exact: every point of the box is strictly right of the line from a to b when its leftmost corner is.
bool is_right_of(const Point2& lower, const Point2& upper, const Point2& a, const Point2& b) {
    const Point2 leftmost{b.v < a.v ? upper.u : lower.u, b.u > a.u ? upper.v : lower.v};
    return orient2d(a, b, leftmost) < 0;
}

// Exact orientation of the outline: the turn at its lowest-left corner, which is convex in every simple polygon. Where
// the outline runs back on itself there, the sum of areas decides.
int orientation(const std::vector<Point2>& p) {
    const auto lowest = std::min_element(
        p.begin(), p.end(), [](const Point2& a, const Point2& b) { return std::tie(a.u, a.v) < std::tie(b.u, b.v); });
    const auto i = static_cast<std::size_t>(lowest - p.begin());
    const int turn = orient2d(p[(i + p.size() - 1) % p.size()], p[i], p[(i + 1) % p.size()]);
    if (turn != 0) return turn;
    double area = 0.0;
    for (std::size_t k = 2; k < p.size(); ++k) {
        area += (p[k - 1].u - p[0].u) * (p[k].v - p[0].v) - (p[k - 1].v - p[0].v) * (p[k].u - p[0].u);
    }
    return area < 0.0 ? -1 : 1;
}

void PointTree::build(const std::vector<Point2>& points, std::vector<std::uint32_t> members) {
    points_ = &points;
    members_ = std::move(members);
    leaf_of_.assign(points.size(), kNone);
    nodes_.clear();
    if (members_.empty()) return;
    nodes_.emplace_back();
    split(0, 0, static_cast<std::uint32_t>(members_.size()));
}

// Depth is logarithmic, since halves are equal.
void PointTree::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
    nodes_[node].begin = begin;
    nodes_[node].members = end - begin;
    fit_box(nodes_[node]);
    if (end - begin <= kLeafSize) {
        for (std::uint32_t i = begin; i < end; ++i) leaf_of_[members_[i]] = node;
        return;
    }
    const Node& box = nodes_[node];
    const bool along_u = box.upper.u - box.lower.u > box.upper.v - box.lower.v;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(members_.begin() + begin, members_.begin() + middle, members_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const Point2& p = (*points_)[a];
                         const Point2& q = (*points_)[b];
                         return along_u ? p.u < q.u : p.v < q.v;
                     });
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[node].first_child = child;
    nodes_[child].parent = node;
    nodes_[child + 1].parent = node;
    split(child, begin, middle);
    split(child + 1, middle, end);
}

void PointTree::fit_box(Node& node) const {
    node.lower = node.upper = (*points_)[members_[node.begin]];
    for (std::uint32_t i = node.begin; i < node.begin + node.members; ++i) {
        const Point2& p = (*points_)[members_[i]];
        node.lower = {std::min(node.lower.u, p.u), std::min(node.lower.v, p.v)};
        node.upper = {std::max(node.upper.u, p.u), std::max(node.upper.v, p.v)};
    }
}

void PointTree::remove(std::uint32_t member) {
    if (nodes_.empty() || leaf_of_[member] == kNone) return;
    std::uint32_t node = std::exchange(leaf_of_[member], kNone);
    const auto first = members_.begin() + nodes_[node].begin;
    std::iter_swap(std::find(first, first + nodes_[node].members, member), first + nodes_[node].members - 1);
    for (; node != 0; node = nodes_[node].parent) --nodes_[node].members;
    --nodes_[0].members;
}

bool PointTree::is_apart(const Node& node, const Point2& a, const Point2& b, const Point2& c) {
    if (std::max({a.u, b.u, c.u}) < node.lower.u || std::min({a.u, b.u, c.u}) > node.upper.u ||
        std::max({a.v, b.v, c.v}) < node.lower.v || std::min({a.v, b.v, c.v}) > node.upper.v) {
        return true;
    }
    return is_right_of(node.lower, node.upper, a, b) || is_right_of(node.lower, node.upper, b, c) ||
           is_right_of(node.lower, node.upper, c, a);
}

bool EarClipper::clip(const std::vector<Point2>& points, std::vector<Triangle>& triangles) {
    start(points);
    clip_all(Strictness::kSimple, triangles);
    if (remaining_ > 3) clip_all(Strictness::kTouching, triangles);
    const bool is_clean = remaining_ == 3 && turn_at(any_corner_) >= 0;
    fan_the_rest(triangles);
    return is_clean;
}

void EarClipper::start(const std::vector<Point2>& points) {
    const auto count = static_cast<std::uint32_t>(points.size());
    points_ = points;
    if (orientation(points) < 0) {
        for (Point2& p : points_) std::swap(p.u, p.v);
    }
    next_.resize(count);
    previous_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        next_[i] = i + 1 < count ? i + 1 : 0;
        previous_[i] = i > 0 ? i - 1 : count - 1;
    }
    remaining_ = count;
    any_corner_ = 0;
    is_reflex_.assign(count, 0);
    std::vector<std::uint32_t> reflex;
    for (std::uint32_t i = 0; i < count; ++i) {
        is_reflex_[i] = turn_at(i) <= 0 ? 1 : 0;
        if (is_reflex_[i] != 0) reflex.push_back(i);
    }
    reflex_tree_.build(points_, std::move(reflex));
}

int EarClipper::turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return orient2d(points_[a], points_[b], points_[c]);
}

int EarClipper::turn_at(std::uint32_t corner) const { return turn(previous_[corner], corner, next_[corner]); }

// Ears are clipped in queue order: neighbours of a clipped corner wait for a whole round, which keeps triangles from
// becoming thin. Only neighbours of a clipped ear can become ears or cease to be ones (Meisters).
void EarClipper::clip_all(Strictness strictness, std::vector<Triangle>& triangles) {
    queue_.clear();
    is_queued_.assign(points_.size(), 0);
    std::uint32_t corner = any_corner_;
    for (std::uint32_t i = 0; i < remaining_; ++i, corner = next_[corner]) update(corner, strictness);
    for (std::size_t head = 0; head < queue_.size() && remaining_ > 3; ++head) {
        const std::uint32_t ear = queue_[head];
        if (is_queued_[ear] == 0) continue;
        is_queued_[ear] = 0;
        // A neighbour may have been clipped while this corner waited.
        if (!is_ear(ear, strictness)) continue;
        clip_ear(ear, triangles);
        update(previous_[ear], strictness);
        update(next_[ear], strictness);
    }
}

void EarClipper::update(std::uint32_t corner, Strictness strictness) {
    if (is_reflex_[corner] != 0 && turn_at(corner) > 0) {
        is_reflex_[corner] = 0;
        reflex_tree_.remove(corner);
    }
    if (is_queued_[corner] == 0 && is_ear(corner, strictness)) {
        is_queued_[corner] = 1;
        queue_.push_back(corner);
    }
}

void EarClipper::clip_ear(std::uint32_t corner, std::vector<Triangle>& triangles) {
    const std::uint32_t before = previous_[corner];
    const std::uint32_t after = next_[corner];
    triangles.push_back({before, corner, after});
    next_[before] = after;
    previous_[after] = before;
    reflex_tree_.remove(corner);
    any_corner_ = after;
    --remaining_;
}

bool EarClipper::is_ear(std::uint32_t corner, Strictness strictness) const {
    return turn_at(corner) >= (strictness == Strictness::kSimple ? 1 : 0) &&
           fits_between_neighbours(corner, strictness) && is_free_of_corners(corner, strictness);
}

// The diagonal must leave both of its ends inside the outline: a convex end stays convex when the ear is gone.
bool EarClipper::fits_between_neighbours(std::uint32_t corner, Strictness strictness) const {
    const std::uint32_t before = previous_[corner];
    const std::uint32_t after = next_[corner];
    const int least = strictness == Strictness::kSimple ? 1 : 0;
    if (turn_at(before) > 0 && turn(previous_[before], before, after) < least) return false;
    return turn_at(after) <= 0 || turn(before, after, next_[after]) >= least;
}

// Corners that coincide with one of the ear's are other visits of the outline to it (the ends of a bridge).
bool EarClipper::is_free_of_corners(std::uint32_t corner, Strictness strictness) const {
    const Point2& a = points_[previous_[corner]];
    const Point2& b = points_[corner];
    const Point2& c = points_[next_[corner]];
    const int outside = strictness == Strictness::kSimple ? -1 : 0;
    return !reflex_tree_.any_near_triangle(a, b, c, [&](std::uint32_t other) {
        const Point2& p = points_[other];
        if (p == a || p == b || p == c) return false;
        return orient2d(a, b, p) > outside && orient2d(b, c, p) > outside && orient2d(c, a, p) > outside;
    });
}

// Any triangulation of an outline covers what it winds around, so the simplest suffices.
void EarClipper::fan_the_rest(std::vector<Triangle>& triangles) {
    const std::uint32_t hub = any_corner_;
    std::uint32_t corner = next_[hub];
    for (; next_[corner] != hub; corner = next_[corner]) triangles.push_back({hub, corner, next_[corner]});
}

using Corners = std::span<const std::uint32_t>;

bool has_repeats(Corners corners, std::vector<std::uint32_t>& scratch) {
    if (corners.size() == 3) {
        return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
    }
    scratch.assign(corners.begin(), corners.end());
    std::sort(scratch.begin(), scratch.end());
    return std::adjacent_find(scratch.begin(), scratch.end()) != scratch.end();
}

// Neighbours that are the same vertex count once, around the whole outline.
void remove_equal_neighbours(std::vector<std::uint32_t>& corners) {
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
}

// Twice the polygon's area vector (Newell's method), relative to a corner so that a far-away face does not cancel.
Vec3 newell_normal(const std::vector<Vec3>& vertices, Corners corners) {
    const Vec3 origin = vertices[corners[0]];
    Vec3 normal;
    for (std::size_t i = 2; i < corners.size(); ++i) {
        normal += cross(vertices[corners[i - 1]] - origin, vertices[corners[i]] - origin);
    }
    return normal;
}

// The projection drops the coordinate along which the normal is longest; what is left keeps its exact coordinates.
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
        if (holds_triangles_only()) {
            copy_triangles();
            return std::move(result_);
        }
        result_.triangles.reserve(mesh_.corners.size() - std::min(mesh_.corners.size(), 2 * faces));
        result_.triangle_face.reserve(result_.triangles.capacity());
        for (std::size_t face = 0; face < faces; ++face) {
            cut_face(face);
            result_.triangle_face.resize(result_.triangles.size(), static_cast<std::uint32_t>(face));
        }
        return std::move(result_);
    }

private:
    [[nodiscard]] bool holds_triangles_only() const {
        const std::vector<std::uint32_t>& offsets = mesh_.face_offsets;
        for (std::size_t i = 0; i < offsets.size(); ++i) {
            if (offsets[i] != 3 * i) return false;
        }
        return mesh_.corners.size() == 3 * mesh_.face_count();
    }

    void copy_triangles() {
        const std::vector<std::uint32_t>& corners = mesh_.corners;
        result_.triangles.reserve(corners.size() / 3);
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            const Triangle triangle{corners[i], corners[i + 1], corners[i + 2]};
            if (has_repeats(triangle, distinct_)) ++result_.faces_with_repeated_corners;
            result_.triangles.push_back(triangle);
        }
        result_.triangle_face.resize(result_.triangles.size());
        std::iota(result_.triangle_face.begin(), result_.triangle_face.end(), std::uint32_t{0});
    }

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

    // Along the diagonal whose two triangles turn the same way, corner 0's if both do. False for a bow-tie.
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
    std::vector<std::uint32_t> distinct_;  // corners of the face, and scratch for finding repeats
    std::vector<Point2> points_;           // their projections
    std::vector<Triangle> ears_;           // triangles as indices into distinct_
};

}  // namespace

Triangulation triangulate(const PolygonMesh& mesh) { return Triangulator(mesh).run(); }

}  // namespace ricochet
