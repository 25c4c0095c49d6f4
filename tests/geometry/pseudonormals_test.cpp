#include "ricochet/geometry/mesh/pseudonormals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::box_mesh;
using testing::flipped;
using testing::merged;
using testing::moved;
using testing::sphere_mesh;

constexpr std::array<TriangleFeature, 3> kVertices{TriangleFeature::kVertexA, TriangleFeature::kVertexB,
                                                   TriangleFeature::kVertexC};
constexpr std::array<TriangleFeature, 3> kEdges{TriangleFeature::kEdgeAB, TriangleFeature::kEdgeBC,
                                                TriangleFeature::kEdgeCA};

void expect_near(const Vec3& value, const Vec3& expected) { EXPECT_LE(max_abs(value - expected), 1e-15); }

/// Returns the same triangles, each with three vertices of its own.
TriangleMesh torn(const TriangleMesh& mesh) {
    TriangleMesh apart;
    for (const Triangle& t : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(apart.vertices.size());
        for (const std::uint32_t v : t) apart.vertices.push_back(mesh.vertices[v]);
        apart.triangles.push_back({first, first + 1, first + 2});
    }
    return apart;
}

std::vector<Vec3> all_of(const TriangleMesh& mesh) {
    const Pseudonormals normals(mesh.vertices, mesh.triangles);
    std::vector<Vec3> all;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (normals.is_left_out(t)) continue;
        all.push_back(normals.of(t, TriangleFeature::kFace));
        for (const auto feature : kEdges) all.push_back(normals.of(t, feature));
        for (const auto feature : kVertices) all.push_back(normals.of(t, feature));
    }
    return all;
}

/// Expects the normals of a cube about the origin, for any cut of its squares:
/// - A vertex normal, the mean over three right angles, points along the diagonal.
/// - An edge normal is the mean of the normals of both squares.
/// - The normal of a diagonal is the normal of its square.
void expect_cube(const TriangleMesh& mesh) {
    const Pseudonormals normals(mesh.vertices, mesh.triangles);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& triangle = mesh.triangles[t];
        Vec3 face;
        for (const std::uint32_t v : triangle) face += mesh.vertices[v];
        for (int axis = 0; axis < 3; ++axis) face[axis] = std::fabs(face[axis]) > 2.5 ? face[axis] / 3.0 : 0.0;
        expect_near(normals.of(t, TriangleFeature::kFace), face);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& from = mesh.vertices[triangle[k]];
            const Vec3 middle = 0.5 * (from + mesh.vertices[triangle[(k + 1) % 3]]);
            // 2 on an edge, 1 on a diagonal
            const double faces = std::fabs(middle.x) + std::fabs(middle.y) + std::fabs(middle.z);
            expect_near(normals.of(t, kEdges[k]), middle / faces);
            expect_near(normals.of(t, kVertices[k]), from / 3.0);
            EXPECT_FALSE(normals.is_on_boundary(t, kEdges[k]) || normals.is_on_boundary(t, kVertices[k]));
        }
    }
}

TEST(Pseudonormals, AreMeansOfTheSquareNormalsOnACube) {
    const TriangleMesh cube = box_mesh({-1, -1, -1}, {1, 1, 1});
    expect_cube(cube);
    expect_cube(torn(cube));
    expect_cube(flipped(flipped(cube)));
}

