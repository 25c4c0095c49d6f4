#include "support/segment_triangle_cases.h"

#include <array>
#include <cmath>
#include <sstream>

#include "ricochet/core/random.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet::testing {
namespace {

constexpr std::uint64_t kTriangleKinds = 7;
constexpr std::uint64_t kSegmentKinds = 10;
constexpr std::uint64_t kPlacements = 9;

using Corners = std::array<Vec3, 3>;

double between(RandomSequence& random, double lower, double upper) {
    return lower + (upper - lower) * random.uniform();
}

int whole_between(RandomSequence& random, int lower, int upper) {
    return lower + static_cast<int>(random.uniform() * (upper - lower + 1));
}

Vec3 random_point(RandomSequence& random) {
    const double x = between(random, -1.0, 1.0);
    const double y = between(random, -1.0, 1.0);
    return {x, y, between(random, -1.0, 1.0)};
}

/// Returns a point of a coarse grid. Coincidences of every kind, such as common vertices and coplanar points, are then
/// frequent.
Vec3 grid_point(RandomSequence& random) {
    const int x = whole_between(random, -3, 3);
    const int y = whole_between(random, -3, 3);
    return Vec3(x, y, whole_between(random, -3, 3));
}

Corners slender_triangle(RandomSequence& random) {
    const Vec3 a = random_point(random);
    const Vec3 b = random_point(random);
    const double aspect = std::pow(10.0, between(random, -8.0, -4.0));
    return {a, b, a + random.uniform() * (b - a) + aspect * random_point(random)};
}

Corners axis_aligned_triangle(RandomSequence& random) {
    Corners corners{random_point(random), random_point(random), random_point(random)};
    const int axis = whole_between(random, 0, 2);
    for (Vec3& corner : corners) corner[axis] = corners[0][axis];
    return corners;
}

/// Returns a triangle with exactly collinear corners. Some of the corners can coincide.
Corners degenerate_triangle(RandomSequence& random) {
    const Vec3 a = grid_point(random);
    const Vec3 step = grid_point(random);
    const int kind = whole_between(random, 0, 3);
    if (kind == 0) return {a, a, a};
    if (kind == 1) return {a, a + step, a};
    return {a, a + whole_between(random, -3, 3) * step, a + whole_between(random, -3, 3) * step};
}

Corners triangle_of_kind(std::uint64_t kind, RandomSequence& random) {
    switch (kind) {
        case 0:
            return {grid_point(random), grid_point(random), grid_point(random)};
        case 1:
            return slender_triangle(random);
        case 2:
            return axis_aligned_triangle(random);
        case 3:
            return degenerate_triangle(random);
        case 4: {  // nearly collinear: the third corner is on the line of the others up to rounding
            const Vec3 a = random_point(random);
            const Vec3 b = random_point(random);
            return {a, b, a + between(random, -1.0, 2.0) * (b - a)};
        }
        default:
            return {random_point(random), random_point(random), random_point(random)};
    }
}

/// Returns a point of the triangle's plane, up to rounding. With on_border, the point is on the line of an edge.
Vec3 plane_point(const Corners& t, bool on_border, RandomSequence& random) {
    const double u = between(random, -0.5, 1.5);
    const double v = on_border ? 0.0 : between(random, -0.5, 1.5);
    return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

/// Returns a point of the triangle's plane. The point is exact if the corners are on the grid.
Vec3 whole_plane_point(const Corners& t, RandomSequence& random) {
    const int u = whole_between(random, -2, 4);
    const int v = whole_between(random, -2, 4);
    return t[0] + (0.5 * u) * (t[1] - t[0]) + (0.5 * v) * (t[2] - t[0]);
}

/// Returns the point moved by a few units in the last place.
Vec3 nudged(Vec3 p, RandomSequence& random) {
    for (int axis = 0; axis < 3; ++axis) p[axis] += whole_between(random, -3, 3) * 0x1p-52 * p[axis];
    return p;
}

std::array<Vec3, 2> aimed_through(const Vec3& target, RandomSequence& random) {
    const Vec3 p = whole_between(random, 0, 1) == 0 ? grid_point(random) : random_point(random);
    const double overshoot = whole_between(random, 0, 1) == 0 ? 2.0 : between(random, 0.5, 3.0);
    return {p, p + overshoot * (target - p)};
}

std::array<Vec3, 2> grazing_segment(const Corners& t, RandomSequence& random) {
    Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
    if (max_abs(normal) > 0.0) normal = normal / max_abs(normal);
    const double slope = std::pow(10.0, between(random, -16.0, -6.0));
    const Vec3 p = plane_point(t, false, random);
    const Vec3 q = plane_point(t, false, random);
    return {p + slope * random.uniform() * normal, q - slope * random.uniform() * normal};
}

std::array<Vec3, 2> segment_of_kind(std::uint64_t kind, const Corners& t, RandomSequence& random) {
    switch (kind) {
        case 0:  // nearly coplanar
            return {nudged(plane_point(t, false, random), random), nudged(plane_point(t, false, random), random)};
        case 1:  // coplanar; exactly coplanar if the corners are on the grid
            return {whole_plane_point(t, random), whole_plane_point(t, random)};
        case 2:  // through a vertex
            return aimed_through(t[static_cast<std::size_t>(whole_between(random, 0, 2))], random);
        case 3:  // through an edge's line
            return aimed_through(plane_point(t, true, random), random);
        case 4:  // through the middle of an edge
            return aimed_through(0.5 * t[0] + 0.5 * t[1], random);
        case 5:
            return grazing_segment(t, random);
        case 6: {  // a point
            const Vec3 p = whole_between(random, 0, 1) == 0 ? whole_plane_point(t, random)
                                                            : nudged(plane_point(t, false, random), random);
            return {p, p};
        }
        case 7:  // from a point of the plane or a corner
            return {whole_between(random, 0, 1) == 0 ? t[1] : plane_point(t, false, random), random_point(random)};
        case 8:
            return {grid_point(random), grid_point(random)};
        default:
            return {random_point(random), random_point(random)};
    }
}

/// Returns the point after a shift or a scale. Some placements round, which deliberately turns exact coincidences into
/// near coincidences.
Vec3 placed(const Vec3& p, std::uint64_t placement) {
    switch (placement) {
        case 1:
            return p + Vec3{1e3, -1e3, 1e3};
        case 2:
            return p + Vec3{1e6, 1e6, 3e6};
        case 3:
            return p * 0x1p-40;
        case 4:
            return p * 0x1p40;
        case 5:
            return p * 0x1p-285;
        case 6:
            return p * 0x1p290;
        case 7:  // axes of very different scale
            return {p.x * 0x1p200, p.y, p.z * 0x1p-200};
        case 8:  // both ends of the range at once
            return {p.x * 0x1p290, p.y * 0x1p-285, p.z};
        default:
            return p;
    }
}

}  // namespace

SegmentTriangle segment_triangle_case(std::uint64_t seed, std::uint64_t index) {
    RandomSequence random(seed, 0, index);
    const std::uint64_t triangle_kind = index % kTriangleKinds;
    const std::uint64_t segment_kind = index / kTriangleKinds % kSegmentKinds;
    const std::uint64_t placement = index / (kTriangleKinds * kSegmentKinds) % kPlacements;
    const Corners t = triangle_of_kind(triangle_kind, random);
    const std::array<Vec3, 2> s = segment_of_kind(segment_kind, t, random);
    const auto transform = [placement](const Vec3& point) { return flush_tiny(placed(point, placement)); };
    return {transform(s[0]), transform(s[1]), transform(t[0]), transform(t[1]), transform(t[2])};
}

std::string description(const SegmentTriangle& s) {
    std::ostringstream text;
    text << std::hexfloat;
    const std::array<const Vec3*, 5> points{&s.p, &s.q, &s.a, &s.b, &s.c};
    for (std::size_t i = 0; i < points.size(); ++i) {
        text << "pqabc"[i] << " = {" << points[i]->x << ", " << points[i]->y << ", " << points[i]->z << "} ";
    }
    return text.str();
}

}  // namespace ricochet::testing
