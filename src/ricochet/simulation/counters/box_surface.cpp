#include "ricochet/simulation/counters/box_surface.h"

#include <algorithm>
#include <tuple>

#include "ricochet/core/box_tools.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

BoxSurface::BoxSurface(const BoxCounter& box) : box_{box.center - 0.5 * box.size, box.center + 0.5 * box.size} {}

bool BoxSurface::is_behind(std::size_t face, const Vec3& position) const {
    const int axis = static_cast<int>(face / 2);
    return face % 2 == 0 ? position[axis] >= box_.lower[axis] : position[axis] < box_.upper[axis];
}

Vec3 BoxSurface::inward_normal(std::size_t face) {
    Vec3 normal;
    normal[static_cast<int>(face / 2)] = face % 2 == 0 ? 1.0 : -1.0;
    return normal;
}

bool BoxSurface::contains(const Vec3& position) const {
    for (std::size_t face = 0; face < kFaces; ++face) {
        if (!is_behind(face, position)) return false;
    }
    return true;
}

bool BoxSurface::is_missed(const Vec3& from, const Vec3& to, std::span<const FlownPiece> pieces) const {
    Box3 swept = box_around(from, to);
    for (const FlownPiece& piece : pieces) {
        for (const Vec3& point : piece.path.control_points()) swept.include(point);
    }
    return !overlap(swept, box_) || (contains(swept.lower) && contains(swept.upper));
}

void BoxSurface::find_changes(const PathLeg& leg, const std::array<bool, kFaces>& sides,
                              std::vector<Change>& changes) const {
    changes.clear();
    for (std::size_t face = 0; face < kFaces; ++face) {
        SideTrace side(sides[face]);
        side.follow(
            leg, inward_normal(face), [&](const Vec3& position) { return is_behind(face, position); },
            [&](bool is_inner, double s) {
                changes.push_back({s, face, is_inner});
            });
    }
    std::ranges::sort(changes, {}, [](const Change& change) { return std::tuple(change.time, change.face); });
}

}  // namespace ricochet
