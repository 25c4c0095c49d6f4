#include "ricochet/dynamics/emitter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "dynamics/chi_square.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/verify/parity.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::chi_square;
using test::chi_square_limit;

constexpr double kPi = 3.14159265358979323846;
constexpr std::uint64_t kSamples = test::kSanitized ? 4000 : 40000;

std::vector<LaunchPoint> samples(const EmitterShape& shape, std::uint64_t count = kSamples) {
    const ShapeSampler sampler(shape);
    std::vector<LaunchPoint> places;
    for (std::uint64_t k = 0; k < count; ++k) {
        RandomSequence random(3, 1, k);
        places.push_back(sampler.draw(0.0, random));
    }
    return places;
}

// Compares chi-square over equally likely bins with the value exceeded with probability 1e-6. The seed is fixed.
void expect_uniform(const std::vector<LaunchPoint>& places, std::size_t bins,
                    const std::function<double(const LaunchPoint&)>& fraction) {
    std::vector<double> observed(bins, 0.0);
    for (const LaunchPoint& place : places) {
        const double f = fraction(place);
        ASSERT_GE(f, 0.0);
        ASSERT_LE(f, 1.0 + 1e-12);
        observed[std::min(bins - 1, static_cast<std::size_t>(f * static_cast<double>(bins)))] += 1.0;
    }
    const std::vector<double> expected(bins, static_cast<double>(places.size()) / static_cast<double>(bins));
    EXPECT_LT(chi_square(observed, expected), chi_square_limit(bins - 1));
}

std::shared_ptr<const TriangleMesh> shared(TriangleMesh mesh) {
    return std::make_shared<const TriangleMesh>(std::move(mesh));
}

