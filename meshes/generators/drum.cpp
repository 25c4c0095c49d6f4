#include "generators/drum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "generators/layered_extrusion.h"
#include "generators/placement.h"
#include "generators/require.h"
#include "generators/unit_circle.h"

namespace ricochet::meshes {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kLifterFoot = 0.14;  // half width of a lifter at the barrel, fraction of the lifters' spacing
constexpr double kLifterHead = 0.09;  // half width at its top, same unit

constexpr std::uint8_t kHole = 0;
constexpr std::uint8_t kLip = 1;
constexpr std::uint8_t kBarrel = 2;

Point2 polar(double radius, double turns) {
    const CirclePoint c = point_on_circle(turns);
    return {radius * c.cos, radius * c.sin};
}

/// Returns the inside of the barrel, counter-clockwise, at strictly growing angles. For each lifter it has the rising
/// flank, the head, the falling flank and the barrel up to the next lifter.
std::vector<Point2> inner_outline(const DrumShape& shape, double edge_length) {
    const double head = shape.radius - shape.lifter_height;
    const double spacing = 1.0 / shape.lifters;
    std::vector<Point2> outline;
    for (int k = 0; k < shape.lifters; ++k) {
        const auto turns = [&](double offset) { return (k + offset) * spacing; };
        const std::array<Point2, 4> corners{polar(shape.radius, turns(-kLifterFoot)), polar(head, turns(-kLifterHead)),
                                            polar(head, turns(kLifterHead)), polar(shape.radius, turns(kLifterFoot))};
        for (std::size_t side = 0; side < 3; ++side) {
            const Point2 a = corners[side];
            const Point2 b = corners[side + 1];
            const int steps = steps_in(std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y)), edge_length);
            for (int i = 0; i < steps; ++i) {
                outline.push_back({a.x + (b.x - a.x) * i / steps, a.y + (b.y - a.y) * i / steps});
            }
        }
        const double stretch = 1.0 - 2.0 * kLifterFoot;
        const int steps = steps_in(kTwoPi * shape.radius * spacing * stretch, edge_length, 3);
        for (int i = 0; i < steps; ++i) {
            outline.push_back(polar(shape.radius, turns(kLifterFoot + stretch * i / steps)));
        }
    }
    return outline;
}

std::vector<Point2> on_circle(const std::vector<Point2>& outline, double radius) {
    std::vector<Point2> loop;
    for (const Point2& p : outline) {
        const double scale = radius / std::sqrt(p.x * p.x + p.y * p.y);
        loop.push_back({scale * p.x, scale * p.y});
    }
    return loop;
}

/// Returns the cross-section: a core as wide as the opening, the lip around it, and the barrel.
PlanarRegion drum_region(const DrumShape& shape, double edge_length) {
    const std::vector<Point2> inside = inner_outline(shape, edge_length);
    const double hole = (shape.opening > 0.0 ? shape.opening : 0.5) * (shape.radius - shape.lifter_height);
    const int rings = steps_in(hole, edge_length, 2);
    const std::vector<std::vector<Point2>> loops{on_circle(inside, hole / rings), on_circle(inside, hole), inside,
                                                 on_circle(inside, shape.radius + shape.thickness)};
    const std::array bands{Band{rings - 1, kHole}, Band{steps_in(shape.radius - hole, edge_length), kLip},
                           Band{steps_in(shape.thickness, edge_length), kBarrel}};
    return nested_region(loops, bands, kHole);
}

void check(const DrumShape& shape) {
    require_length("drum", "radius", shape.radius);
    require_length("drum", "length", shape.length);
    require_length("drum", "thickness", shape.thickness);
    require_between("drum", "lifters", shape.lifters, 3, 60);
    require_between("drum", "lifter-height", shape.lifter_height, kShortest, 0.5 * shape.radius);
    if (shape.opening != 0.0) require_between("drum", "opening", shape.opening, 0.1, 0.95);
}

}  // namespace

TriangleMesh make_drum(const DrumShape& shape, double edge_length) {
    check(shape);
    constexpr std::uint32_t kWall = 1U << kHole | 1U << kLip | 1U << kBarrel;
    const std::uint32_t front = shape.opening > 0.0 ? 1U << kLip | 1U << kBarrel : kWall;
    const int across = steps_in(shape.thickness, edge_length);
    const std::array slabs{Slab{shape.thickness, kWall, across},
                           Slab{shape.length, 1U << kBarrel, steps_in(shape.length, edge_length)},
                           Slab{shape.thickness, front, across}};
    const TriangleMesh upward = layered_extrusion(drum_region(shape, edge_length), slabs);
    return moved(stood_up(upward), {0.0, 0.5 * shape.length + shape.thickness, 0.0});
}

}  // namespace ricochet::meshes
