#include "ricochet/geometry/mesh/ear_clipper.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace ricochet {
namespace {

constexpr std::uint32_t kLeafSize = 8;
constexpr std::uint32_t kNoCorner = std::numeric_limits<std::uint32_t>::max();

// Returns true if the whole box is strictly right of the line from a to b. The exact test of the box's leftmost corner,
// seen along the line, decides.
bool is_right_of(const Point2& lower, const Point2& upper, const Point2& a, const Point2& b) {
    const Point2 leftmost{b.v < a.v ? upper.u : lower.u, b.u > a.u ? upper.v : lower.v};
    return orient2d(a, b, leftmost) < 0;
}

// Returns the exact orientation of the outline. It is the turn at the leftmost (then lowest) corner, which is convex in
// every simple polygon. If the outline reverses its direction at this corner, the sum of areas decides.
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

}  // namespace

void PointTree::build(const std::vector<Point2>& points, std::vector<std::uint32_t> members) {
    points_ = &points;
    members_ = std::move(members);
    leaf_of_.assign(points.size(), kNoCorner);
    nodes_.clear();
    if (members_.empty()) return;
    nodes_.emplace_back();
    split(0, 0, static_cast<std::uint32_t>(members_.size()));
}

// The depth is logarithmic, because both halves have equal size.
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
    if (nodes_.empty() || leaf_of_[member] == kNoCorner) return;
    std::uint32_t node = std::exchange(leaf_of_[member], kNoCorner);
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

// Ears are clipped in queue order. The neighbours of a clipped corner are appended to the queue, and so wait for a
// whole round. This avoids thin triangles. Clipping an ear can change only whether its two neighbours are ears
// (Meisters).
void EarClipper::clip_all(Strictness strictness, std::vector<Triangle>& triangles) {
    queue_.clear();
    is_queued_.assign(points_.size(), 0);
    std::uint32_t corner = any_corner_;
    for (std::uint32_t i = 0; i < remaining_; ++i, corner = next_[corner]) update(corner, strictness);
    for (std::size_t head = 0; head < queue_.size() && remaining_ > 3; ++head) {
        const std::uint32_t ear = queue_[head];
        if (is_queued_[ear] == 0) continue;
        is_queued_[ear] = 0;
        // A neighbour may have been clipped since this corner was queued.
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

// The diagonal must be inside the outline at both of its ends. A convex end must stay convex after the ear is removed.
bool EarClipper::fits_between_neighbours(std::uint32_t corner, Strictness strictness) const {
    const std::uint32_t before = previous_[corner];
    const std::uint32_t after = next_[corner];
    const int least = strictness == Strictness::kSimple ? 1 : 0;
    if (turn_at(before) > 0 && turn(previous_[before], before, after) < least) return false;
    return turn_at(after) <= 0 || turn(before, after, next_[after]) >= least;
}

// Corners that coincide with a corner of the ear are ignored. They occur if the outline visits a position several times
// (the ends of a bridge).
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

// Any triangulation of an outline covers the area that the outline winds around, so a fan suffices.
void EarClipper::fan_the_rest(std::vector<Triangle>& triangles) {
    const std::uint32_t hub = any_corner_;
    std::uint32_t corner = next_[hub];
    for (; next_[corner] != hub; corner = next_[corner]) triangles.push_back({hub, corner, next_[corner]});
}

}  // namespace ricochet
