// Closed forms for sizes and volumes, and the documented properties of each shape.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "generators/build_near.h"
#include "generators/drum.h"
#include "generators/fish.h"
#include "generators/galton_board.h"
#include "generators/gear.h"
#include "generators/icosphere.h"
#include "generators/primitives.h"
#include "generators/rock.h"
#include "generators/terrain.h"
#include "generators/torus_knot.h"
#include "generators/vessels.h"
#include "ricochet/core/error.h"

namespace ricochet::meshes {
namespace RICOCHET_FILE {

constexpr double kPi = std::numbers::pi;

void expect_size(const TriangleMesh& mesh, const Vec3& size, double tolerance) {
    const Vec3 actual = bounds(mesh).size();
    EXPECT_NEAR(actual.x, size.x, tolerance);
    EXPECT_NEAR(actual.y, size.y, tolerance);
    EXPECT_NEAR(actual.z, size.z, tolerance);
}

TEST(Box, HasItsVolumeAndIsCentred) {
    const TriangleMesh mesh = make_box({2.0, 3.0, 0.5}, 0.25);
    EXPECT_NEAR(signed_volume(mesh), 3.0, 1e-12);
    expect_size(mesh, {2.0, 3.0, 0.5}, 0.0);
    EXPECT_EQ(bounds(mesh).center(), Vec3());
    EXPECT_EQ(make_box({}, 2.0).triangles.size(), 12U);
}

TEST(Plate, GoesFromTwoTrianglesToTwoMillion) {
    const ShapeBuilder build = [](double edge) { return make_plate({}, edge); };
    EXPECT_EQ(build_near(2, 1.0, build).triangles.size(), 2U);
    EXPECT_NEAR(static_cast<double>(build_near(2'000'000, 1.0, build).triangles.size()), 2e6, 4e4);
    EXPECT_NEAR(surface_area(make_plate({3.0, 2.0}, 0.1)), 6.0, 1e-12);
}

TEST(Wedge, HasItsVolumeAndItsSharpEdgeOnTheYAxis) {
    const WedgeShape shape{2.0, 0.1, 3.0};
    EXPECT_NEAR(signed_volume(make_wedge(shape, 0.5)), 0.5 * 2.0 * 0.1 * 3.0, 1e-13);
    EXPECT_EQ(bounds(make_wedge(shape, 0.5)).lower, Vec3(0.0, -1.5, -0.05));
}

TEST(Fish, HasTheSameFacesAtAllPhasesAndSwimsOnceInAPeriod) {
    const auto at = [](double phase) { return make_fish({.length = 2.0, .swing = 0.12, .phase = phase}, 0.1); };
    const TriangleMesh begin = at(0.0);
    EXPECT_EQ(at(1.0).vertices, begin.vertices);
    for (const double phase : {0.125, 0.5, 0.7}) {
        EXPECT_EQ(at(phase).triangles, begin.triangles);
        EXPECT_NEAR(signed_volume(at(phase)), signed_volume(begin), 0.04 * signed_volume(begin));
    }
    // After half a period the fish is its mirror image, and its tail is on the other side.
    const TriangleMesh half = at(0.5);
    const Vec3 tail = begin.vertices.back();
    EXPECT_NEAR(half.vertices.back().y, -tail.y, 1e-12);
    EXPECT_NEAR(at(0.75).vertices.back().y, 2.0 * 0.12, 1e-12);
}

TEST(Icosphere, HasTwentyTrianglesPerSquaredDivisionAndAllVerticesOnTheSphere) {
    for (const int divisions : {1, 2, 3, 7, 20}) {
        const TriangleMesh mesh = unit_icosphere(divisions);
        const auto n = static_cast<std::size_t>(divisions);
        EXPECT_EQ(mesh.triangles.size(), 20 * n * n);
        EXPECT_EQ(mesh.vertices.size(), 10 * n * n + 2);
        for (const Vec3& p : mesh.vertices) EXPECT_NEAR(length(p), 1.0, 4e-16);
    }
    EXPECT_NEAR(signed_volume(make_icosphere({2.0}, 0.02)), 4.0 / 3.0 * kPi * 8.0, 5e-3);
}

TEST(Bowl, HasTheVolumeOfAHalfShell) {
    const TriangleMesh mesh = make_bowl({1.0, 0.1, 90.0}, 0.01);
    EXPECT_NEAR(signed_volume(mesh), 2.0 / 3.0 * kPi * (1.331 - 1.0), 1e-4);
    expect_size(mesh, {2.2, 2.2, 1.1}, 1e-4);
}

TEST(Funnel, HasTheVolumeOfItsWall) {
    const FunnelShape shape{1.0, 0.2, 1.5, 0.5, 0.1};
    const auto cone = [](double a, double b, double height) { return kPi * height / 3.0 * (a * a + a * b + b * b); };
    const double wall = cone(1.1, 0.3, 1.5) - cone(1.0, 0.2, 1.5) + cone(0.3, 0.3, 0.5) - cone(0.2, 0.2, 0.5);
    EXPECT_NEAR(signed_volume(make_funnel(shape, 0.01)), wall, 1e-3 * wall);
}

TEST(Funnel, RefusesAThroatWiderThanItsTop) {
    EXPECT_THROW((void)make_funnel({0.1, 0.2, 1.0, 1.0, 0.05}, 0.1), InputError);
}

TEST(Staircase, HasTheVolumeOfItsSteps) {
    const TriangleMesh mesh = make_staircase({5, 0.3, 0.2, 1.5}, 0.07);
    EXPECT_NEAR(signed_volume(mesh), 15.0 * 0.3 * 0.2 * 1.5, 1e-12);
    expect_size(mesh, {1.5, 1.5, 1.0}, 1e-15);
}

// Pappus' theorem: the volume of a tube is its cross-section times the length of its centre line, straight or bent.
TEST(TorusKnot, VolumeIsCrossSectionTimesLength) {
    TorusKnotShape circle;
    circle.p = 1;
    circle.q = 1;
    circle.winding = 1e-6;
    circle.tube_radius = 0.2;
    EXPECT_NEAR(signed_volume(make_torus_knot(circle, 0.01)), 2.0 * kPi * kPi * 0.2 * 0.2, 2e-3);
    EXPECT_NEAR(torus_knot_thickness(circle), 1.0, 1e-3);
}

TEST(TorusKnot, RefusesATubeThatWouldCrossItself) {
    TorusKnotShape shape;
    EXPECT_NEAR(torus_knot_thickness(shape), shape.winding, 1e-3);  // two strands on opposite sides of the torus
    shape.tube_radius = 0.42;
    EXPECT_THROW((void)make_torus_knot(shape, 0.1), InputError);
    shape.tube_radius = 0.1;
    shape.p = 3;
    shape.q = 6;
    EXPECT_THROW((void)make_torus_knot(shape, 0.1), InputError);
}

TEST(Gear, ReachesFromRootToTipAndFillsAboutItsPitchDisk) {
    const GearShape shape{30, 1.0, 0.2, 0.4, 0.0};
    const TriangleMesh mesh = make_gear(shape, 0.02);
    double farthest = 0.0;
    for (const Vec3& p : mesh.vertices) farthest = std::max(farthest, std::hypot(p.x, p.y));
    EXPECT_NEAR(farthest, 1.0 + 2.0 / 30.0, 1e-12);
    // Teeth and gaps are equally wide on the pitch circle. The longer dedendum makes the volume slightly smaller.
    const double disk = kPi * (1.0 - 0.04) * 0.4;
    EXPECT_NEAR(signed_volume(mesh), disk, 0.05 * disk);
    EXPECT_LT(signed_volume(mesh), disk);
}

TEST(Gear, RefusesABoreThatLeavesNoRim) { EXPECT_THROW((void)make_gear({18, 0.9, 0.8, 0.3, 0.2}, 0.1), InputError); }

TEST(GaltonBoard, AllSidesButTheFrontAreParallelToY) {
    const TriangleMesh mesh = make_galton_board({}, 0.4);
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]];
        const Vec3 normal = cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
        const bool faces_y = normal.x == 0.0 && normal.z == 0.0;
        EXPECT_TRUE(faces_y || normal.y == 0.0) << normal.x << ' ' << normal.y << ' ' << normal.z;
    }
}

