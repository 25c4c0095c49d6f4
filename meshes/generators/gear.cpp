#include "generators/gear.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "generators/layered_extrusion.h"
#include "generators/placement.h"
#include "generators/require.h"
#include "generators/unit_circle.h"
#include "ricochet/core/error.h"

namespace ricochet::meshes {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kCosPressure = 0.9396926207859084;         // cos 20 degrees
constexpr double kInvolutePressure = 0.014904383867336446;  // tan 20 degrees - 20 degrees, in radians
constexpr double kFilletReach = 0.3;  // reach of the tooth's foot into the gap, fraction of the gap's half

constexpr std::uint8_t kHub = 0;
constexpr std::uint8_t kWeb = 1;
constexpr std::uint8_t kRim = 2;

double norm(const Point2& p) { return std::sqrt(p.x * p.x + p.y * p.y); }
Point2 at_radius(const Point2& p, double radius) { return {radius * p.x / norm(p), radius * p.y / norm(p)}; }

Point2 rotated(const Point2& p, const CirclePoint& angle) {
    return {p.x * angle.cos - p.y * angle.sin, p.x * angle.sin + p.y * angle.cos};
}

Point2 polar(double radius, double radians) {
    const CirclePoint c = point_on_circle(radians / kTwoPi);
    return {radius * c.cos, radius * c.sin};
}

/// Radii of a gear's circles.
struct GearCircles {
    double base = 0.0;
    double tip = 0.0;
    double root = 0.0;
};

GearCircles circles(const GearShape& shape) {
    const double module_size = 2.0 * shape.pitch_radius / shape.teeth;
    return {shape.pitch_radius * kCosPressure, shape.pitch_radius + module_size,
            shape.pitch_radius - 1.25 * module_size};
}

/// Returns the roll angle at which the involute of the base circle reaches a radius.
double roll_at(double radius, double base) {
    const double ratio = radius / base;
    return std::sqrt(std::max(0.0, ratio * ratio - 1.0));
}

/// Returns a point of the flank that leaves the base circle at the angle `start` and leans towards the x axis.
Point2 flank_point(double base, double start, double roll) {
    const CirclePoint c = point_on_circle(roll / kTwoPi);
    const Point2 local{base * (c.cos + roll * c.sin), -base * (c.sin - roll * c.cos)};
    return rotated(local, point_on_circle(start / kTwoPi));
}

/// Appends points after `from` up to and including `to` along the circle that both lie on.
void append_arc(std::vector<Point2>& outline, Point2 from, Point2 to, double edge_length) {
    const double dx = to.x - from.x;
    const double dy = to.y - from.y;
    const int steps = steps_in(std::sqrt(dx * dx + dy * dy), edge_length);
    for (int i = 1; i < steps; ++i) {
        outline.push_back(at_radius({from.x + dx * i / steps, from.y + dy * i / steps}, norm(from)));
    }
    outline.push_back(to);
}

/// Returns the upper half of the tooth on the x axis, from the middle of its tip to the middle of the gap.
std::vector<Point2> half_tooth(const GearShape& shape, double edge_length) {
    const GearCircles r = circles(shape);
    const double half_pitch = 0.5 * kTwoPi / shape.teeth;
    const double start = 0.5 * half_pitch + kInvolutePressure;
    const double tip_roll = roll_at(r.tip, r.base);
    const double foot_roll = roll_at(std::max(r.root, r.base), r.base);
    std::vector<Point2> outline{{r.tip, 0.0}};
    append_arc(outline, outline.back(), at_radius(flank_point(r.base, start, tip_roll), r.tip), edge_length);
    const int steps = steps_in(r.tip - std::max(r.root, r.base), edge_length, 3);
    for (int i = 1; i <= steps; ++i) {
        outline.push_back(flank_point(r.base, start, tip_roll + (foot_roll - tip_roll) * i / steps));
    }
    Point2 foot = at_radius(outline.back(), r.root);
    if (r.root < r.base) {
        foot = polar(r.root, start + kFilletReach * (half_pitch - start));
        outline.push_back(foot);
    } else {
        outline.back() = foot;
    }
    append_arc(outline, foot, polar(r.root, half_pitch), edge_length);
    return outline;
}

/// Returns the whole outline, counter-clockwise.
std::vector<Point2> gear_outline(const GearShape& shape, double edge_length) {
    const std::vector<Point2> half = half_tooth(shape, edge_length);
    std::vector<Point2> tooth;
    for (std::size_t i = half.size() - 1; i > 0; --i) tooth.push_back({half[i].x, -half[i].y});
    tooth.insert(tooth.end(), half.begin(), half.end() - 1);  // its last point begins the next tooth
    std::vector<Point2> outline;
    for (int k = 0; k < shape.teeth; ++k) {
        const CirclePoint angle = point_on_circle(static_cast<double>(k) / shape.teeth);
        for (const Point2& p : tooth) outline.push_back(rotated(p, angle));
    }
    return outline;
}

std::vector<Point2> on_circle(const std::vector<Point2>& outline, double radius) {
    std::vector<Point2> loop;
    for (const Point2& p : outline) loop.push_back(at_radius(p, radius));
    return loop;
}

void check(const GearShape& shape) {
    require_between("gear", "teeth", shape.teeth, 8, 400);
    require_length("gear", "pitch-radius", shape.pitch_radius);
    require_length("gear", "bore-radius", shape.bore_radius);
    require_length("gear", "width", shape.width);
    require_between("gear", "web-recess", shape.web_recess, 0.0, 0.45);
    const double largest = 0.8 * circles(shape).root;
    if (shape.bore_radius > largest) {
        throw InputError(fmt::format("gear: --bore-radius {} leaves no room for hub and rim; at most {:.4g} fits here",
                                     shape.bore_radius, largest));
    }
}

}  // namespace

TriangleMesh make_gear(const GearShape& shape, double edge_length) {
    check(shape);
    const std::vector<Point2> outline = gear_outline(shape, edge_length);
    const double bore = shape.bore_radius;
    const double depth = circles(shape).root - bore;
    const double hub = bore + 0.25 * depth;
    const double rim = bore + 0.75 * depth;
    const std::vector<std::vector<Point2>> loops{on_circle(outline, bore), on_circle(outline, hub),
                                                 on_circle(outline, rim), outline};
    const std::array bands{Band{steps_in(hub - bore, edge_length), kHub}, Band{steps_in(rim - hub, edge_length), kWeb},
                           Band{steps_in(circles(shape).tip - rim, edge_length), kRim}};
    const PlanarRegion region = nested_region(loops, bands);
    constexpr std::uint32_t kAll = 1U << kHub | 1U << kWeb | 1U << kRim;
    constexpr std::uint32_t kHubAndRim = 1U << kHub | 1U << kRim;
    const double recess = shape.web_recess * shape.width;
    const double middle = shape.width - 2.0 * recess;
    std::vector<Slab> slabs{{middle, kAll, steps_in(middle, edge_length)}};
    if (recess > 0.0) {
        const Slab face{recess, kHubAndRim, steps_in(recess, edge_length)};
        slabs = {face, slabs.front(), face};
    }
    return moved(layered_extrusion(region, slabs), {0.0, 0.0, -0.5 * shape.width});
}

}  // namespace ricochet::meshes
