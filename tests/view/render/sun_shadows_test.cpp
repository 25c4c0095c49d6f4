#include "view/render/sun_shadows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

bool stands_before(const DrawnSpheres& spheres, const Vec3& point, const Vec3& to_light) {
    for (std::size_t i = 0; i < spheres.centers.size(); ++i) {
        const Vec3 away = spheres.centers[i] - point;
        const double middle = dot(away, to_light);
        const double under = spheres.radii[i] * spheres.radii[i] - length_squared(away - middle * to_light);
        if (under >= 0.0 && middle + std::sqrt(under) > 0.0) return true;
    }
    return false;
}

DrawnSpheres cloud(std::uint64_t seed, int count, double largest) {
    RandomSequence draws(seed, 0, 0);
    DrawnSpheres spheres;
    for (int i = 0; i < count; ++i) {
        spheres.centers.push_back(Vec3{100, -20, 3} + 4.0 * draws.in_unit_ball());
        spheres.radii.push_back(largest * (0.05 + draws.uniform()));
    }
    return spheres;
}

TEST(SunShadows, CoverEveryPointInTheShadowOfASphere) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        DrawnSpheres spheres = cloud(seed, 400, 0.15);
        if (seed == 3) spheres.radii[7] = 2.0;  // a sphere over thousands of cells
        RandomSequence draws(seed, 1, 0);
        const Vec3 to_light = draws.unit_vector();
        const SunShadows shadows(spheres, to_light);
        int dark = 0;
        for (int k = 0; k < 5000; ++k) {
            const Vec3 point = Vec3{100, -20, 3} + 5.0 * draws.in_unit_ball();
            const bool expected = stands_before(spheres, point, to_light);
            EXPECT_EQ(shadows.is_shadowed(point), expected) << "seed " << seed << ", point " << k;
            dark += expected ? 1 : 0;
        }
        EXPECT_GT(dark, 300);
        EXPECT_LT(dark, 4900);
    }
}

// Uses directions around the light's direction, on all sides of it, and directions along the axes of the grid.
TEST(SunShadows, CoverEveryPointInTheShadowAlongASlantedRay) {
    for (const std::uint64_t seed : {4U, 5U}) {
        DrawnSpheres spheres = cloud(seed, 400, 0.15);
        if (seed == 5) spheres.radii[7] = 2.0;
        RandomSequence draws(seed, 1, 0);
        const Vec3 to_light = draws.unit_vector();
        const SunShadows shadows(spheres, to_light);
        const auto [across, along] = tangent_frame(to_light);
        int dark = 0;
        for (int k = 0; k < 5000; ++k) {
            const Vec3 point = Vec3{100, -20, 3} + 5.0 * draws.in_unit_ball();
            const double u = k % 3 == 1 ? 0.0 : 0.6 * draws.uniform() - 0.3;
            const double v = k % 3 == 2 ? 0.0 : 0.6 * draws.uniform() - 0.3;
            const Vec3 direction = normalized(to_light + u * across + v * along);
            const bool expected = stands_before(spheres, point, direction);
            EXPECT_EQ(shadows.is_shadowed(point, direction), expected) << "seed " << seed << ", point " << k;
            dark += expected ? 1 : 0;
        }
        EXPECT_GT(dark, 300);
        EXPECT_LT(dark, 4900);
    }
    EXPECT_FALSE(SunShadows({}, {0, 0, 1}).is_shadowed({0, 0, 0}, {0, 0, 1}));
}

// Lengths range from dust to distances between planets. The slanted ray gives the position of a sphere's shadow on a
// plane.
TEST(SunShadows, SlantedRaysDoNotDependOnTheUnitOfLength) {
    for (const double unit : {1e-9, 1.0, 1e13}) {
        const DrawnSpheres pair{{{0, 0, 10.0 * unit}, {20.0 * unit, 0, 0}}, {unit, unit}, {}, {}};
        const SunShadows shadows(pair, {0, 0, 1});
        const Vec3 direction = normalized(Vec3{0.2, 0.1, 1});
        EXPECT_TRUE(shadows.is_shadowed(unit * Vec3{-2, -1, 0}, direction)) << unit;
        EXPECT_FALSE(shadows.is_shadowed({}, direction)) << unit;
        EXPECT_TRUE(shadows.is_shadowed(unit * Vec3{20, 0, -5}, {0, 0, 1})) << unit;
    }
}

TEST(SunShadows, GridsPayForNarrowLightsAndThinClouds) {
    const SunShadows thin(cloud(6, 400, 0.05), {0, 0, 1});
    EXPECT_TRUE(thin.is_faster_than_rays(0.02));
    EXPECT_FALSE(thin.is_faster_than_rays(10.0));
    DrawnSpheres pile;
    for (int i = 0; i < 1000; ++i) {
        pile.centers.push_back({0.0, 0.0, 0.1 * i});
        pile.radii.push_back(0.05);
    }
    EXPECT_FALSE(SunShadows(pile, {0, 0, 1}).is_faster_than_rays(0.0));
    EXPECT_TRUE(SunShadows(pile, {0, 0, 1}).is_faster_than_rays()) << "looked at from the top";
}

TEST(SunShadows, GridsDoNotPayIfAnOutlierStretchesThem) {
    DrawnSpheres spheres = cloud(7, 4000, 0.15);
    EXPECT_TRUE(SunShadows(spheres, {0, 0, 1}).is_faster_than_rays());
    spheres.centers[0] = {1e6, 0, 0};
    EXPECT_FALSE(SunShadows(spheres, {0, 0, 1}).is_faster_than_rays());
}

TEST(SunShadows, PointOfASphereThatFacesTheLightIsLit) {
    const DrawnSpheres one{{{1, 2, 3}}, {0.5}, {}, {}};
    const Vec3 to_light = normalized(Vec3{1, 1, 2});
    const SunShadows shadows(one, to_light);
    EXPECT_FALSE(shadows.is_shadowed(one.centers[0] + (0.5 + 1e-9) * to_light));
    EXPECT_TRUE(shadows.is_shadowed(one.centers[0] + (0.5 - 1e-9) * to_light)) << "from inside";
    EXPECT_TRUE(shadows.is_shadowed(one.centers[0] - 0.6 * to_light));
}

TEST(SunShadows, NoSpheresCastNoShadow) { EXPECT_FALSE(SunShadows({}, {0, 0, 1}).is_shadowed({0, 0, 0})); }

TEST(SunShadows, SpheresOnOneLineAndFarApartAreFound) {
    DrawnSpheres row;
    for (int i = 0; i < 50; ++i) {
        row.centers.push_back({1e4 * i, 0, 10});
        row.radii.push_back(0.01);
    }
    const SunShadows shadows(row, {0, 0, 1});
    for (int i = 0; i < 50; ++i) {
        EXPECT_TRUE(shadows.is_shadowed({1e4 * i + 0.005, 0, 0}));
        EXPECT_FALSE(shadows.is_shadowed({1e4 * i + 0.02, 0, 0}));
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