TEST(GaltonBoard, IsSymmetricInX) {
    const Box3 box = bounds(make_galton_board({}, 0.4));
    EXPECT_DOUBLE_EQ(box.lower.x, -box.upper.x);
    EXPECT_EQ(box.lower.z, 0.0);
    EXPECT_GT(box.upper.z, galton_board_entry({}));
}

TEST(Drum, LiftersTakeVolumeFromTheCavity) {
    const DrumShape shape{1.0, 2.0, 0.1, 8, 0.2, 0.0};
    const double barrel = kPi * (1.21 - 1.0) * 2.0 + 2.0 * kPi * 1.21 * 0.1;
    const double steel = signed_volume(make_drum(shape, 0.02));
    EXPECT_GT(steel, barrel);
    EXPECT_LT(steel, barrel + 0.3 * kPi * (1.0 - 0.64) * 2.0);
}

TEST(Rock, StaysInsideItsStretchedBallAndChangesWithTheSeed) {
    RockShape shape;
    shape.roughness = 0.0;
    const TriangleMesh smooth = make_rock(shape, 0.1);
    const Vec3 size = bounds(smooth).size();
    EXPECT_LE(size.x, 2.5);
    EXPECT_LE(size.y, 2.0);
    EXPECT_LE(size.z, 1.6);
    shape.seed = 2;
    EXPECT_NE(make_rock(shape, 0.1).vertices, smooth.vertices);
}