// The cube has edge midpoints as vertices and fans of slender triangles. The angles around a corner still sum to right
// angles.
TEST(Pseudonormals, DoNotDependOnTheTriangulationOfAFace) {
    const TriangleMesh cube = box_mesh({-1, -1, -1}, {1, 1, 1});
    TriangleMesh cut{cube.vertices, {}};
    RandomSequence random(1, 0, 0);
    for (const auto& [a, b, c] : cube.triangles) {
        double u = random.uniform(), v = 1e-3 * random.uniform();
        const auto inner = static_cast<std::uint32_t>(cut.vertices.size());
        Vec3 p = cube.vertices[a] + u * (1.0 - v) * (cube.vertices[b] - cube.vertices[a]) +
                 v * (cube.vertices[c] - cube.vertices[a]);
        for (int axis = 0; axis < 3; ++axis) {  // back into the square's plane
            if (cube.vertices[a][axis] == cube.vertices[b][axis] && cube.vertices[a][axis] == cube.vertices[c][axis])
                p[axis] = cube.vertices[a][axis];
        }
        cut.vertices.push_back(p);
        for (const Triangle& t : {Triangle{a, b, inner}, Triangle{b, c, inner}, Triangle{c, a, inner}})
            cut.triangles.push_back(t);
    }
    const Pseudonormals normals(cut.vertices, cut.triangles);
    for (std::uint32_t t = 0; t < cut.triangles.size(); ++t) {
        expect_near(normals.of(t, TriangleFeature::kVertexA), cut.vertices[cut.triangles[t][0]] / 3.0);
        expect_near(normals.of(t, TriangleFeature::kVertexC), normals.of(t, TriangleFeature::kFace));
    }
}

