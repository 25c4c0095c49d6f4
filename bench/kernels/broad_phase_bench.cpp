/// \file
/// Time of a broad-phase query for the triangles near a segment, in a rocky cavity of 20 thousand and of 1.3 million
/// triangles. Segments are shorter than an edge, or cross the cavity and end at their first triangle. Also the time of
/// a test of one cluster of triangles, and of one lookup in the distance field.

#include <benchmark/benchmark.h>

#include <map>
#include <vector>

#include "generators/build_near.h"
#include "generators/rock.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/acceleration/distance_field.h"
#include "ricochet/geometry/acceleration/triangle_bvh.h"
#include "ricochet/geometry/acceleration/triangle_clusters.h"

namespace ricochet {
namespace {

/// A mesh and its hierarchy, built once.
struct Ground {
    explicit Ground(std::size_t triangles)
        : mesh(meshes::build_near(triangles, 0.25, [](double edge) { return meshes::make_cavity({}, edge); })),
          bvh(mesh.vertices, mesh.triangles, 0.0) {}

    TriangleMesh mesh;
    TriangleBvh bvh;
};

const Ground& ground(std::size_t triangles) {
    static std::map<std::size_t, Ground> grounds;
    return grounds.try_emplace(triangles, triangles).first->second;
}

struct Segment {
    Vec3 from;
    Vec3 to;
};

/// Returns segments that start anywhere within the innermost metre.
std::vector<Segment> segments(double length) {
    RandomSequence random(1, 0, 0);
    std::vector<Segment> result;
    while (result.size() < 4096) {
        const Vec3 from = random.in_unit_ball();
        result.push_back({from, from + length * random.unit_vector()});
    }
    return result;
}

void visit(benchmark::State& state, double length, double narrowed) {
    const Ground& g = ground(static_cast<std::size_t>(state.range(0)));
    const std::vector<Segment> list = segments(length);
    std::size_t i = 0;
    std::size_t proposed = 0;
    for ([[maybe_unused]] auto _ : state) {
        const Segment& s = list[i++ % list.size()];
        g.bvh.query_segment(s.from, s.to, [&](std::uint32_t) {
            ++proposed;
            return narrowed;
        });
    }
    state.counters["proposed"] = benchmark::Counter(static_cast<double>(proposed), benchmark::Counter::kAvgIterations);
}

void visit_short(benchmark::State& state) { visit(state, 0.005, 1.0); }
void visit_across(benchmark::State& state) { visit(state, 4.0, 1.0); }
void visit_across_until_the_first(benchmark::State& state) { visit(state, 4.0, 0.0); }
BENCHMARK(visit_short)->ArgName("triangles")->Arg(20'000)->Arg(1'300'000);
BENCHMARK(visit_across)->ArgName("triangles")->Arg(20'000)->Arg(1'300'000);
BENCHMARK(visit_across_until_the_first)->ArgName("triangles")->Arg(20'000)->Arg(1'300'000);

/// Tests clusters near a path of the given curvature, within a distance of one cluster size.
void test_clusters(benchmark::State& state, double bend) {
    const TriangleMesh& mesh = ground(20'000).mesh;
    const TriangleClusters clusters = make_clusters(mesh.vertices, mesh.triangles);
    RandomSequence random(2, 0, 0);
    std::vector<Tube> tubes;
    for (const TriangleCluster& cluster : clusters) {
        const Vec3 aim = cluster.center + 0.5 * cluster.box().diagonal() * random.in_unit_ball();
        const Vec3 direction = random.unit_vector();
        tubes.emplace_back(aim - direction, aim + direction, 1e-9, bend * random.unit_vector());
    }
    std::size_t i = 0;
    std::size_t near = 0;
    for ([[maybe_unused]] auto _ : state) {
        TubeIntervals intervals;
        near += clusters[i].overlaps(tubes[i], intervals) != 0 ? 1 : 0;
        i = i + 1 == clusters.size() ? 0 : i + 1;
    }
    state.counters["near"] = benchmark::Counter(static_cast<double>(near), benchmark::Counter::kAvgIterations);
}
void clusters_along_lines(benchmark::State& state) { test_clusters(state, 0.0); }
void clusters_along_parabolas(benchmark::State& state) { test_clusters(state, 1e-3); }
BENCHMARK(clusters_along_lines);
BENCHMARK(clusters_along_parabolas);

/// Looks up points in the whole cavity; most of them are free.
void distance_lower_bound(benchmark::State& state) {
    const TriangleMesh& mesh = ground(static_cast<std::size_t>(state.range(0))).mesh;
    Box3 box;
    for (const Vec3& v : mesh.vertices) box.include(v);
    const DistanceField grid(mesh.vertices, mesh.triangles, box);
    RandomSequence random(3, 0, 0);
    std::vector<Vec3> points(4096);
    for (Vec3& point : points) point = 1.5 * random.in_unit_ball();
    std::size_t i = 0;
    for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(grid.lower_bound(points[i++ % points.size()]));
}
BENCHMARK(distance_lower_bound)->ArgName("triangles")->Arg(20'000)->Arg(1'300'000);

void build_distance_field(benchmark::State& state) {
    const TriangleMesh& mesh = ground(static_cast<std::size_t>(state.range(0))).mesh;
    Box3 box;
    for (const Vec3& v : mesh.vertices) box.include(v);
    for ([[maybe_unused]] auto _ : state) {
        const DistanceField grid(mesh.vertices, mesh.triangles, box);
        benchmark::DoNotOptimize(grid.memory_bytes());
    }
}
BENCHMARK(build_distance_field)
    ->ArgName("triangles")
    ->Arg(20'000)
    ->Arg(1'300'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void build(benchmark::State& state) {
    const TriangleMesh& mesh = ground(static_cast<std::size_t>(state.range(0))).mesh;
    for ([[maybe_unused]] auto _ : state) {
        const TriangleBvh bvh(mesh.vertices, mesh.triangles, 0.0);
        benchmark::DoNotOptimize(bvh.memory_bytes());
    }
}
BENCHMARK(build)->ArgName("triangles")->Arg(20'000)->Arg(1'300'000)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace ricochet