TEST(Rock, WithoutCutsAndRoughnessIsAnEllipsoid) {
    RockShape shape;
    shape.cuts = 0;
    shape.roughness = 0.0;
    const double volume = 4.0 / 3.0 * kPi * 1.25 * 1.0 * 0.8;
    EXPECT_NEAR(signed_volume(make_rock(shape, 0.02)), volume, 1e-3 * volume);
}

TEST(Cavity, LeavesItsCentreFree) {
    CavityShape shape;
    shape.roughness = 0.8;
    for (shape.seed = 1; shape.seed <= 5; ++shape.seed) {
        for (const Vec3& p : make_cavity(shape, 0.1).vertices) EXPECT_GE(length(p), 0.0499);
    }
}

TEST(Terrain, HasUpwardNormalsAndItsVerticesAtTerrainHeight) {
    const TerrainShape shape;
    const TriangleMesh mesh = make_terrain(shape, 2.0);
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]];
        EXPECT_GT(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a).z, 0.0);
    }
    for (const Vec3& p : mesh.vertices) EXPECT_EQ(p.z, terrain_height(shape, p.x, p.y));
}

TEST(Terrain, FallsByItsDropFromTopToFoot) {
    TerrainShape shape;
    shape.gully_depth = 0.0;
    shape.relief = 0.0;
    shape.roughness = 0.0;
    for (const double y : {-30.0, 0.0, 45.0}) {
        EXPECT_NEAR(terrain_height(shape, 0.0, y) - terrain_height(shape, shape.length, y), shape.drop, 1e-9);
    }
}

TEST(Shapes, ParametersOutOfRangeAreRefusedByTheirOptionName) {
    try {
        (void)make_rock({-1.0}, 0.1);
        FAIL() << "a negative radius was accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("rock: --radius must be between"), std::string::npos) << error.what();
    }
    EXPECT_THROW((void)make_box({0.0, 1.0, 1.0}, 0.1), InputError);
    EXPECT_THROW((void)make_bowl({1.0, 0.1, std::nan("")}, 0.1), InputError);
    EXPECT_THROW((void)make_terrain({-120.0}, 1.0), InputError);
    EXPECT_THROW((void)build_near(1, 1.0, [](double edge) { return make_plate({}, edge); }), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::meshes
