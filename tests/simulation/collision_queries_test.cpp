// Queries on colliders, compared with a test of every single triangle.
#include "ricochet/collision_queries.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ColliderDescription mesh_collider(TriangleMesh mesh) {
    return {"mesh", MeshShape{std::make_shared<const TriangleMesh>(std::move(mesh)), {}, ""}, 0};
}

/// Returns a closed lump of 2 * 24 * 24 triangles.
TriangleMesh lump() {
    constexpr std::uint32_t kN = 24;
    TriangleMesh mesh;
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return (i % kN) * kN + j % kN; };
    for (std::uint32_t i = 0; i < kN; ++i) {
        for (std::uint32_t j = 0; j < kN; ++j) {
            const double u = 2.0 * 3.14159265358979 * i / kN;
            const double v = 2.0 * 3.14159265358979 * j / kN;
            const double r = 0.4 + 0.1 * std::cos(3.0 * u);
            mesh.vertices.push_back(
                {(1.0 + r * std::cos(v)) * std::cos(u), (1.0 + r * std::cos(v)) * std::sin(u), r * std::sin(v)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

/// Returns s of the point origin + s * direction in the triangle's plane, if it is inside the triangle. Uses long
/// doubles.
double hit_of(const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b, const Vec3& c) {
    using Real = long double;
    struct V {
        Real x, y, z;
    };
    const auto minus = [](const Vec3& p, const Vec3& q) {
        return V{Real(p.x) - q.x, Real(p.y) - q.y, Real(p.z) - q.z};
    };
    const auto cross = [](const V& p, const V& q) {
        return V{p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
    };
    const auto dot = [](const V& p, const V& q) { return p.x * q.x + p.y * q.y + p.z * q.z; };
    const V d{direction.x, direction.y, direction.z};
    const V e = minus(b, a);
    const V f = minus(c, a);
    const V s = minus(origin, a);
    const V df = cross(d, f);
    const Real determinant = dot(e, df);
    const Real u = dot(s, df) / determinant;
    const V se = cross(s, e);
    const Real v = dot(d, se) / determinant;
    const Real t = dot(f, se) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 ? static_cast<double>(t) : kInfinity;
}

Vec3 random_point(RandomSequence& random, double size) {
    const auto next = [&] { return size * (2.0 * random.uniform() - 1.0); };
    const double x = next();
    const double y = next();
    return {x, y, next()};
}

TEST(CollisionQueries, FirstHitMatchesATestOfEveryTriangle) {
    const TriangleMesh mesh = lump();
    const CollisionQueries queries({mesh_collider(mesh)});
    RandomSequence random(5, 0, 0);
    int hits = 0;
    const int count = test::scaled(3000);
    for (int k = 0; k < count; ++k) {
        const Vec3 origin = random_point(random, k % 2 == 0 ? 2.0 : 200.0);
        const Vec3 direction = k % 2 == 0 ? random_point(random, 3.0) : random_point(random, 1.0) - origin;
        double expected = kInfinity;
        std::uint32_t triangle = 0;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto& [a, b, c] = mesh.triangles[t];
            const double s = hit_of(origin, direction, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
            if (s < expected) triangle = t;
            expected = std::min(expected, s);
        }
        const auto found = queries.first_hit(origin, direction);
        ASSERT_EQ(found.has_value(), expected < kInfinity) << k;
        if (!found) continue;
        ++hits;
        const double distance = expected * length(direction);
        EXPECT_NEAR(found->distance, distance, 1e-12 * (1.0 + distance));
        EXPECT_EQ(found->surface.triangle, triangle);
        EXPECT_LT(dot(found->normal, direction), 0.0);
        EXPECT_NEAR(length(found->normal), 1.0, 1e-12);
        EXPECT_LT(length(found->point - (origin + expected * direction)), 1e-11 * (1.0 + distance));
        EXPECT_FALSE(queries.first_hit(origin, direction, 0.999 * distance).has_value());
        EXPECT_TRUE(queries.first_hit(origin, direction, 1.001 * distance).has_value());
    }
    EXPECT_GT(hits, count / 10);
}

TEST(CollisionQueries, ClosestPointMatchesATestOfEveryTriangle) {
    const TriangleMesh mesh = lump();
    const CollisionQueries queries({mesh_collider(mesh)});
    RandomSequence random(6, 0, 0);
    for (int k = 0; k < test::scaled(1000); ++k) {
        const Vec3 p = random_point(random, k % 3 == 0 ? 20.0 : 1.5);
        double least = kInfinity;
        for (const auto& [a, b, c] : mesh.triangles) {
            least = std::min(
                least,
                closest_point_on_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]).distance_squared);
        }
        const auto found = queries.closest_point(p);
        ASSERT_TRUE(found.has_value());
        EXPECT_NEAR(found->distance, std::sqrt(least), 1e-12 * (1.0 + std::sqrt(least)));
        EXPECT_NEAR(length(p - found->point), found->distance, 1e-12 * (1.0 + found->distance));
        EXPECT_FALSE(queries.closest_point(p, 0.99 * found->distance).has_value());
    }
}

TEST(CollisionQueries, InsideIsToldFromOutside) {
    const CollisionQueries queries({mesh_collider(lump()),
                                    {"ball", BallShape{0.5, {{5, 0, 0}}}, 0},
                                    {"box", CuboidShape{{1, 2, 3}, {{0, 5, 0}}}, 0},
                                    {"floor", PlaneShape{{0, 0, -9}, {0, 0, 1}}, 0}});
    EXPECT_TRUE(queries.is_inside({1, 0, 0}));
    EXPECT_FALSE(queries.is_inside({0, 0, 0}));  // the hole of the ring
    EXPECT_TRUE(queries.is_inside({5.2, 0.2, 0.1}));
    EXPECT_FALSE(queries.is_inside({5.4, 0.4, 0.1}));
    EXPECT_TRUE(queries.is_inside({0.4, 5.9, 1.4}));
    EXPECT_FALSE(queries.is_inside({0.5, 5.0, 0.0}));  // on the box
    EXPECT_FALSE(queries.is_inside({0, 0, -20}));      // planes have no inside
    RandomSequence random(7, 0, 0);
    for (int k = 0; k < test::scaled(500); ++k) {
        const Vec3 p = random_point(random, 1.6);
        std::size_t crossed = 0;  // counted along an independent ray
        Vec3 at = p;
        for (const Vec3 along{0.31, -0.72, 0.53}; const auto hit = queries.first_hit(at, along, 4.0);) {
            if (hit->surface.collider == 0) ++crossed;
            at = hit->point + 1e-9 * along;
        }
        EXPECT_EQ(queries.is_inside(p), crossed % 2 == 1) << k;
    }
}

TEST(CollisionQueries, OpenMeshHasNoInside) {
    TriangleMesh mesh = lump();
    mesh.triangles.pop_back();
    EXPECT_FALSE(CollisionQueries({mesh_collider(mesh)}).is_inside({1, 0, 0}));
}

TEST(CollisionQueries, PlanesAndShapesAreIncluded) {
    const CollisionQueries queries(
        {{"floor", PlaneShape{{0, 0, -1}, {0, 0, 2}}, 0}, {"ball", BallShape{1.0, {{0, 0, 3}}}, 0}});
    const auto down = queries.first_hit({1, 2, 0}, {0, 0, -7});
    ASSERT_TRUE(down.has_value());
    EXPECT_EQ(down->distance, 1.0);
    EXPECT_EQ(down->surface.collider, 0U);
    EXPECT_EQ(down->normal, (Vec3{0, 0, 1}));
    const auto up = queries.first_hit({0, 0, 0}, {0, 0, 1});
    ASSERT_TRUE(up.has_value());
    EXPECT_NEAR(up->distance, 2.0, 1e-15);
    EXPECT_EQ(up->surface.collider, 1U);
    EXPECT_NEAR(queries.first_hit({0, 0, 3}, {1, 0, 0})->distance, 1.0, 1e-15);  // from inside
    EXPECT_FALSE(queries.first_hit({9, 0, 0}, {1, 0, 0}).has_value());
    EXPECT_FALSE(queries.first_hit({9, 0, 0}, {1, 0, 1e-3}).has_value());
    EXPECT_NEAR(queries.first_hit({9, 0, 0}, {1, 0, -1e-9})->distance, 1e9, 1.0);
    EXPECT_EQ(queries.first_hit({9, 0, -1}, {1, 0, 0.1})->distance, 0.0);  // starts on the floor
    EXPECT_NEAR(queries.closest_point({0, 0, 0})->distance, 1.0, 1e-15);
    EXPECT_NEAR(queries.closest_point({0, 0, 1.5})->distance, 0.5, 1e-15);
    EXPECT_EQ(queries.closest_point({0, 0, 1.5})->surface.collider, 1U);
}

TEST(CollisionQueries, NormalFacesTheRayEvenFromVeryFarAway) {
    const CollisionQueries queries({{"ball", BallShape{1.0, {}}, 0}});
    for (const double away : {10.0, 1e6, 1e9, 1e12}) {
        const auto hit = queries.first_hit({away, 0, 0}, {-1, 0, 0});
        ASSERT_TRUE(hit) << away;
        EXPECT_NEAR(hit->distance, away - 1.0, 0x1p-50 * away);
        EXPECT_LT(hit->normal.x * -1.0, 0.0) << away;
    }
    const auto farther = queries.first_hit({1e18, 0, 0}, {-1, 0, 0});
    if (farther) {
        EXPECT_GT(farther->normal.x, 0.0);
    }
}

TEST(CollisionQueries, QueriesStayValidAfterAMove) {
    CollisionQueries queries({{"ball", BallShape{1.0, {}}, 0}});
    const CollisionQueries moved = std::move(queries);
    EXPECT_TRUE(moved.is_inside({}));
    EXPECT_TRUE(queries.is_inside({}));  // NOLINT(bugprone-use-after-move,hicpp-invalid-access-moved)
}

TEST(CollisionQueries, EmptyQueriesFindNothing) {
    const CollisionQueries queries(std::vector<ColliderDescription>{});
    EXPECT_FALSE(queries.first_hit({0, 0, 0}, {1, 0, 0}).has_value());
    EXPECT_FALSE(queries.closest_point({0, 0, 0}).has_value());
    EXPECT_FALSE(queries.is_inside({0, 0, 0}));
    EXPECT_TRUE(queries.colliders().empty());
}

TEST(CollisionQueries, QueriesOutliveTheirSimulation) {
    SimulationSetup setup;
    setup.materials.emplace_back();
    setup.colliders.push_back(mesh_collider(lump()));
    auto simulation = std::make_unique<Simulation>(std::move(setup));
    const CollisionQueries queries = simulation->collisions();
    const auto hit = simulation->collisions().first_hit({0, 0, 0}, {1, 0, 0});
    simulation.reset();
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(queries.first_hit({0, 0, 0}, {1, 0, 0})->distance, hit->distance);
    EXPECT_TRUE(queries.is_inside({1, 0, 0}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