std::string refusal(const EmitterShape& shape) {
    try {
        const ShapeSampler sampler(shape);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(EmitterShape, AConeIsFilledUniformlyAndLaunchesAwayFromItsTip) {
    const ConeShape cone{{1, 2, 3}, {0, 3, 0}, 30.0, 2.0};
    const auto places = samples(cone);
    const double slope = std::tan(kPi / 6.0);
    for (const LaunchPoint& place : places) {
        ASSERT_NEAR(length(place.direction), 1.0, 1e-14);
        const Vec3 r = place.position - cone.apex;
        ASSERT_NEAR(length(cross(r, place.direction)), 0.0, 1e-14);
        ASSERT_LE(std::hypot(r.x, r.z), r.y * slope * (1.0 + 1e-12));
    }
    expect_uniform(places, 40, [](const LaunchPoint& p) { return std::pow((p.position.y - 2.0) / 2.0, 3.0); });
    expect_uniform(places, 40, [&](const LaunchPoint& p) {
        const Vec3 r = p.position - cone.apex;
        return (r.x * r.x + r.z * r.z) / (r.y * r.y * slope * slope);
    });
    expect_uniform(places, 40, [](const LaunchPoint& p) {
        return (std::atan2(p.position.x - 1.0, p.position.z - 3.0) + kPi) / (2.0 * kPi);
    });
}

TEST(EmitterShape, AConeWithoutAnAngleIsALine) {
    for (const LaunchPoint& place : samples(ConeShape{{}, {0, 0, 1}, 0.0, 1.0}, 100)) {
        EXPECT_EQ(place.position.x, 0.0);
        EXPECT_EQ(place.direction, (Vec3{0, 0, 1}));
    }
}

TEST(EmitterShape, AMeshVolumeIsFilledUniformly) {
    const Vec3 lower{-1, 0, 2};
    const Vec3 upper{1, 3, 2.5};
    const auto places = samples(MeshVolumeShape{shared(testing::box_mesh(lower, upper))});
    for (int axis = 0; axis < 3; ++axis) {
        expect_uniform(places, 40, [&](const LaunchPoint& p) {
            return (p.position[axis] - lower[axis]) / (upper[axis] - lower[axis]);
        });
    }
    expect_uniform(places, 40, [](const LaunchPoint& p) { return 0.5 * (1.0 + p.direction.z); });
}

// Some programs write separate vertices for both sides of a seam. The mesh also has a repeated face.
TEST(EmitterShape, AMeshVolumeWithSeamsAndARepeatedFaceIsFilledLikeTheClosedMesh) {
    const TriangleMesh box = testing::box_mesh({-1, 0, 2}, {1, 3, 2.5});
    TriangleMesh seamed;
    for (const Triangle& t : box.triangles) {
        const auto first = static_cast<std::uint32_t>(seamed.vertices.size());
        for (const std::uint32_t v : t) seamed.vertices.push_back(box.vertices[v]);
        seamed.triangles.push_back({first, first + 1, first + 2});
    }
    seamed.triangles.push_back(seamed.triangles[4]);
    const auto places = samples(MeshVolumeShape{shared(seamed)});
    const auto expected = samples(MeshVolumeShape{shared(box)});
    ASSERT_EQ(places.size(), expected.size());
    for (std::size_t k = 0; k < places.size(); ++k) ASSERT_EQ(places[k].position, expected[k].position);
}

TEST(EmitterShape, ABallWithAHoleIsFilledByVolumeAndTheHoleStaysEmpty) {
    const TriangleMesh shell =
        testing::merged(testing::sphere_mesh({}, 2.0, 3), testing::flipped(testing::sphere_mesh({}, 1.0, 3)));
    const double outer = signed_volume(testing::sphere_mesh({}, 2.0, 3));
    const double inner = signed_volume(testing::sphere_mesh({}, 1.0, 3));
    const ParityOracle oracle(shell);
    const auto places = samples(MeshVolumeShape{shared(shell)});
    const ParityOracle middle(testing::sphere_mesh({}, 1.5, 3));
    const double expected = (signed_volume(testing::sphere_mesh({}, 1.5, 3)) - inner) / (outer - inner);
    double within = 0.0;
    for (const LaunchPoint& place : places) {
        ASSERT_TRUE(oracle.inside(place.position));
        within += middle.inside(place.position) ? 1.0 : 0.0;
    }
    const auto n = static_cast<double>(places.size());
    EXPECT_NEAR(within / n, expected, 5.0 * std::sqrt(expected * (1.0 - expected) / n));  // five sigma
}

TEST(EmitterShape, AMeshSurfaceIsCoveredByArea) {
    const auto mesh = shared(read_mesh(std::string(RICOCHET_SOURCE_DIR) + "/meshes/box.obj").mesh);
    // The box is long and thin, so its triangles have very different areas.
    TriangleMesh stretched = *mesh;
    for (Vec3& v : stretched.vertices) v = {v.x * 10.0, v.y, v.z * 0.2};
    const auto places = samples(MeshSurfaceShape{shared(stretched)});
    std::vector<double> expected;
    std::vector<double> observed(stretched.triangles.size(), 0.0);
    double total = 0.0;
    for (const Triangle& t : stretched.triangles) {
        expected.push_back(0.5 * length(cross(stretched.vertices[t[1]] - stretched.vertices[t[0]],
                                              stretched.vertices[t[2]] - stretched.vertices[t[0]])));
        total += expected.back();
    }
    for (double& e : expected) e *= static_cast<double>(places.size()) / total;
    for (const LaunchPoint& place : places) {
        std::size_t best = 0;
        double nearest = 1e9;
        for (std::size_t k = 0; k < stretched.triangles.size(); ++k) {
            const Triangle& t = stretched.triangles[k];
            const Vec3 a = stretched.vertices[t[0]];
            const Vec3 b = stretched.vertices[t[1]];
            const Vec3 c = stretched.vertices[t[2]];
            const Vec3 n = normalized(cross(b - a, c - a));
            const auto left_of = [&](const Vec3& p, const Vec3& q) { return dot(cross(q - p, place.position - p), n); };
            const double out =
                std::max({std::fabs(dot(place.position - a, n)), -left_of(a, b), -left_of(b, c), -left_of(c, a)});
            if (out < nearest) best = k;
            nearest = std::min(nearest, out);
        }
        observed[best] += 1.0;
    }
    EXPECT_LT(chi_square(observed, expected), chi_square_limit(expected.size() - 1));
}

TEST(EmitterShape, MeshesWithoutAnInteriorAreRefused) {
    TriangleMesh open = testing::box_mesh({}, {1, 1, 1});
    open.triangles.pop_back();
    EXPECT_NE(refusal(MeshVolumeShape{shared(open)}).find("not closed"), std::string::npos);
    EXPECT_NE(refusal(MeshVolumeShape{nullptr}).find("null pointer"), std::string::npos);
    // The same box twice, the second time cut along the other diagonals: closed, but every point is within two shells.
    TriangleMesh twice = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    const std::vector<Triangle> sides = twice.triangles;
    for (std::size_t t = 0; t + 1 < sides.size(); t += 2) {
        const Triangle& first = sides[t];
        const Triangle& second = sides[t + 1];
        const auto is_in = [](const Triangle& triangle, std::uint32_t v) {
            return std::find(triangle.begin(), triangle.end(), v) != triangle.end();
        };
        std::size_t alone = 0;  // corner of the first that the second has not
        while (is_in(second, first[alone])) ++alone;
        std::size_t across = 0;
        while (is_in(first, second[across])) ++across;
        twice.triangles.push_back({first[alone], first[(alone + 1) % 3], second[across]});
        twice.triangles.push_back({first[alone], second[across], first[(alone + 2) % 3]});
    }
    EXPECT_NE(refusal(MeshVolumeShape{shared(twice)}).find("encloses no volume"), std::string::npos);
    EXPECT_NE(refusal(ConeShape{{}, {}, 20.0, 1.0}).find("axis"), std::string::npos);
    EXPECT_NE(refusal(ConeShape{{}, {0, 0, 1}, 90.0, 1.0}).find("angle"), std::string::npos);
    EXPECT_NE(refusal(ConeShape{{}, {0, 0, 1}, 20.0, 0.0}).find("height"), std::string::npos);
    EXPECT_EQ(refusal(ConeShape{{}, {0, 0, 1}, 20.0, 1.0}), "");
}

// For a camera at distance 10 with 90 degrees and 200 pixels, one metre is ten pixels.
TEST(ScreenArea, IsTheProjectedAreaInPixels) {
    const ReferenceCamera camera{{0, 0, 10}, {0, 0, 0}, 90.0, 200.0};
    EXPECT_NEAR(screen_area(DiskShape{{}, {0, 0, 1}, 2.0}, camera), kPi * 400.0, 1.0);
    EXPECT_NEAR(screen_area(DiskShape{{}, {1, 0, 0}, 2.0}, camera), 0.0, 1e-9);
    EXPECT_NEAR(screen_area(BoxShape{{}, {3, 2, 0}}, camera), 600.0, 1e-9);
    EXPECT_NEAR(screen_area(BoxShape{{0, 0, -10}, {3, 2, 0}}, camera), 150.0, 1e-9);
    EXPECT_EQ(screen_area(PointShape{}, camera), 0.0);
    // The outline of a ball on the axis appears at the tangent of asin(r / d).
    const double tangent = 2.0 / std::sqrt(96.0);
    EXPECT_NEAR(screen_area(SphereShape{{}, 2.0, false}, camera), kPi * 1e4 * tangent * tangent, 1.5);
    EXPECT_NEAR(screen_area(MeshVolumeShape{shared(testing::box_mesh({-1, -1, -1}, {1, 1, 0}))}, camera), 400.0, 1e-9);
    EXPECT_NEAR(screen_area(ConeShape{{0, 0, 0}, {0, 0, -1}, 45.0, 1.0}, camera), kPi * 1e4 / 121.0, 0.5);
}

TEST(ScreenArea, ShapesBesideOrBehindTheCameraAreRefused) {
    const ReferenceCamera camera{{0, 0, 0}, {0, 0, -1}, 35.0, 720.0};
    EXPECT_THROW((void)screen_area(BoxShape{{0, 0, 1}, {1, 1, 4}}, camera), InputError);
    EXPECT_THROW((void)screen_area(SphereShape{{0, 0, -1}, 2.0, false}, camera), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
