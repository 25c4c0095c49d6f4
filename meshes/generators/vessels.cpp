#include "generators/vessels.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "generators/planar_region.h"
#include "generators/require.h"
#include "generators/unit_circle.h"
#include "ricochet/core/error.h"

namespace ricochet::meshes {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr int kMinSegments = 12;

bool on_axis(const Point2& p) { return p.x == 0.0; }

/// Adds the rings of profile points, and returns the number of each ring's first vertex. A point on the axis has a
/// single vertex.
std::vector<std::uint32_t> add_rings(TriangleMesh& mesh, std::span<const Point2> profile, int segments) {
    const std::vector<Point2> circle = circle_loop(1.0, segments);
    std::vector<std::uint32_t> first;
    for (const Point2& p : profile) {
        first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
        if (on_axis(p)) {
            mesh.vertices.push_back({0.0, 0.0, p.y});
            continue;
        }
        for (const Point2& c : circle) mesh.vertices.push_back({p.x * c.x, p.x * c.y, p.y});
    }
    return first;
}

/// Adds the triangles between the rings of two neighbouring profile points.
void join_rings(TriangleMesh& mesh, std::uint32_t lower, bool lower_pole, std::uint32_t upper, bool upper_pole,
                std::uint32_t segments) {
    for (std::uint32_t i = 0; i < segments; ++i) {
        const std::uint32_t next = (i + 1) % segments;
        if (!lower_pole) mesh.triangles.push_back({lower + i, lower + next, upper_pole ? upper : upper + next});
        if (!upper_pole) mesh.triangles.push_back({lower_pole ? lower : lower + i, upper + next, upper + i});
    }
}

/// Returns the surface of a profile of points (x = distance from the axis, y = height) revolved about z. Wound outward
/// if the solid lies to the left of the profile.
/// - profile: at least three points, and no crossings. Either exactly its first and last points lie on the axis
///   (distance exactly 0), or no point does. In the second case the last point is joined to the first.
/// - segments: cells around the axis, at least 3
TriangleMesh surface_of_revolution(std::span<const Point2> profile, int segments) {
    TriangleMesh mesh;
    const std::vector<std::uint32_t> first = add_rings(mesh, profile, segments);
    const bool loop = !on_axis(profile.front());
    const std::size_t pieces = loop ? profile.size() : profile.size() - 1;
    for (std::size_t i = 0; i < pieces; ++i) {
        const std::size_t next = (i + 1) % profile.size();
        join_rings(mesh, first[i], on_axis(profile[i]), first[next], on_axis(profile[next]),
                   static_cast<std::uint32_t>(segments));
    }
    return mesh;
}

/// Returns the polyline with pieces of about the edge length, by added points. `closed` joins the last point to the
/// first.
std::vector<Point2> refined(std::span<const Point2> polyline, bool closed, double edge_length) {
    std::vector<Point2> points;
    const std::size_t pieces = closed ? polyline.size() : polyline.size() - 1;
    for (std::size_t i = 0; i < pieces; ++i) {
        const Point2& a = polyline[i];
        const Point2& b = polyline[(i + 1) % polyline.size()];
        const double dx = b.x - a.x;
        const double dy = b.y - a.y;
        const int steps = steps_in(std::sqrt(dx * dx + dy * dy), edge_length);
        for (int s = 0; s < steps; ++s) points.push_back({a.x + dx * s / steps, a.y + dy * s / steps});
    }
    if (!closed) points.push_back(polyline.back());
    return points;
}

/// Returns points of an arc about (0, height) from the lowest point up to `turns`. The first one is exactly on the
/// axis.
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
    return surface_of_revolution(profile, steps_in(kTwoPi * shape.radius, edge_length, kMinSegments));
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
    return surface_of_revolution(profile, steps_in(kTwoPi * middle, edge_length, kMinSegments));
}

}  // namespace ricochet::meshes
