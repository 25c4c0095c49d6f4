#include "generators/surface_of_revolution.h"

#include <cmath>

#include "generators/unit_circle.h"

namespace ricochet::meshes {
namespace {

bool on_axis(const Point2& p) { return p.x == 0.0; }

/// First vertex number of a profile point's ring (a single vertex for a point on the axis).
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

/// The triangles between the rings of two neighbouring profile points.
void join_rings(TriangleMesh& mesh, std::uint32_t lower, bool lower_pole, std::uint32_t upper, bool upper_pole,
                std::uint32_t segments) {
    for (std::uint32_t i = 0; i < segments; ++i) {
        const std::uint32_t next = (i + 1) % segments;
        if (!lower_pole) mesh.triangles.push_back({lower + i, lower + next, upper_pole ? upper : upper + next});
        if (!upper_pole) mesh.triangles.push_back({lower_pole ? lower : lower + i, upper + next, upper + i});
    }
}

}  // namespace

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

}  // namespace ricochet::meshes
