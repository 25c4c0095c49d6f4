#include "ricochet/response/side_watch.h"

#include <algorithm>
#include <cmath>

namespace ricochet {
namespace {

/// Relative margin for the rounding of distances. Local: far larger than needed.
constexpr double kDistanceRounding = 1e-9;

}  // namespace

void set_first_sides(const SignedDistance& distance, const Vec3& position, std::span<SideMemory> sides) {
    std::ranges::fill(sides, SideMemory{});
    std::vector<SurfacePoint> on;
    distance.near(position, 0.0, on);
    for (const SurfacePoint& point : on) sides[point.collider].side = 1;
}

void settle_child_sides(const SignedDistance& distance, const ChildStart& start, std::span<SideMemory> sides) {
    SideScratch lists;
    SideWatch watch(distance, sides, start.radius, lists);
    watch.find_near(start.position, start.parent_start, 0.0, lists.seen);
    watch.settle(lists.seen);
    for (SideMemory& memory : sides) memory.touching = memory.touching && start.goes_on;
}

bool SideWatch::is_behind(const SurfacePoint& point, const Vec3& position, const Vec3& from) const {
    if (point.on_rim || point.side == 0) return false;
    const SideMemory& memory = sides_[point.collider];
    if (memory.penetrating) return memory.side == -point.side;
    const std::size_t crossings = distance_.count_met(point.collider, from, position);
    if (crossings == 0) return false;
    const auto before = distance_.closest(point.collider, from, length(position - from));
    const bool starts_on_it = before && before->distance == 0.0;
    if (starts_on_it) return memory.side == -point.side;
    if (crossings % 2 == 1) return true;
    return before && !before->on_rim && before->side == -point.side;
}

Proximity SideWatch::proximity(const SurfacePoint& point, const Vec3& position, const Vec3& from) const {
    const SideMemory& memory = sides_[point.collider];
    Proximity seen{point.collider, point.surface, point.point, point.direction, 0.0, false, point.side};
    seen.behind = is_behind(point, position, from);
    if (point.on_rim) seen.side = 0;
    if (seen.behind) seen.normal = -point.direction;
    // On the surface itself, the direction is the surface's normal, which may not point to the particle's side.
    if (point.side == 0 && memory.side < 0) seen.normal = -point.direction;
    seen.distance = (seen.behind ? -point.distance : point.distance) - radius_;
    return seen;
}

void SideWatch::survey(const Vec3& position, double reach) {
    points_.clear();
    distance_.near(position, reach, points_);
    clear_center_ = position;
    clear_radius_ = reach;
    for (const SurfacePoint& point : points_) clear_radius_ = std::min(clear_radius_, point.distance);
}

void SideWatch::find_near(const Vec3& position, const Vec3& from, double margin, std::vector<Proximity>& out) {
    out.clear();
    points_.clear();
    // A collider exactly at the limit must not be lost by the rounding of distances.
    const double within = (1.0 + kDistanceRounding) * (std::max(radius_ + margin, deepest()) + length(position - from));
    const bool clear = length(position - clear_center_) + within < (1.0 - kDistanceRounding) * clear_radius_;
    if (!clear) distance_.near(position, within, points_);
    for (const SurfacePoint& point : points_) {
        const Proximity seen = proximity(point, position, from);
        // Just behind a surface, the distance may be rounded to 0.
        if (seen.behind || seen.distance < margin) out.push_back(seen);
    }
}

void SideWatch::settle(std::span<const Proximity> seen) {
    for (SideMemory& memory : sides_) memory.penetrating = memory.touching = false;
    for (const Proximity& view : seen) {
        SideMemory& memory = sides_[view.collider];
        memory.penetrating = view.behind;
        memory.touching = view.behind || view.distance < 0.0;
        memory.depth = view.behind ? std::nextafter(static_cast<float>(-view.distance), INFINITY) : 0.0F;
        if (view.side != 0) memory.side = static_cast<std::int8_t>(view.behind ? -view.side : view.side);
    }
}

double SideWatch::deepest() const {
    double depth = 0.0;
    for (const SideMemory& memory : sides_) {
        if (memory.penetrating) depth = std::max(depth, static_cast<double>(memory.depth));
    }
    return depth;
}

bool SideWatch::in_contact() const {
    return std::ranges::any_of(sides_, [](const SideMemory& memory) { return memory.touching || memory.penetrating; });
}

}  // namespace ricochet
