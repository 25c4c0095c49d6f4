/// \file
/// Time to find the first contact with one triangle, for points and spheres on lines, parabolas and cubics. Paths hit,
/// pass or graze the triangle.

#include "ricochet/geometry/sweep/point_sweep.h"

#include <benchmark/benchmark.h>

#include <functional>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/geometry/sweep/sphere_sweep.h"

namespace ricochet {
namespace {

constexpr double kRadius = 0.2;
const Vec3 kA{-1.0, -1.0, 0.0};
const Vec3 kB{1.0, -0.9, 0.1};
const Vec3 kC{0.1, 1.1, -0.1};

/// Returns a path of one second between two points, curved for higher degrees.
Path path_between(const Vec3& from, const Vec3& to, int degree) {
    const Vec3 bend{0.1, -0.2, 0.15};
    if (degree == 1) return line_path(from, to - from, 1.0);
    if (degree == 2) return parabola_path(from, to - from - 0.5 * bend, bend, 1.0);
    return hermite_path(from, to - from + bend, to, to - from - 2.0 * bend, 1.0);
}

/// Returns a point on the triangle.
Vec3 place(RandomSequence& random) {
    const double u = random.uniform();
    const double v = (1.0 - u) * random.uniform();
    return kA + u * (kB - kA) + v * (kC - kA);
}

using MakePath = std::function<Path(RandomSequence&)>;

/// Returns a path through the triangle.
Path hit(RandomSequence& random, int degree) {
    const Vec3 p = place(random);
    const Vec3 way = random.unit_vector();
    return path_between(p - way, p + way, degree);
}

/// Returns a path some distance above the triangle's plane.
Path miss(RandomSequence& random, int degree) {
    const Vec3 above{0.0, 0.0, 0.5 + random.uniform()};
    return path_between(place(random) + above, place(random) + 1.5 * above, degree);
}

/// Returns a path along the triangle, at the height of the sphere's radius or in the plane, to rounding.
Path graze(RandomSequence& random, int degree, double height) {
    const Vec3 off = height * unit_normal(kA, kB, kC);
    return path_between(place(random) + off, place(random) + off, degree);
}

std::vector<Path> paths(const MakePath& make) {
    RandomSequence random(1, 0, 0);
    std::vector<Path> result;
    while (result.size() < 1024) result.push_back(make(random));
    return result;
}

void time_point(benchmark::State& state, const MakePath& make) {
    const std::vector<Path> ways = paths(make);
    std::size_t i = 0;
    for ([[maybe_unused]] auto _ : state) {
        benchmark::DoNotOptimize(first_crossing(ways[i++ % ways.size()], kA, kB, kC));
    }
}

void time_sphere(benchmark::State& state, const MakePath& make) {
    std::vector<SphereSweep> sweeps;
    for (const Path& path : paths(make)) sweeps.emplace_back(path, kRadius);
    std::size_t i = 0;
    for ([[maybe_unused]] auto _ : state) {
        benchmark::DoNotOptimize(sweeps[i++ % sweeps.size()].first_contact(kA, kB, kC));
    }
}

const auto degree_of = [](const benchmark::State& state) { return static_cast<int>(state.range(0)); };

void point_hit(benchmark::State& state) {
    time_point(state, [d = degree_of(state)](RandomSequence& random) { return hit(random, d); });
}
void point_miss(benchmark::State& state) {
    time_point(state, [d = degree_of(state)](RandomSequence& random) { return miss(random, d); });
}
void point_graze(benchmark::State& state) {
    time_point(state, [d = degree_of(state)](RandomSequence& random) { return graze(random, d, 0.0); });
}
void sphere_hit(benchmark::State& state) {
    time_sphere(state, [d = degree_of(state)](RandomSequence& random) { return hit(random, d); });
}
void sphere_miss(benchmark::State& state) {
    time_sphere(state, [d = degree_of(state)](RandomSequence& random) { return miss(random, d); });
}
void sphere_graze(benchmark::State& state) {
    time_sphere(state, [d = degree_of(state)](RandomSequence& random) { return graze(random, d, kRadius); });
}
BENCHMARK(point_hit)->ArgName("degree")->DenseRange(1, 3);
BENCHMARK(point_miss)->ArgName("degree")->DenseRange(1, 3);
BENCHMARK(point_graze)->ArgName("degree")->DenseRange(1, 3);
BENCHMARK(sphere_hit)->ArgName("degree")->DenseRange(1, 3);
BENCHMARK(sphere_miss)->ArgName("degree")->DenseRange(1, 3);
BENCHMARK(sphere_graze)->ArgName("degree")->DenseRange(1, 3);

}  // namespace
}  // namespace ricochet
