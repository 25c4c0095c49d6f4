/// \file
/// Time of one query of an analytic shape.

#include "ricochet/geometry/shapes/analytic_shape.h"

#include <benchmark/benchmark.h>

#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace {

enum Kind : std::int64_t { kSphere, kEllipsoid, kCylinder };

AnalyticShape shape_of(std::int64_t kind) {
    Placement placement;
    placement.position = {1, 2, 3};
    if (kind != kSphere) {
        placement.scale = {1.0, 1.5, 0.7};
        placement.rotation_axis = {1, 1, 0};
        placement.rotation_degrees = 30;
    }
    const AffineMap map = world_from_local(placement);
    return kind == kCylinder ? AnalyticShape::cylinder(map) : AnalyticShape::ball(map);
}

/// Returns paths of a given degree, about as long as the shape, from a given side. Half of them hit the shape.
std::vector<Path> paths_of(const AnalyticShape& shape, std::int64_t degree, int side) {
    RandomSequence random(1, 0, 0);
    std::vector<Path> paths;
    while (paths.size() < 1024) {
        const Vec3 p = shape.bounds().center() + 3.0 * random.in_unit_ball();
        if (shape.closest_point(p).distance * side < 0.15) continue;
        const Vec3 v = 1.5 * random.unit_vector();
        const Vec3 a = random.unit_vector();
        paths.push_back(degree == 1   ? line_path(p, v, 1.0)
                        : degree == 2 ? parabola_path(p, v, a, 1.0)
                                      : hermite_path(p, v, p + v + a, v + random.unit_vector(), 1.0));
    }
    return paths;
}

template <class Call>
void time_paths(benchmark::State& state, int side, const Call& call) {
    const AnalyticShape shape = shape_of(state.range(0));
    const std::vector<Path> paths = paths_of(shape, state.range(1), side);
    std::size_t i = 0;
    for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(call(shape, paths[i++ % paths.size()]));
}

void clears_from_outside(benchmark::State& state) {
    time_paths(state, +1, [](const AnalyticShape& s, const Path& path) { return s.can_cull(path, 0.01); });
}
void clears_from_inside(benchmark::State& state) {
    time_paths(state, -1, [](const AnalyticShape& s, const Path& path) { return s.can_cull(path, 0.01); });
}
void point_from_outside(benchmark::State& state) {
    time_paths(state, +1, [](const AnalyticShape& s, const Path& path) { return s.first_contact(path, 0.0); });
}
void point_from_inside(benchmark::State& state) {
    time_paths(state, -1, [](const AnalyticShape& s, const Path& path) { return s.first_contact(path, 0.0); });
}
void sphere_from_outside(benchmark::State& state) {
    time_paths(state, +1, [](const AnalyticShape& s, const Path& path) { return s.first_contact(path, 0.1); });
}
void sphere_from_inside(benchmark::State& state) {
    time_paths(state, -1, [](const AnalyticShape& s, const Path& path) { return s.first_contact(path, 0.1); });
}
void closest_point(benchmark::State& state) {
    time_paths(state, +1, [](const AnalyticShape& s, const Path& path) { return s.closest_point(path.end); });
}
void segment_is_clear(benchmark::State& state) {
    time_paths(state, +1,
               [](const AnalyticShape& s, const Path& path) { return s.segment_is_clear(path.c[0], path.end); });
}
void distance_to_segment(benchmark::State& state) {
    time_paths(state, +1,
               [](const AnalyticShape& s, const Path& path) { return s.distance_to_segment(path.c[0], path.end); });
}

void each_shape_and_degree(benchmark::internal::Benchmark* benchmark) {
    for (const std::int64_t kind : {kSphere, kEllipsoid, kCylinder}) {
        for (const std::int64_t degree : {1, 2, 3}) benchmark->Args({kind, degree});
    }
    benchmark->ArgNames({"sphere_ellipsoid_cylinder", "degree"});
}
void each_shape(benchmark::internal::Benchmark* benchmark) {
    for (const std::int64_t kind : {kSphere, kEllipsoid, kCylinder}) benchmark->Args({kind, 1});
    benchmark->ArgNames({"sphere_ellipsoid_cylinder", "degree"});
}

BENCHMARK(clears_from_outside)->Apply(each_shape_and_degree);
BENCHMARK(clears_from_inside)->Apply(each_shape_and_degree);
BENCHMARK(point_from_outside)->Apply(each_shape_and_degree);
BENCHMARK(point_from_inside)->Apply(each_shape_and_degree);
BENCHMARK(sphere_from_outside)->Apply(each_shape_and_degree);
BENCHMARK(sphere_from_inside)->Apply(each_shape_and_degree);
BENCHMARK(closest_point)->Apply(each_shape);
BENCHMARK(segment_is_clear)->Apply(each_shape);
BENCHMARK(distance_to_segment)->Apply(each_shape);

}  // namespace
}  // namespace ricochet
