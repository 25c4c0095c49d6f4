#include "generators/torus_knot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "generators/planar_region.h"
#include "generators/require.h"
#include "generators/unit_circle.h"
#include "ricochet/core/error.h"

namespace ricochet::meshes {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kThicknessMargin = 0.95;  // because the cross-sections are polygons and the knot is sampled
constexpr int kSamplesPerWinding = 400;
constexpr int kMinAround = 8;

/// Point of the knot's centre line with its frame: tangent, the torus' outward normal, and their cross product.
struct KnotPoint {
    Vec3 position;
    Vec3 tangent;
    Vec3 normal;
    Vec3 binormal;
};

KnotPoint knot_point(const TorusKnotShape& shape, int i, int count) {
    const auto turn = [&](int windings) {
        return point_on_circle(static_cast<double>(std::int64_t{windings} * i % count) / count);
    };
    const auto [cos_p, sin_p] = turn(shape.p);
    const auto [cos_q, sin_q] = turn(shape.q);
    const double distance = shape.radius + shape.winding * cos_q;
    KnotPoint k;
    k.position = {distance * cos_p, distance * sin_p, shape.winding * sin_q};
    const double out = -shape.winding * shape.q * sin_q;
    const double around = distance * shape.p;
    k.tangent =
        normalized({out * cos_p - around * sin_p, out * sin_p + around * cos_p, shape.winding * shape.q * cos_q});
    k.normal = {cos_q * cos_p, cos_q * sin_p, sin_q};
    k.binormal = cross(k.tangent, k.normal);
    return k;
}

std::vector<KnotPoint> knot_points(const TorusKnotShape& shape, int count) {
    std::vector<KnotPoint> points;
    points.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) points.push_back(knot_point(shape, i, count));
    return points;
}

double curve_length(const std::vector<KnotPoint>& points) {
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        sum += length(points[(i + 1) % points.size()].position - points[i].position);
    }
    return sum;
}

int sample_count(const TorusKnotShape& shape) { return kSamplesPerWinding * std::max(shape.p, shape.q); }

/// Returns the smallest radius of curvature, from the turning of the tangent.
double tightest_bend(const std::vector<KnotPoint>& points) {
    double tightest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const KnotPoint& next = points[(i + 1) % points.size()];
        const double turned = length(next.tangent - points[i].tangent);
        if (turned > 0.0) tightest = std::min(tightest, length(next.position - points[i].position) / turned);
    }
    return tightest;
}

/// Returns the smallest distance between strands: the smallest local minimum, over all points, of the distance to the
/// rest of the curve.
double strand_distance(const std::vector<KnotPoint>& points) {
    const std::size_t n = points.size();
    double nearest = std::numeric_limits<double>::infinity();
    std::vector<double> distance(n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) distance[j] = length(points[j].position - points[i].position);
        for (std::size_t step = 1; step < n; ++step) {
            const std::size_t j = (i + step) % n;
            const bool minimum = distance[j] <= distance[(j + n - 1) % n] && distance[j] <= distance[(j + 1) % n];
            if (minimum) nearest = std::min(nearest, distance[j]);
        }
    }
    return nearest;
}

void check(const TorusKnotShape& shape) {
    require_length("torus-knot", "radius", shape.radius);
    require_between("torus-knot", "winding", shape.winding, kShortest, 0.999 * shape.radius);
    require_length("torus-knot", "tube-radius", shape.tube_radius);
    require_between("torus-knot", "p", shape.p, 1, 50);
    require_between("torus-knot", "q", shape.q, 1, 50);
    if (std::gcd(shape.p, shape.q) != 1) {
        throw InputError(
            fmt::format("torus-knot: --p and --q must have no common divisor, got {} and {}", shape.p, shape.q));
    }
    const double thickest = kThicknessMargin * torus_knot_thickness(shape);
    if (shape.tube_radius > thickest) {
        throw InputError(
            fmt::format("torus-knot: --tube-radius {} makes the tube cross itself; at most {:.4g} fits here",
                        shape.tube_radius, thickest));
    }
}

}  // namespace

double torus_knot_thickness(const TorusKnotShape& shape) {
    const std::vector<KnotPoint> points = knot_points(shape, sample_count(shape));
    return std::min(tightest_bend(points), 0.5 * strand_distance(points));
}

TriangleMesh make_torus_knot(const TorusKnotShape& shape, double edge_length) {
    check(shape);
    const double total = curve_length(knot_points(shape, sample_count(shape)));
    const int along = steps_in(total, edge_length, 16 * std::max(shape.p, shape.q));
    const int around = steps_in(kTwoPi * shape.tube_radius, edge_length, kMinAround);
    const std::vector<Point2> circle = circle_loop(shape.tube_radius, around);
    TriangleMesh mesh;
    for (const KnotPoint& k : knot_points(shape, along)) {
        for (const Point2& c : circle) mesh.vertices.push_back(k.position + c.x * k.normal + c.y * k.binormal);
    }
    const auto columns = static_cast<std::uint32_t>(around);
    const auto rows = static_cast<std::uint32_t>(along);
    for (std::uint32_t i = 0; i < rows; ++i) {
        const std::uint32_t next_row = (i + 1) % rows;
        for (std::uint32_t j = 0; j < columns; ++j) {
            const std::uint32_t next = (j + 1) % columns;
            const std::uint32_t a = i * columns + j;
            const std::uint32_t b = next_row * columns + j;
            const std::uint32_t c = next_row * columns + next;
            const std::uint32_t d = i * columns + next;
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({a, d, c});
        }
    }
    return mesh;
}

}  // namespace ricochet::meshes