TEST(Pseudonormals, PointAwayFromTheCentreOfARegularTetrahedron) {
    const TriangleMesh mesh{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                            {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
    for (const TriangleMesh& tetrahedron : {mesh, torn(mesh)}) {
        const Pseudonormals normals(tetrahedron.vertices, tetrahedron.triangles);
        for (std::uint32_t t = 0; t < 4; ++t) {
            const Triangle& triangle = tetrahedron.triangles[t];
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3& from = tetrahedron.vertices[triangle[k]];
                const Vec3& to = tetrahedron.vertices[triangle[(k + 1) % 3]];
                // The faces' normals are inclined to a vertex's axis by arccos(1/3), and to an edge's axis by
                // arccos(1/sqrt 3).
                expect_near(normals.of(t, kVertices[k]), normalized(from) / 3.0);
                expect_near(normals.of(t, kEdges[k]), normalized(from + to) / std::numbers::sqrt3);
            }
        }
    }
}

TEST(Pseudonormals, WeldVerticesOfEqualBits) {
    TriangleMesh mesh = sphere_mesh({}, 1.0, 2);
    for (Vec3& v : mesh.vertices) {
        for (int axis = 0; axis < 3; ++axis) v[axis] = v[axis] == 0.0 ? -0.0 : v[axis];
    }
    TriangleMesh positive = torn(mesh);
    for (std::size_t v = 0; v < positive.vertices.size(); v += 2) positive.vertices[v] += Vec3{};
    EXPECT_EQ(all_of(mesh), all_of(positive));
}

// The reference computes corner angles with the system's arc tangent in long double, and sums them at the tip of a fan.
TEST(Pseudonormals, AreWeightedByTheCornerAngles) {
    RandomSequence random(2, 0, 0);
    for (int i = 0; i < test::scaled(300); ++i) {
        TriangleMesh fan;
        fan.vertices.push_back(random.in_unit_ball());
        std::array<long double, 3> sum{};
        long double weights = 0.0L;
        for (std::uint32_t k = 0; k < 5; ++k) {
            const Vec3 u = random.unit_vector();
            const double opening = k == 0 ? 1e-9 : (k == 1 ? -1.999 : random.uniform());
            const Vec3 v = (k == 2 ? 1e-8 : 3.0) *
                           (u + opening * (k == 1 ? u + 1e-3 * random.unit_vector() : random.unit_vector()));
            fan.vertices.push_back(fan.vertices[0] + u);
            fan.vertices.push_back(fan.vertices[0] + v);
            fan.triangles.push_back({0, 2 * k + 1, 2 * k + 2});
            const Vec3 p = fan.vertices[2 * k + 1] - fan.vertices[0], q = fan.vertices[2 * k + 2] - fan.vertices[0];
            const auto x = [&](const Vec3& a, const Vec3& b, int m, int n) {
                return static_cast<long double>(a[m]) * b[n] - static_cast<long double>(a[n]) * b[m];
            };
            const long double cx = x(p, q, 1, 2), cy = x(p, q, 2, 0), cz = x(p, q, 0, 1);
            const long double along = static_cast<long double>(p.x) * q.x + static_cast<long double>(p.y) * q.y +
                                      static_cast<long double>(p.z) * q.z;
            const long double angle = std::atan2(std::sqrt(cx * cx + cy * cy + cz * cz), along);
            const Vec3 normal = unit_normal(fan.vertices[0], fan.vertices[2 * k + 1], fan.vertices[2 * k + 2]);
            for (int axis = 0; axis < 3; ++axis) sum[static_cast<std::size_t>(axis)] += angle * normal[axis];
            weights += angle;
        }
        const Vec3 expected{static_cast<double>(sum[0] / weights), static_cast<double>(sum[1] / weights),
                            static_cast<double>(sum[2] / weights)};
        expect_near(Pseudonormals(fan.vertices, fan.triangles).of(3, TriangleFeature::kVertexA), expected);
    }
}

TEST(Pseudonormals, ReportTheBoundaryOfASurface) {
    // Two triangles form a square. The diagonal (0, 2) is inside; the four sides and all vertices are on the boundary.
    const TriangleMesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    const Pseudonormals normals(square.vertices, square.triangles);
    EXPECT_TRUE(normals.is_on_boundary(0, TriangleFeature::kEdgeAB));
    EXPECT_TRUE(normals.is_on_boundary(0, TriangleFeature::kEdgeBC));
    EXPECT_FALSE(normals.is_on_boundary(0, TriangleFeature::kEdgeCA));
    EXPECT_FALSE(normals.is_on_boundary(1, TriangleFeature::kEdgeAB));
    EXPECT_FALSE(normals.is_on_boundary(1, TriangleFeature::kFace));
    for (const auto vertex : kVertices) EXPECT_TRUE(normals.is_on_boundary(1, vertex));
    EXPECT_EQ(normals.of(0, TriangleFeature::kEdgeAB), (Vec3{0, 0, 1}));
    // A vertex in the middle of a fan and an edge of four triangles are not on the boundary. An edge of three triangles
    // is.
    const TriangleMesh fan = sphere_mesh({}, 1.0, 0);
    const TriangleMesh half{fan.vertices, {fan.triangles[0], fan.triangles[1], fan.triangles[2], fan.triangles[3]}};
    const Pseudonormals cap(half.vertices, half.triangles);
    EXPECT_FALSE(cap.is_on_boundary(0, TriangleFeature::kVertexC));
    EXPECT_TRUE(cap.is_on_boundary(0, TriangleFeature::kVertexA));
    TriangleMesh fins{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                      {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {1, 0, 5}}};
    EXPECT_FALSE(Pseudonormals(fins.vertices, fins.triangles).is_on_boundary(2, TriangleFeature::kEdgeAB));
    fins.triangles.pop_back();
    EXPECT_TRUE(Pseudonormals(fins.vertices, fins.triangles).is_on_boundary(2, TriangleFeature::kEdgeAB));
}

TEST(Pseudonormals, VanishOnSheetsBackToBack) {
    RandomSequence random(3, 0, 0);
    for (int i = 0; i < test::scaled(100); ++i) {
        TriangleMesh sheet{{random.in_unit_ball(), random.in_unit_ball(), random.in_unit_ball()},
                           {{0, 1, 2}, {2, 1, 0}}};
        for (const Vec3& normal : all_of(sheet)) EXPECT_EQ(normal, Vec3{});
        sheet.triangles = {{0, 1, 2}, {1, 0, 2}, {2, 0, 1}};  // twice with one winding, once with the other
        const Pseudonormals normals(sheet.vertices, sheet.triangles);
        for (std::uint32_t t = 0; t < 3; ++t) {
            for (const auto feature : {TriangleFeature::kFace, TriangleFeature::kEdgeBC, TriangleFeature::kVertexC}) {
                const Vec3 up = unit_normal(sheet.vertices[0], sheet.vertices[1], sheet.vertices[2]);
                EXPECT_NEAR(dot(normals.of(t, feature), up), feature == TriangleFeature::kFace ? 1.0 : 1.0 / 3.0,
                            1e-12);
            }
        }
    }
}

TEST(Pseudonormals, IgnoreTrianglesWithoutArea) {
    const TriangleMesh cube = box_mesh({-1, -1, -1}, {1, 1, 1});
    TriangleMesh with = cube;
    with.vertices.push_back({0, -1, -1});  // on the edge (0, 1)
    with.triangles.insert(with.triangles.begin(), {{0, 0, 7}, {0, 8, 1}, {3, 3, 3}});
    EXPECT_EQ(all_of(with), all_of(cube));
    const Pseudonormals normals(with.vertices, with.triangles);
    EXPECT_TRUE(normals.is_left_out(0) && normals.is_left_out(1) && normals.is_left_out(2));
    EXPECT_FALSE(normals.is_left_out(3));
    EXPECT_TRUE(all_of({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}).empty());
    EXPECT_TRUE(all_of({}).empty());
}

TEST(Pseudonormals, KeepTheirDirectionsAtAnyScale) {
    const TriangleMesh sphere = sphere_mesh({}, 1.0, 2);
    const auto expected = all_of(sphere);
    for (const double scale : {0x1p-280, 0x1p-100, 0x1p100, 0x1p248}) {
        TriangleMesh scaled = sphere;
        for (Vec3& v : scaled.vertices) v *= scale;
        EXPECT_EQ(all_of(scaled), expected) << scale;
    }
}

TEST(Pseudonormals, UseAboutThirtyBytesPerTriangle) {
    const TriangleMesh sphere = sphere_mesh({}, 1.0, 5);
    const Pseudonormals normals(sphere.vertices, sphere.triangles);
    EXPECT_LT(normals.memory_bytes(), 36 * sphere.triangles.size());
}

/// Returns a wedge with its edge along y at the origin and an opening angle of about `opening` around +x, cut off at x
/// = 1.
TriangleMesh wedge(double opening) {
    const double h = 0.5 * opening;
    return {{{0, -1, 0}, {0, 1, 0}, {1, -1, -h}, {1, 1, -h}, {1, -1, h}, {1, 1, h}},
            {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}, {2, 3, 5}, {2, 5, 4}, {0, 2, 4}, {1, 5, 3}}};
}

