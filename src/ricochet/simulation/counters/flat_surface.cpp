#include "ricochet/simulation/counters/flat_surface.h"

#include <algorithm>
#include <cmath>

#include "ricochet/geometry/sweep/path.h"

namespace ricochet {
namespace {

/// Returns the unit vector of a direction of any length.
Vec3 unit(const Vec3& direction) { return normalized(direction / max_abs(direction)); }

}  // namespace

FlatSurface::FlatSurface(const DiskCounter& disk)
    : kind_(Kind::disk), center_(disk.center), normal_(unit(disk.normal)), radius_(disk.radius) {}

FlatSurface::FlatSurface(const PlaneCounter& plane)
    : kind_(Kind::plane), center_(plane.center), normal_(unit(plane.normal)) {}

FlatSurface::FlatSurface(const RectangleCounter& rectangle)
    : kind_(Kind::rectangle), center_(rectangle.center), normal_(unit(rectangle.normal)) {
    const Vec3 along = unit(rectangle.along);
    sides_[0] = unit(along - dot(along, normal_) * normal_);
    sides_[1] = cross(normal_, sides_[0]);
    halves_ = {0.5 * rectangle.size[0], 0.5 * rectangle.size[1]};
}

bool FlatSurface::contains(const Vec3& position) const {
    const Vec3 offset = position - center_;
    switch (kind_) {
        case Kind::disk:
            return length(offset - dot(normal_, offset) * normal_) <= radius_;
        case Kind::rectangle:
            return std::fabs(dot(sides_[0], offset)) <= halves_[0] && std::fabs(dot(sides_[1], offset)) <= halves_[1];
        case Kind::plane:
            break;
    }
    return true;
}

bool FlatSurface::is_missed(const Vec3& from, const Vec3& to, std::span<const FlownPiece> pieces) const {
    if (pieces.size() != 1) return false;
    const bool begins_in_front = is_in_front(from);
    const ControlPoints hull = pieces[0].path.control_points();
    return begins_in_front == is_in_front(to) &&
           std::ranges::all_of(hull, [&](const Vec3& point) { return is_in_front(point) == begins_in_front; });
}

}  // namespace ricochet
