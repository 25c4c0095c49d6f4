#include "ricochet/verify/sphere_overlaps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace ricochet {
namespace {

/// Largest number of spheres in a leaf.
constexpr std::uint32_t kLeaf = 8;

Box3 box_of(const StandingSphere& sphere) {
    const Vec3 by{sphere.radius, sphere.radius, sphere.radius};
    return {sphere.position - by, sphere.position + by};
}

bool meet(const Box3& a, const Box3& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
           a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

auto ids(const SphereOverlaps::Found& found) { return std::pair(found.first, found.second); }

/// Returns the error of a distance, in m, that rounding of the coordinates can cause.
double rounding(const Vec3& a, const Vec3& b) {
    return 16.0 * std::numeric_limits<double>::epsilon() * std::max(max_abs(a), max_abs(b));
}

}  // namespace

void SphereOverlaps::build(std::span<const StandingSphere> spheres) {
    nodes_.clear();
    order_.resize(spheres.size());
    std::iota(order_.begin(), order_.end(), 0U);
    if (spheres.empty()) return;
    nodes_.push_back({{}, 0, static_cast<std::uint32_t>(spheres.size()), 0});
    for (std::uint32_t node = 0; node < nodes_.size(); ++node) split(node, spheres);
}

void SphereOverlaps::split(std::uint32_t node, std::span<const StandingSphere> spheres) {
    const std::uint32_t begin = nodes_[node].begin;
    const std::uint32_t end = nodes_[node].end;
    Box3 box;
    Box3 centers;
    for (std::uint32_t k = begin; k < end; ++k) {
        const Box3 ball = box_of(spheres[order_[k]]);
        box.include(ball.lower);
        box.include(ball.upper);
        centers.include(spheres[order_[k]].position);
    }
    nodes_[node].box = box;
    if (end - begin <= kLeaf) return;
    const Vec3 size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         return std::pair(spheres[a].position[axis], a) < std::pair(spheres[b].position[axis], b);
                     });
    nodes_[node].children = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, begin, middle, 0});
    nodes_.push_back({{}, middle, end, 0});
}

void SphereOverlaps::find(std::span<const StandingSphere> spheres, std::uint32_t i, double most,
                          std::vector<Found>& deep, std::vector<std::array<std::uint64_t, 2>>& born) {
    const StandingSphere& a = spheres[i];
    const Box3 box = box_of(a);
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
        const Node node = nodes_[open.back()];
        open.pop_back();
        if (!meet(node.box, box)) continue;
        if (node.children != 0) {
            open.push_back(node.children);
            open.push_back(node.children + 1);
            continue;
        }
        for (std::uint32_t k = node.begin; k < node.end; ++k) {
            const StandingSphere& b = spheres[order_[k]];
            if (b.particle <= a.particle) continue;
            const double depth = a.radius + b.radius - length(a.position - b.position);
            if (!(depth > 0.0)) continue;
            const double smaller = std::min(a.radius, b.radius);
            largest_ = std::max(largest_, depth / smaller);
            if (!(depth > most * smaller + rounding(a.position, b.position))) continue;
            deep.push_back({a.particle, b.particle, a.position, depth});
            if (a.is_new || b.is_new) born.push_back({a.particle, b.particle});
        }
    }
}

std::vector<SphereOverlaps::Found> SphereOverlaps::check(std::span<const StandingSphere> spheres, double most) {
    build(spheres);
    largest_ = 0.0;
    std::vector<Found> deep;
    std::vector<std::array<std::uint64_t, 2>> born;
    for (std::uint32_t i = 0; i < spheres.size(); ++i) find(spheres, i, most, deep, born);
    std::sort(deep.begin(), deep.end(), [](const Found& a, const Found& b) { return ids(a) < ids(b); });
    std::sort(born.begin(), born.end());
    std::vector<Found> wrong;
    for (const Found& found : deep) {
        if (std::binary_search(born.begin(), born.end(), std::array{found.first, found.second})) continue;
        const auto before = std::lower_bound(before_.begin(), before_.end(), found,
                                             [](const Found& a, const Found& b) { return ids(a) < ids(b); });
        const bool was_there = before != before_.end() && ids(*before) == ids(found);
        const double allowed = was_there ? before->depth * (1.0 + 1e-9) + 1e-9 * most : 0.0;
        if (!was_there || found.depth > allowed) wrong.push_back(found);
    }
    before_ = std::move(deep);
    return wrong;
}

}  // namespace ricochet