// Tests points all around the edge, down to the smallest distances of doubles. The closest point gives the right side,
// or no side beside very sharp edges.
TEST(Pseudonormals, DecideTheSideNextToSharpEdges) {
    int decided = 0, queries = 0;
    for (const double opening : {3.1, 1.0, 1e-3, 1e-6}) {
        const TriangleMesh mesh = wedge(opening);
        const Pseudonormals normals(mesh.vertices, mesh.triangles);
        RandomSequence random(4, 0, 0);
        for (int i = 0; i < test::scaled(3000); ++i) {
            const double away = std::pow(10.0, -1.0 - 60.0 * random.uniform());
            const Vec3 around = random.unit_vector();
            const Vec3 p{away * around.x, random.uniform() - 0.5, (i % 2 == 0 ? 0.5 * opening : 1.0) * away * around.z};
            int side = 0;
            ClosestPointOnTriangle best;
            best.distance_squared = HUGE_VAL;
            for (std::uint32_t t = 0; t < 4; ++t) {
                const auto& [a, b, c] = mesh.triangles[t];
                const auto nearest = closest_point_on_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
                if (nearest.distance_squared >= best.distance_squared) continue;
                best = nearest;
                side = normals.side(t, nearest, p);
            }
            const int lower = orient3d(mesh.vertices[0], mesh.vertices[1], mesh.vertices[3], p);
            const int upper = orient3d(mesh.vertices[0], mesh.vertices[4], mesh.vertices[5], p);
            const int expected = std::max(lower, upper);
            if (side == 0 && expected != 0) continue;
            ASSERT_EQ(side, expected) << i << ", opening " << opening;
            ++decided;
        }
        queries += test::scaled(3000);
    }
    EXPECT_GT(decided, queries * 9 / 10);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
