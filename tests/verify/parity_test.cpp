#include "ricochet/verify/parity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>
#include <string>

#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "support/counts.h"
#include "support/exact_oracle.h"
#include "support/shared_meshes.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

/// Returns the winding number of the mesh around p: the sum of the solid angles over 4 pi.
/// Method: A. van Oosterom, J. Strackee, IEEE Trans. Biomed. Eng. 30, 1983.
double winding_number(const TriangleMesh& mesh, const Vec3& p) {
    double angles = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p, c = mesh.vertices[t[2]] - p;
        const double la = length(a), lb = length(b), lc = length(c);
        angles += std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return angles / (2.0 * std::numbers::pi);
}

Vec3 point_in(const Box3& box, RandomSequence& random) {
    const Vec3 size = box.size();
    const double x = random.uniform(), y = random.uniform();
    return box.lower + Vec3{size.x * x, size.y * y, size.z * random.uniform()};
}

Box3 widened(const Box3& box) { return {box.lower - 0.1 * box.size(), box.upper + 0.1 * box.size()}; }

/// Compares with the winding number wherever that is clear of rounding, which is nearly everywhere.
void expect_parity_of_winding(const TriangleMesh& mesh, int count) {
    const ParityOracle oracle(mesh);
    RandomSequence random(2718, 0, mesh.triangles.size());
    const Box3 box = widened(bounds(mesh));
    int compared = 0;
    for (int i = 0; i < count; ++i) {
        const Vec3 p = point_in(box, random);
        const double winding = winding_number(mesh, p);
        const double nearest = std::round(winding);
        if (std::fabs(winding - nearest) > 1e-6) continue;
        ++compared;
        ASSERT_EQ(oracle.inside(p), std::fmod(std::fabs(nearest), 2.0) == 1.0)
            << "point " << i << ": " << p.x << " " << p.y << " " << p.z << ", winding number " << winding;
    }
    EXPECT_GT(compared, count * 9 / 10);
}

TEST(ParityOracle, CubeIsDecidedInsideOutsideAndOnTheSurface) {
    const ParityOracle cube(box_mesh({0, 0, 0}, {4, 4, 4}));
    // With integer coordinates, rays often pass through edges, diagonals and vertices.
    for (int x = -1; x <= 5; ++x) {
        for (int y = -1; y <= 5; ++y) {
            for (int z = -1; z <= 5; ++z) {
                const auto within = [](int v, int lower, int upper) { return v >= lower && v <= upper; };
                const bool closed = within(x, 0, 4) && within(y, 0, 4) && within(z, 0, 4);
                const bool open = within(x, 1, 3) && within(y, 1, 3) && within(z, 1, 3);
                const Side expected = open ? Side::inside : (closed ? Side::on_surface : Side::outside);
                ASSERT_EQ(cube.side(Vec3(x, y, z)), expected) << x << " " << y << " " << z;
            }
        }
    }
}

TEST(ParityOracle, PointsOneRoundingStepOffTheSurfaceAreSeparated) {
    const Vec3 offset{1e6, -2e6, 3e6};
    const ParityOracle cube(moved(box_mesh({0, 0, 0}, {1, 1, 1}), offset));
    const double top = offset.z + 1.0;
    const Vec3 diagonal = offset + Vec3{0.5, 0.5, 0.0};
    EXPECT_EQ(cube.side({diagonal.x, diagonal.y, std::nextafter(top, 0.0)}), Side::inside);
    EXPECT_EQ(cube.side({diagonal.x, diagonal.y, top}), Side::on_surface);
    EXPECT_EQ(cube.side({diagonal.x, diagonal.y, std::nextafter(top, 1e9)}), Side::outside);
    EXPECT_EQ(cube.side({std::nextafter(offset.x, 1e9), offset.y + 0.25, offset.z + 0.25}), Side::inside);
    EXPECT_EQ(cube.side({std::nextafter(offset.x, 0.0), offset.y + 0.25, offset.z + 0.25}), Side::outside);
}

