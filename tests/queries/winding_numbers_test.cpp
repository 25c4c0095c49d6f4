// Winding numbers of closed and open meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/winding_number.h"
#include "ricochet/queries/mesh_queries.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Points = std::vector<Vec3>;
using Numbers = std::vector<double>;

/// First direction of the library's rays. Points that lie opposite to it from a vertex are the hard ones.
constexpr Vec3 kDirection{0.4375, 0.6171875, 1.0};

/// Rounding error of a solid angle beside a vertex, for up to some hundred edges.
constexpr double kRounding = 1e-7;

/// Returns a patch of a grid whose heights are integers.
TriangleMesh terrain(std::uint32_t size) {
    TriangleMesh mesh;
    for (std::uint32_t x = 0; x <= size; ++x) {
        for (std::uint32_t y = 0; y <= size; ++y) {
            mesh.vertices.push_back({double(x), double(y), double((x * x + 3 * y) % 4)});
        }
    }
    const std::uint32_t row = size + 1;
    for (std::uint32_t x = 0; x < size; ++x) {
        for (std::uint32_t y = 0; y < size; ++y) {
            const std::uint32_t v = x * row + y;
            mesh.triangles.push_back({v, v + row, v + row + 1});
            mesh.triangles.push_back({v, v + row + 1, v + 1});
        }
    }
    return mesh;
}

TEST(WindingNumbers, ClosedMeshesHaveIntegerNumbers) {
    const TriangleMesh box = testing::box_mesh({0, 0, 0}, {4, 4, 4});
    const Points points{{2, 2, 2}, {1, 1, 1}, {-1, 2, 2}, {2, 2, 9}, {0.5, 3.5, 0.25}};
    EXPECT_EQ(MeshQueries(box).winding_numbers(points), (Numbers{1, 1, 0, 0, 1}));
    EXPECT_EQ(MeshQueries(testing::flipped(box)).winding_numbers(points), (Numbers{-1, -1, 0, 0, -1}));
}

TEST(WindingNumbers, OverlappingShellsAddUp) {
    const MeshQueries mesh(
        testing::merged(testing::box_mesh({0, 0, 0}, {2, 2, 2}), testing::box_mesh({1, 1, 1}, {3, 3, 3})));
    EXPECT_EQ(mesh.winding_numbers(Points{{0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}, {2.5, 2.5, 2.5}, {0.5, 0.5, 2.5}}),
              (Numbers{1, 2, 1, 0}));
}

TEST(WindingNumbers, CavityHasNumberZero) {
    const MeshQueries mesh(testing::merged(testing::box_mesh({0, 0, 0}, {4, 4, 4}),
                                           testing::flipped(testing::box_mesh({1, 1, 1}, {3, 3, 3}))));
    EXPECT_EQ(mesh.winding_numbers(Points{{2, 2, 2}, {0.5, 2, 2}}), (Numbers{0, 1}));
}

// A square with half sides a and b, and a point at height h above its centre.
TEST(WindingNumbers, RectangleHasTheNumberOfItsSolidAngle) {
    const double a = 1.5;
    const double b = 0.75;
    TriangleMesh plate;
    plate.vertices = {{-a, -b, 0}, {a, -b, 0}, {a, b, 0}, {-a, b, 0}};
    plate.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (const double h : {1e-6, 0.1, 1.0, 40.0}) {
        const double angle = 4.0 * std::atan2(a * b, h * std::sqrt(a * a + b * b + h * h));
        const double part = angle / (4.0 * std::numbers::pi);
        const Numbers found = MeshQueries(plate).winding_numbers(Points{{0, 0, -h}, {0, 0, h}});
        EXPECT_NEAR(found[0], part, 1e-14) << h;
        EXPECT_NEAR(found[1], -part, 1e-14) << h;
    }
}

TEST(WindingNumbers, RandomTrianglesMatchTheSumOfSolidAngles) {
    const std::uint64_t seed = 20;
    RandomSequence draws(seed, 1, 0);
    const auto point = [&](double size) {
        return Vec3{size * (draws.uniform() - 0.5), size * (draws.uniform() - 0.5), size * (draws.uniform() - 0.5)};
    };
    for (int round = 0; round < test::scaled(100); ++round) {
        SCOPED_TRACE("seed 20, round " + std::to_string(round));
        TriangleMesh mesh;
        for (int v = 0; v < 20; ++v) mesh.vertices.push_back(point(2.0));
        for (std::uint32_t t = 0; t < 40; ++t) {
            const auto corner = [&] { return static_cast<std::uint32_t>(20.0 * draws.uniform()); };
            mesh.triangles.push_back({corner(), corner(), corner()});
        }
        const MeshQueries queries(mesh);
        for (int k = 0; k < 20; ++k) {
            const Vec3 p = point(3.0);
            EXPECT_NEAR(queries.winding_numbers(Points{p})[0], winding_number(mesh, p), kRounding);
        }
    }
}

TEST(WindingNumbers, RaysThroughVerticesAndEdgesOfTheBoundaryGiveTheRightNumber) {
    const TriangleMesh mesh = terrain(4);
    const MeshQueries queries(mesh);
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& a = mesh.vertices[t[k]];
            const Vec3 middle = 0.5 * (a + mesh.vertices[t[(k + 1) % 3]]);
            for (const double far : {0.5, 1.0, 4.0, -0.5, -2.0}) {
                for (const Vec3& p : {a - far * kDirection, middle - far * kDirection}) {
                    if (queries.closest_points(Points{p}).distance[0] < 1e-9) continue;
                    EXPECT_NEAR(queries.winding_numbers(Points{p})[0], winding_number(mesh, p), kRounding)
                        << p.x << ' ' << p.y << ' ' << p.z;
                }
            }
        }
    }
}

TEST(WindingNumbers, VerticesListedTwiceChangeNothing) {
    const TriangleMesh sphere = testing::sphere_mesh({0, 0, 0}, 1.0, 3);
    TriangleMesh apart;
    for (const Triangle& t : sphere.triangles) {
        const auto next = static_cast<std::uint32_t>(apart.vertices.size());
        for (const std::uint32_t v : t) apart.vertices.push_back(sphere.vertices[v]);
        apart.triangles.push_back({next, next + 1, next + 2});
    }
    EXPECT_EQ(MeshQueries(apart).winding_numbers(Points{{0.1, 0.2, 0.3}, {0.9, 0.9, 0.9}}), (Numbers{1, 0}));
}

TEST(WindingNumbers, HalfASphereHasNumberOneHalfAtItsCentre) {
    TriangleMesh half = testing::sphere_mesh({0, 0, 0}, 1.0, 4);
    std::erase_if(half.triangles, [&](const Triangle& t) {
        return half.vertices[t[0]].z + half.vertices[t[1]].z + half.vertices[t[2]].z < 0.0;
    });
    EXPECT_NEAR(MeshQueries(half).winding_numbers(Points{{0, 0, 0}})[0], 0.5, 1e-13);
}

TEST(WindingNumbers, PointsThatAreNotFiniteAreRefused) {
    EXPECT_THROW((void)MeshQueries(terrain(1)).winding_numbers(Points{{0, std::nan(""), 0}}), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
