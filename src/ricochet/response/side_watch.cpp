#include "ricochet/response/side_watch.h"

#include <algorithm>
#include <limits>

namespace ricochet {
namespace {

/// Relative rounding of a distance, by far.
constexpr double kClearRounding = 1e-9;

}  // namespace

void set_first_sides(const SignedDistance& distance, const Vec3& position, std::span<SideMemory> sides) {
    for (std::uint32_t collider = 0; collider < sides.size(); ++collider) {
        sides[collider] = {};
        const auto nearest = distance.closest(collider, position, std::numeric_limits<double>::infinity());
        if (nearest && !nearest->on_rim) sides[collider].side = static_cast<std::int8_t>(nearest->side);
    }
}

/// True when the place is on the wrong side. Which side is the right one is remembered while the particle is behind;
/// else it is that of where it comes from: it may have gone round a rim unseen since it was near last.
bool SideWatch::is_behind(const SurfacePoint& point, const Vec3& place, const Vec3& from) const {
    if (point.on_rim || point.side == 0) return false;
    const SideMemory& memory = sides_[point.collider];
    if (memory.penetrating) return memory.side == -point.side;
    if (!distance_.segment_meets(point.collider, from, place)) return false;
    const auto before = distance_.closest(point.collider, from, std::numeric_limits<double>::infinity());
    const bool is_known = before && !before->on_rim && before->side != 0;
    return (is_known ? before->side : memory.side) == -point.side;
}

Proximity SideWatch::proximity(const SurfacePoint& point, const Vec3& place, const Vec3& from) const {
    const SideMemory& memory = sides_[point.collider];
    Proximity seen{point.collider, point.surface, point.point, point.direction, 0.0, false, point.side};
    seen.behind = is_behind(point, place, from);
    if (point.on_rim) seen.side = 0;
    if (seen.behind) seen.normal = -point.direction;
    // On the surface itself the direction is the surface's normal, not the particle's.
    if (point.side == 0 && memory.side < 0) seen.normal = -point.direction;
    seen.gap = (seen.behind ? -point.distance : point.distance) - radius_;
    return seen;
}

void SideWatch::survey(const Vec3& place, double reach) {
    points_.clear();
    distance_.near(place, reach, points_);
    clear_center_ = place;
    clear_radius_ = reach;
    for (const SurfacePoint& point : points_) clear_radius_ = std::min(clear_radius_, point.distance);
}

void SideWatch::look(const Vec3& place, const Vec3& from, double margin, std::vector<Proximity>& out) {
    out.clear();
    points_.clear();
    const double within = radius_ + margin + length(place - from);
    // A rounding less than the distances say: they are rounded too.
    const bool clear = length(place - clear_center_) + within < (1.0 - kClearRounding) * clear_radius_;
    if (!clear) distance_.near(place, within, points_);
    const auto near_end = static_cast<std::ptrdiff_t>(points_.size());
    for (std::uint32_t collider = 0; collider < sides_.size(); ++collider) {
        if (!sides_[collider].penetrating) continue;
        const auto is_it = [&](const SurfacePoint& point) { return point.collider == collider; };
        if (std::any_of(points_.begin(), points_.begin() + near_end, is_it)) continue;
        const auto far = distance_.closest(collider, place, std::numeric_limits<double>::infinity());
        if (far) points_.push_back(*far);
    }
    for (const SurfacePoint& point : points_) {
        const Proximity seen = proximity(point, place, from);
        if (seen.gap < margin) out.push_back(seen);
    }
    std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.collider < b.collider; });
}

void SideWatch::settle(std::span<const Proximity> seen) {
    for (SideMemory& memory : sides_) memory.penetrating = memory.touching = false;
    for (const Proximity& view : seen) {
        SideMemory& memory = sides_[view.collider];
        memory.penetrating = view.behind;
        memory.touching = view.gap < 0.0;
        if (view.side != 0) memory.side = static_cast<std::int8_t>(view.behind ? -view.side : view.side);
    }
}

bool SideWatch::in_contact() const {
    return std::any_of(sides_.begin(), sides_.end(),
                       [](const SideMemory& memory) { return memory.touching || memory.penetrating; });
}

}  // namespace ricochet