TEST(ParityOracle, RaysThroughVerticesAndEdgesGiveTheRightSide) {
    const TriangleMesh sphere = sphere_mesh({0.1, 0.2, 0.3}, 1.0, 3);
    const ParityOracle oracle(sphere);
    for (const Triangle& t : sphere.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& a = sphere.vertices[t[i]];
            const Vec3& b = sphere.vertices[t[(i + 1) % 3]];
            ASSERT_EQ(oracle.side(a), Side::on_surface);
            for (int axis = 0; axis < 3; ++axis) {
                // The first point is on the axis-parallel line through a vertex, the second nearly on the line through
                // an edge's middle.
                Vec3 under_vertex = a;
                under_vertex[axis] = 0.3;
                Vec3 under_edge = 0.5 * a + 0.5 * b;
                under_edge[axis] = 0.2;
                for (const Vec3& p : {under_vertex, under_edge}) {
                    const double distance = length(p - Vec3{0.1, 0.2, 0.3});
                    if (distance > 0.98 && distance < 1.0001) continue;
                    ASSERT_EQ(oracle.side(p), distance < 1.0 ? Side::inside : Side::outside)
                        << p.x << " " << p.y << " " << p.z;
                }
            }
        }
    }
}

TEST(ParityOracle, SurfacePointsAgreeWithTheExactIntersection) {
    const TriangleMesh sphere = sphere_mesh({0, 0, 0}, 1.0, 2);
    const ParityOracle oracle(sphere);
    RandomSequence random(5, 0, 0);
    int on_surface = 0;
    for (const auto& [a, b, c] : sphere.triangles) {
        const Vec3 &va = sphere.vertices[a], &vb = sphere.vertices[b], &vc = sphere.vertices[c];
        const double u = random.uniform(), v = (1.0 - u) * random.uniform();
        for (const Vec3& p : {va + u * (vb - va) + v * (vc - va), 0.5 * va + 0.5 * vb}) {
            bool touches = false;
            for (const auto& [i, j, k] : sphere.triangles) {
                touches = touches || exact_segment_intersects_triangle(p, p, sphere.vertices[i], sphere.vertices[j],
                                                                       sphere.vertices[k]);
            }
            ASSERT_EQ(oracle.side(p) == Side::on_surface, touches);
            on_surface += touches ? 1 : 0;
        }
    }
    EXPECT_GT(on_surface, 0);
}

TEST(ParityOracle, NestedShellsAreCountedByParity) {
    TriangleMesh shells = sphere_mesh({0, 0, 0}, 3.0, 3);
    shells = merged(shells, flipped(sphere_mesh({0, 0, 0}, 2.0, 3)));
    shells = merged(shells, box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
    const ParityOracle oracle(shells);
    EXPECT_EQ(oracle.side({0, 0, 0}), Side::inside);
    EXPECT_EQ(oracle.side({1, 0, 0}), Side::outside);
    EXPECT_EQ(oracle.side({0, 2.5, 0}), Side::inside);
    EXPECT_EQ(oracle.side({0, 2.5, 2.5}), Side::outside);
    expect_parity_of_winding(shells, test::scaled(2000));
}

TEST(ParityOracle, ResultMatchesTheWindingNumberOfOverlappingSpheresFarFromTheOrigin) {
    TriangleMesh spheres;
    RandomSequence random(6, 0, 0);
    for (int i = 0; i < 5; ++i) {
        const Vec3 center = random.in_unit_ball();
        spheres = merged(spheres, sphere_mesh(center, random.uniform_around(0.6, 0.3), 2));
    }
    expect_parity_of_winding(spheres, test::scaled(5000));
    expect_parity_of_winding(moved(spheres, {1e3, -1e3, 1e3}), test::scaled(5000));
    expect_parity_of_winding(moved(spheres, {1e6, 1e6, -1e6}), test::scaled(5000));
}

TEST(ParityOracle, ResultIsTheSameAlongEveryAxis) {
    // The ray runs along the shortest side of the box. Three flattened boxes select each axis in turn.
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 upper{3, 3, 3};
        upper[axis] = 1;
        TriangleMesh mesh = merged(box_mesh({0, 0, 0}, upper), flipped(box_mesh(0.25 * upper, 0.5 * upper)));
        expect_parity_of_winding(mesh, test::scaled(1000));
        const ParityOracle oracle(mesh);
        EXPECT_EQ(oracle.side(0.25 * upper), Side::on_surface);
        EXPECT_EQ(oracle.side(0.375 * upper), Side::outside);
        EXPECT_EQ(oracle.side(0.75 * upper), Side::inside);
    }
}

