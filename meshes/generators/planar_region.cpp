#include "generators/planar_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "generators/unit_circle.h"

namespace ricochet::meshes {
namespace {

constexpr std::uint32_t kUnset = std::numeric_limits<std::uint32_t>::max();
constexpr double kMaxSteps = 1e6;  // keeps a tiny edge length from overflowing the step count

/// Numbers of the points of a grid. A point is made on first use.
class GridPoints {
public:
    GridPoints(std::span<const double> xs, std::span<const double> ys, PlanarRegion& region)
        : xs_(xs), ys_(ys), region_(region), numbers_(xs.size() * ys.size(), kUnset) {}

    std::uint32_t operator()(std::size_t i, std::size_t j) {
        std::uint32_t& number = numbers_[j * xs_.size() + i];
        if (number == kUnset) {
            number = static_cast<std::uint32_t>(region_.points.size());
            region_.points.push_back({xs_[i], ys_[j]});
        }
        return number;
    }

private:
    std::span<const double> xs_;
    std::span<const double> ys_;
    PlanarRegion& region_;
    std::vector<std::uint32_t> numbers_;
};

void add_triangle(PlanarRegion& region, std::uint32_t a, std::uint32_t b, std::uint32_t c, int part) {
    region.triangles.push_back({a, b, c});
    region.parts.push_back(static_cast<std::uint8_t>(part));
}

void add_quad(PlanarRegion& region, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, int part) {
    add_triangle(region, a, b, c, part);
    add_triangle(region, a, c, d, part);
}

/// Appends the points of a loop between two loops; returns the number of its first point.
std::uint32_t add_loop(PlanarRegion& region, const std::vector<Point2>& inner, const std::vector<Point2>& outer,
                       double fraction) {
    const auto first = static_cast<std::uint32_t>(region.points.size());
    for (std::size_t i = 0; i < inner.size(); ++i) {
        region.points.push_back(
            {inner[i].x + fraction * (outer[i].x - inner[i].x), inner[i].y + fraction * (outer[i].y - inner[i].y)});
    }
    return first;
}

void join_loops(PlanarRegion& region, std::uint32_t inner, std::uint32_t outer, std::uint32_t count, int part) {
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        add_quad(region, inner + i, outer + i, outer + next, inner + next, part);
    }
}

void add_core(PlanarRegion& region, std::uint32_t loop, std::uint32_t count, int part) {
    const auto center = static_cast<std::uint32_t>(region.points.size());
    region.points.push_back({0.0, 0.0});
    for (std::uint32_t i = 0; i < count; ++i) add_triangle(region, center, loop + i, loop + (i + 1) % count, part);
}

}  // namespace

int steps_in(double length, double edge_length, int fewest) {
    const double steps = std::fmin(kMaxSteps, std::floor(length / edge_length + 0.5));
    return std::max(fewest, static_cast<int>(steps));
}

std::vector<double> even_steps(double first, double last, double edge_length) {
    const int steps = steps_in(std::fabs(last - first), edge_length);
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(steps) + 1);
    for (int i = 0; i < steps; ++i) values.push_back(first + (last - first) * i / steps);
    values.push_back(last);
    return values;
}

PlanarRegion lattice_region(std::span<const double> xs, std::span<const double> ys,
                            const std::function<bool(std::size_t, std::size_t)>& solid) {
    PlanarRegion region;
    GridPoints point(xs, ys, region);
    for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
        for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
            if (!solid(i, j)) continue;
            // Fixes the order of points, because compilers differ in the evaluation order of arguments.
            const std::uint32_t d = point(i, j + 1);
            const std::uint32_t c = point(i + 1, j + 1);
            const std::uint32_t b = point(i + 1, j);
            const std::uint32_t a = point(i, j);
            add_quad(region, a, b, c, d, 0);
        }
    }
    return region;
}

PlanarRegion rectangle_region(double width, double height, double edge_length) {
    return lattice_region(even_steps(0.0, width, edge_length), even_steps(0.0, height, edge_length),
                          [](std::size_t, std::size_t) { return true; });
}

PlanarRegion nested_region(const std::vector<std::vector<Point2>>& loops, std::span<const Band> bands, int core_part) {
    PlanarRegion region;
    const auto count = static_cast<std::uint32_t>(loops.front().size());
    std::uint32_t previous = add_loop(region, loops.front(), loops.front(), 0.0);
    if (core_part >= 0) add_core(region, previous, count, core_part);
    for (std::size_t band = 0; band < bands.size(); ++band) {
        for (int step = 1; step <= bands[band].subdivisions; ++step) {
            const bool last = step == bands[band].subdivisions;
            const double fraction = last ? 1.0 : static_cast<double>(step) / bands[band].subdivisions;
            const std::uint32_t next = last ? add_loop(region, loops[band + 1], loops[band + 1], 0.0)
                                            : add_loop(region, loops[band], loops[band + 1], fraction);
            join_loops(region, previous, next, count, bands[band].part);
            previous = next;
        }
    }
    return region;
}

std::vector<Point2> circle_loop(double radius, int points) {
    std::vector<Point2> loop;
    loop.reserve(static_cast<std::size_t>(points));
    for (int i = 0; i < points; ++i) {
        const CirclePoint p = point_on_circle(static_cast<double>(i) / points);
        loop.push_back({radius * p.cos, radius * p.sin});
    }
    return loop;
}

}  // namespace ricochet::meshes
