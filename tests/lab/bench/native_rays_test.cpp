#include "lab/bench/native_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "support/random_draws.h"
#include "support/simple_meshes.h"

namespace ricochet::bench {
namespace RICOCHET_FILE {

// Relative distance, as a fraction of a ray, below which single precision may confuse two hits or a hit on a triangle's
// rim.
constexpr double kDoubt = 1e-4;

std::array<float, 3> floats(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

Vec3 doubles(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

// Returns two balls, one inside the other, so that rays hit several triangles.
TriangleMesh two_balls() {
    return testing::merged(testing::sphere_mesh({}, 1.0, 3), testing::sphere_mesh({0.125, 0, 0}, 0.5, 2));
}

std::vector<RaySegment> random_segments(std::size_t count) {
    RandomSequence random(7, 0, 0);
    std::vector<RaySegment> segments;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 from = 1.5 * random.in_unit_ball();
        segments.push_back({floats(from), floats(testing::scaled({random.unit_vector(), random.uniform() * 2.0}))});
    }
    return segments;
}

// Returns the triangles that a single-precision ray may report as its first hit, from a test of every triangle. They
// include kNoTriangle if the ray may miss.
std::vector<std::uint32_t> first_by_brute_force(const TriangleMesh& mesh, const RaySegment& segment) {
    const Vec3 from = doubles(segment.from);
    const Vec3 along = doubles(segment.along);
    const auto fraction_of = [&](const Triangle& t, double grow) {
        const Vec3 middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
        const auto corner = [&](std::size_t k) { return middle + (1.0 + grow) * (mesh.vertices[t[k]] - middle); };
        const Vec3 normal = cross(corner(1) - corner(0), corner(2) - corner(0));
        const double fraction = dot(corner(0) - from, normal) / dot(along, normal);
        // The segment is extended at both ends if growth is allowed.
        const bool meets = segment_intersects_triangle(from - grow * along, from + (1.0 + grow) * along, corner(0),
                                                       corner(1), corner(2));
        return meets ? fraction : INFINITY;
    };
    double surely = INFINITY;
    for (const Triangle& t : mesh.triangles) surely = std::min(surely, fraction_of(t, -kDoubt));
    std::vector<std::uint32_t> possible;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const double fraction = fraction_of(mesh.triangles[i], kDoubt);
        if (std::isfinite(fraction) && fraction <= surely + kDoubt) possible.push_back(i);
    }
    if (std::isinf(surely)) possible.push_back(kNoTriangle);
    return possible;
}

TEST(NativeRays, HitTheTrianglesThatBruteForceHits) {
    const TriangleMesh mesh = two_balls();
    const NativeRays rays(mesh);
    const std::vector<RaySegment> segments = random_segments(2000);
    std::vector<std::uint32_t> hits(segments.size());
    rays.trace(segments, hits);
    std::size_t clear = 0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const std::vector<std::uint32_t> possible = first_by_brute_force(mesh, segments[i]);
        EXPECT_NE(std::find(possible.begin(), possible.end(), hits[i]), possible.end()) << "segment " << i;
        clear += possible.size() == 1 && hits[i] != kNoTriangle ? 1 : 0;
    }
    EXPECT_GT(clear, segments.size() / 5);
    EXPECT_LT(clear, segments.size());
}

TEST(NativeRays, HitTheSameInPacketsOfAnySize) {
    const NativeRays rays(two_balls());
    for (const std::size_t count : {0U, 1U, 15U, 16U, 17U, 1023U, 2051U}) {
        const std::vector<RaySegment> segments = random_segments(count);
        std::vector<std::uint32_t> single(count);
        std::vector<std::uint32_t> packets(count);
        rays.trace(segments, single);
        rays.trace_packets(segments, packets);
        // A ray through an edge may hit either neighbour.
        std::size_t different = 0;
        for (std::size_t i = 0; i < count; ++i) different += single[i] == packets[i] ? 0 : 1;
        EXPECT_LE(different, count / 1000) << count;
    }
}

double folded(double x) {
    const double u = std::fabs(std::remainder(x + 1.0, 4.0));
    return u - 1.0;
}

TEST(NativeRays, BounceInABoxLikeAFoldedLine) {
    const NativeRays rays(testing::box_mesh({-1, -1, -1}, {1, 1, 1}));
    RandomSequence random(8, 0, 0);
    std::vector<Flight> flights(200);
    for (Flight& flight : flights) flight = {0.9 * random.in_unit_ball(), random.unit_vector()};
    std::vector<Vec3> ends(flights.size());
    const double duration = 7.0;
    const std::uint64_t bounces = rays.bounce(flights, {duration, 1.0}, ends);
    double expected = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const Vec3 line = flights[i].position + duration * flights[i].velocity;
        const Vec3 end{folded(line.x), folded(line.y), folded(line.z)};
        EXPECT_LT(length(ends[i] - end), 1e-4) << i;
        for (int axis = 0; axis < 3; ++axis) expected += std::floor((std::fabs(line[axis]) + 1.0) / 2.0);
    }
    EXPECT_NEAR(static_cast<double>(bounces), expected, 2.0);
}

TEST(NativeRays, LoseSpeedWithRestitution) {
    const NativeRays rays(testing::box_mesh({-1, -1, -1}, {1, 1, 1}));
    const std::vector<Flight> flights = {{{0.1, 0.2, 0.0}, {0.0, 0.0, -1.0}}};
    std::vector<Vec3> ends(1);
    EXPECT_EQ(rays.bounce(flights, {2.0, 0.5}, ends), 1U);
    EXPECT_LT(length(ends[0] - Vec3{0.1, 0.2, -0.5}), 1e-5);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::bench