TEST(ParityOracle, AcceptsDegenerateAndDuplicateTriangles) {
    TriangleMesh mesh = box_mesh({0, 0, 0}, {2, 2, 2});
    mesh.triangles.push_back({0, 0, 7});  // a segment across the inside, no surface
    const TriangleMesh flap{{{5, 0, 0}, {5, 1, 0}, {5, 0, 1}}, {{0, 1, 2}, {0, 1, 2}}};
    const ParityOracle oracle(merged(mesh, flap));
    EXPECT_EQ(oracle.side({1, 1, 1}), Side::inside);
    EXPECT_EQ(oracle.side({1, 1, 0.5}), Side::inside);
    EXPECT_EQ(oracle.side({5, 0.25, 0.25}), Side::on_surface);
    EXPECT_EQ(oracle.side({4.5, 0.25, 0.25}), Side::outside);
}

TEST(ParityOracle, OpenMeshIsRefusedAndInvalidPointsAreOutside) {
    TriangleMesh open = box_mesh({0, 0, 0}, {1, 1, 1});
    open.triangles.pop_back();
    EXPECT_EQ(count_open_edges(open), 3U);
    EXPECT_THROW(ParityOracle{open}, std::invalid_argument);
    EXPECT_EQ(ParityOracle(TriangleMesh{}).side({0, 0, 0}), Side::outside);
    const double nan = std::nan("");
    EXPECT_EQ(ParityOracle(box_mesh({0, 0, 0}, {1, 1, 1})).side({nan, 0.5, 0.5}), Side::outside);
}

class RealMesh : public ::testing::TestWithParam<const char*> {};

TEST_P(RealMesh, ParityMatchesTheWindingNumberNearAndFarAway) {
    RICOCHET_SHARED_MESH_OR_SKIP(path, GetParam());
    const TriangleMesh mesh = read_mesh(path).mesh;
    expect_parity_of_winding(mesh, 40);
    const double far = 1000.0 * bounds(mesh).diagonal();
    expect_parity_of_winding(moved(mesh, {far, -far, far}), 40);
}

TEST_P(RealMesh, VerticesAreOnTheSurfaceAndTheVolumeIsInside) {
    RICOCHET_SHARED_MESH_OR_SKIP(path, GetParam());
    const TriangleMesh mesh = read_mesh(path).mesh;
    const ParityOracle oracle(mesh);
    for (const Triangle& t : mesh.triangles) ASSERT_EQ(oracle.side(mesh.vertices[t[0]]), Side::on_surface);
    const Box3 box = bounds(mesh);
    RandomSequence random(31, 0, mesh.triangles.size());
    const int count = test::scaled(100000);
    int inside = 0;
    for (int i = 0; i < count; ++i) inside += oracle.inside(point_in(box, random)) ? 1 : 0;
    const Vec3 size = box.size();
    const double expected = std::fabs(signed_volume(mesh)) / (size.x * size.y * size.z);
    // The tolerance is four standard errors of a count of independent points.
    EXPECT_NEAR(inside / static_cast<double>(count), expected, 4.0 * std::sqrt(expected * (1.0 - expected) / count));
}

// These meshes are closed and free of self-intersections, so that volume and parity agree.
INSTANTIATE_TEST_SUITE_P(Closed, RealMesh,
                         ::testing::Values("bunny-closed.off", "armadillo.obj", "spot.obj", "fandisk.obj",
                                           "quadknot.obj", "ADIS16480.stl"),
                         [](const auto& name) {
                             return std::filesystem::path(name.param).stem().string().substr(0, 5);
                         });

TEST(ParityOracle, RefusesOpenRealMeshes) {
    for (const char* name : {"stanford-bunny.obj", "teapot.obj", "suzanne.obj"}) {
        RICOCHET_SHARED_MESH_OR_SKIP(path, name);
        EXPECT_THROW(ParityOracle{read_mesh(path).mesh}, std::invalid_argument) << name;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
