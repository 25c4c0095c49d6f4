#include "generators/vessels.h"

#include <array>

#include <fmt/format.h>

#include "generators/require.h"
#include "generators/surface_of_revolution.h"
#include "generators/unit_circle.h"
#include "ricochet/core/error.h"

namespace ricochet::meshes {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr int kFewestSegments = 12;

/// Points of an arc about (0, height) from the lowest point up to `turns`, the first one exactly on the axis.
std::vector<Point2> arc_from_axis(double radius, double height, double turns, int steps) {
    std::vector<Point2> points{{0.0, height - radius}};
    for (int i = 1; i <= steps; ++i) {
        const CirclePoint p = point_on_circle(turns * i / steps);
        points.push_back({radius * p.sin, height - radius * p.cos});
    }
    return points;
}

}  // namespace

TriangleMesh make_bowl(const BowlShape& shape, double edge_length) {
    require_length("bowl", "radius", shape.radius);
    require_length("bowl", "thickness", shape.thickness);
    require_between("bowl", "coverage", shape.coverage, 10.0, 170.0);
    const double outer = shape.radius + shape.thickness;
    const double turns = shape.coverage / 360.0;
    const int steps = steps_in(kTwoPi * turns * shape.radius, edge_length, 3);
    std::vector<Point2> profile = arc_from_axis(outer, outer, turns, steps);
    const std::vector<Point2> inside = arc_from_axis(shape.radius, outer, turns, steps);
    const std::array rim{profile.back(), inside.back()};
    const std::vector<Point2> across = refined(rim, false, edge_length);
    profile.insert(profile.end(), across.begin() + 1, across.end() - 1);
    profile.insert(profile.end(), inside.rbegin(), inside.rend());
    return surface_of_revolution(profile, steps_in(kTwoPi * shape.radius, edge_length, kFewestSegments));
}

TriangleMesh make_funnel(const FunnelShape& shape, double edge_length) {
    require_length("funnel", "top-radius", shape.top_radius);
    require_length("funnel", "throat-radius", shape.throat_radius);
    require_length("funnel", "cone-height", shape.cone_height);
    require_length("funnel", "spout-length", shape.spout_length);
    require_length("funnel", "thickness", shape.thickness);
    if (shape.throat_radius >= shape.top_radius) {
        throw InputError(fmt::format("funnel: --throat-radius must be below --top-radius ({}), got {}",
                                     shape.top_radius, shape.throat_radius));
    }
    const double knee = shape.spout_length;
    const double top = shape.spout_length + shape.cone_height;
    const std::array<Point2, 6> corners{{{shape.throat_radius + shape.thickness, 0.0},
                                         {shape.throat_radius + shape.thickness, knee},
                                         {shape.top_radius + shape.thickness, top},
                                         {shape.top_radius, top},
                                         {shape.throat_radius, knee},
                                         {shape.throat_radius, 0.0}}};
    const std::vector<Point2> profile = refined(corners, true, edge_length);
    const double middle = 0.5 * (shape.top_radius + shape.throat_radius);
    return surface_of_revolution(profile, steps_in(kTwoPi * middle, edge_length, kFewestSegments));
}

}  // namespace ricochet::meshes
