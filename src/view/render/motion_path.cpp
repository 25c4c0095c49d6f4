#include "view/render/motion_path.h"

#include <algorithm>
#include <cmath>

namespace ricochet {
namespace {

// Returns a point of the Hermite cubic between two nodes. Returns the position of `b` if the nodes have equal times.
Vec3 between(const PathNode& a, const PathNode& b, double time) {
    const double span = b.time - a.time;
    if (!(span > 0.0)) return b.position;
    const double s = std::clamp((time - a.time) / span, 0.0, 1.0);
    const double t = 1.0 - s;
    return t * t * (1.0 + 2.0 * s) * a.position + s * s * (3.0 - 2.0 * s) * b.position +
           s * t * span * (t * a.velocity_after - s * b.velocity_before);
}

// Returns an upper bound of the deviation of the path from its chord. The bound is an eighth of the largest second
// derivative times the square of the duration. The second derivative of a cubic is linear, so its magnitude is largest
// at one of the ends.
double deviation_bound(const PathNode& a, const PathNode& b) {
    const Vec3 derivative = 6.0 * (b.position - a.position);
    const double span = b.time - a.time;
    const Vec3 at_a = derivative - span * (4.0 * a.velocity_after + 2.0 * b.velocity_before);
    const Vec3 at_b = span * (2.0 * a.velocity_after + 4.0 * b.velocity_before) - derivative;
    return 0.125 * std::max(length(at_a), length(at_b));
}

}  // namespace

Vec3 position_on_path(std::span<const PathNode> nodes, double time) {
    const auto later = [](double t, const PathNode& node) { return t < node.time; };
    const auto next = std::upper_bound(nodes.begin(), nodes.end(), time, later);
    if (next == nodes.begin()) return next->position + (time - next->time) * next->velocity_before;
    const PathNode& before = *(next - 1);
    if (next == nodes.end()) return before.position + (time - before.time) * before.velocity_after;
    return between(before, *next, time);
}

std::vector<MotionPathPoint> path_points(std::span<const PathNode> nodes, double from, double to, double sagitta) {
    constexpr double kMostPieces = 64.0;
    std::vector<MotionPathPoint> points{{from, position_on_path(nodes, from)}};
    for (std::size_t k = 0; k <= nodes.size(); ++k) {
        const double begin = k == 0 ? from : std::max(from, nodes[k - 1].time);
        const double end = k == nodes.size() ? to : std::min(to, nodes[k].time);
        if (!(begin < end)) continue;
        double pieces = 1.0;
        if (k > 0 && k < nodes.size()) {
            const double part = (end - begin) / (nodes[k].time - nodes[k - 1].time);
            const double needed = std::sqrt(deviation_bound(nodes[k - 1], nodes[k]) / sagitta) * part;
            pieces = std::clamp(std::ceil(needed), 1.0, kMostPieces);
        }
        for (double i = 1.0; i < pieces; i += 1.0) {
            const double time = begin + i / pieces * (end - begin);
            points.push_back({time, position_on_path(nodes, time)});
        }
        // The position of a node is copied, because the interpolated position is rounded and the path has a corner at
        // an impact.
        const bool at_node = k < nodes.size() && end == nodes[k].time;
        points.push_back({end, at_node ? nodes[k].position : position_on_path(nodes, end)});
    }
    return points;
}

}  // namespace ricochet
