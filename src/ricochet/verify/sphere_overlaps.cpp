#include "ricochet/verify/sphere_overlaps.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "ricochet/verify/boxes.h"
#include "ricochet/verify/item_tree.h"

namespace ricochet {
namespace {

auto ids(const SphereOverlaps::Found& found) { return std::pair(found.first, found.second); }

/// Returns the error of a distance, in m, that rounding of the coordinates can cause.
double rounding(const Vec3& a, const Vec3& b) {
    return 16.0 * std::numeric_limits<double>::epsilon() * std::max(max_abs(a), max_abs(b));
}

/// Calls visit(a, b) for the pairs of spheres whose boxes overlap. The id of a is lower than the id of b.
template <class Visit>
void for_each_near_pair(std::span<const StandingSphere> spheres, const Visit& visit) {
    constexpr std::uint32_t kLeafSize = 8;
    const verify::ItemTree tree(static_cast<std::uint32_t>(spheres.size()), kLeafSize,
                                [&](std::uint32_t i) { return spheres[i].position; });
    const auto sphere_at = [&](std::uint32_t k) -> const StandingSphere& { return spheres[tree.order()[k]]; };
    const auto box_of = [](const StandingSphere& sphere) {
        return verify::widened({sphere.position, sphere.position}, sphere.radius);
    };
    const std::vector<Box3> boxes = tree.boxes([&](std::uint32_t k) { return box_of(sphere_at(k)); });
    for (const StandingSphere& a : spheres) {
        const Box3 box = box_of(a);
        tree.visit([&](std::uint32_t node) { return verify::meet(boxes[node], box); },
                   [&](std::uint32_t k) {
                       if (sphere_at(k).particle > a.particle) visit(a, sphere_at(k));
                   });
    }
}

}  // namespace

std::vector<SphereOverlaps::Found> SphereOverlaps::check(std::span<const StandingSphere> spheres, double most) {
    largest_ = 0.0;
    std::vector<Found> deep;
    std::vector<std::array<std::uint64_t, 2>> born;
    for_each_near_pair(spheres, [&](const StandingSphere& a, const StandingSphere& b) {
        const double depth = a.radius + b.radius - length(a.position - b.position);
        if (!(depth > 0.0)) return;
        const double smaller = std::min(a.radius, b.radius);
        largest_ = std::max(largest_, depth / smaller);
        if (!(depth > most * smaller + rounding(a.position, b.position))) return;
        deep.push_back({a.particle, b.particle, a.position, depth});
        if (a.is_new || b.is_new) born.push_back({a.particle, b.particle});
    });
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
