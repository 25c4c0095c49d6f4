#include "ricochet/collision/free_time.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ricochet {
namespace {

/// Relative rounding of the times here, generously: margins of distance are far above it.
constexpr double kTimeRounding = 0x1p-40;

/// Steps of sphere tracing through free space at a time; a field of a thousand cells is crossed in fewer but along
/// walls.
constexpr int kMostTracingSteps = 64;

}  // namespace

Path shortened(const Path& path, double duration) {
    Path shorter = path;
    shorter.end = path.position(duration);
    shorter.duration = std::min(duration, path.duration);
    return shorter;
}

// First root of g0 + g1 t + g2 t^2, the height above the margin on the side of the start, in the form without
// cancellation (e.g. Higham, "Accuracy and Stability of Numerical Algorithms", section 1.8).
double time_free_of_plane(const Path& path, const Plane& plane, double margin) {
    const Vec3 start = path.c[0] - plane.point;
    const double height = dot(plane.normal, start);
    const double side = height < 0.0 ? -1.0 : 1.0;
    // The margin knows the path only; the height errs by the distance along the plane too: a difference, a product and
    // two sums, less than five roundings of each component.
    constexpr double kHeightError = 16.0 * 0x1p-53;
    const double g0 = side * height - margin - kHeightError * dot(abs(plane.normal), abs(start));
    const double g1 = side * dot(plane.normal, path.c[1]);
    const double g2 = side * dot(plane.normal, path.c[2]);
    if (!(g0 > 0.0)) return 0.0;
    const double discriminant = g1 * g1 - 4.0 * g0 * g2;
    if (!(discriminant >= 0.0) || (g1 >= 0.0 && g2 >= 0.0)) return path.duration;
    const double root = std::sqrt(discriminant);
    const double time = g1 < 0.0 ? 2.0 * g0 / (root - g1) : (g1 + root) / (-2.0 * g2);
    return std::min(path.duration, (1.0 - kTimeRounding) * time);
}

double time_outside(const Path& path, const Box3& box) {
    constexpr std::array kAxes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    double longest = 0.0;
    for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
        const Vec3& normal = kAxes[axis];
        const double coordinate = dot(normal, path.c[0]);
        const bool is_below = coordinate < dot(normal, box.lower);
        if (!is_below && coordinate <= dot(normal, box.upper)) continue;
        const Plane face{is_below ? box.lower : box.upper, normal};
        longest = std::max(longest, time_free_of_plane(path, face, 0.0));
    }
    return longest;
}

// Within t the particle gets no further than v t + a t^2 / 2, which is the clearance at the root in the form without
// cancellation.
double time_clear_of_field(const Path& path, const DistanceField& field, double margin, double from) {
    const double acceleration = 2.0 * length(path.c[2]);
    double time = from;
    for (int step = 0; step < kMostTracingSteps && time < path.duration; ++step) {
        const double clearance = field.lower_bound(path.position(time)) - margin;
        if (!(clearance > 0.0)) break;
        const double speed = length(path.velocity(time));
        const double sum = speed + std::sqrt(speed * speed + 2.0 * acceleration * clearance);
        time += (1.0 - kTimeRounding) * (2.0 * clearance / sum);
    }
    return std::min(time, path.duration);
}

double time_of_leaving(const Path& path, const Box3& box) {
    if (path.degree > 1) return path.duration;
    double enter = 0.0;
    double leave = path.duration;
    for (int axis = 0; axis < 3; ++axis) {
        const double speed = path.c[1][axis];
        const double below = box.lower[axis] - path.c[0][axis];
        const double above = box.upper[axis] - path.c[0][axis];
        if (speed == 0.0) {
            if (below > 0.0 || above < 0.0) return 0.0;
            continue;
        }
        enter = std::max(enter, std::min(below / speed, above / speed));
        leave = std::min(leave, std::max(below / speed, above / speed));
    }
    return enter > leave ? 0.0 : std::min(path.duration, (1.0 + kTimeRounding) * leave);
}

}  // namespace ricochet
