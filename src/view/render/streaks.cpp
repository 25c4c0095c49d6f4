#include "view/render/streaks.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ricochet {

void add_streak(const Streak& streak, PreviewLines& lines) {
    constexpr double kSagitta = 0.05;  // largest distance of the path from its lines, relative to the radius
    const std::vector<MotionPathPoint> points =
        path_points(streak.nodes, streak.from, streak.to, kSagitta * streak.radius);
    const auto first = static_cast<std::uint32_t>(lines.points.size());
    for (const MotionPathPoint& point : points) lines.points.push_back(point.position);
    for (std::uint32_t i = 0; i + 1 < points.size(); ++i) {
        lines.ends.push_back({first + i, first + i + 1});
        lines.radii.push_back(streak.radius);
        lines.colors.push_back(streak.color);
        if (!streak.emission) continue;
        lines.emissions.push_back(*streak.emission);
        lines.parts.push_back((points[i + 1].time - points[i].time) / (streak.to - streak.from));
    }
}

}  // namespace ricochet
