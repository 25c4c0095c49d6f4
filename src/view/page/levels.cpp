#include "view/page/levels.h"

#include <algorithm>
#include <cmath>

namespace ricochet {

std::uint16_t LevelScale::level(double value) const {
    if (!std::isfinite(value)) return has_gaps ? static_cast<std::uint16_t>(largest + 1) : std::uint16_t{0};
    return static_cast<std::uint16_t>(std::clamp(std::round((value - low) / step), 0.0, static_cast<double>(largest)));
}

PositionGrid position_grid(const Box3& box, int bits) {
    const auto largest = static_cast<std::uint16_t>((1U << static_cast<unsigned>(bits)) - 1U);
    if (box.empty()) return {{}, 1.0, largest};
    const Vec3 size = box.size();
    const double longest = std::max({size.x, size.y, size.z});
    return {box.lower, longest > 0.0 ? longest / largest : 1.0, largest};
}

Levels axis_levels(const std::vector<Vec3>& points, const PositionGrid& grid, int axis) {
    const LevelScale scale = grid.axis(axis);
    Levels levels;
    levels.reserve(points.size());
    for (const Vec3& point : points) levels.push_back(scale.level(point[axis]));
    return levels;
}

}  // namespace ricochet
