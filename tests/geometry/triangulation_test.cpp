#include "ricochet/geometry/mesh/triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

#include "inspect/mesh_topology.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Outline = std::vector<Vec3>;

PolygonMesh one_face(Outline outline) {
    PolygonMesh mesh;
    mesh.vertices = std::move(outline);
    mesh.corners.resize(mesh.vertices.size());
    std::iota(mesh.corners.begin(), mesh.corners.end(), 0U);
    mesh.face_offsets = {0, static_cast<std::uint32_t>(mesh.corners.size())};
    return mesh;
}

double area_of(const PolygonMesh& mesh, const Triangulation& cut) {
    return surface_area({mesh.vertices, cut.triangles});
}

// Returns twice the signed area of an outline in the plane z = 0.
double twice_area(const Outline& outline) {
    double sum = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vec3& a = outline[i];
        const Vec3& b = outline[(i + 1) % outline.size()];
        sum += a.x * b.y - a.y * b.x;
    }
    return sum;
}

// Expects that the triangles form a disk. Every edge of the outline occurs once, in its direction, and every diagonal
// once in each direction.
void expect_disk(const PolygonMesh& mesh, const Triangulation& cut) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const Triangle& t : cut.triangles) {
        for (std::size_t k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
    }
    const std::size_t count = mesh.corners.size();
    for (std::size_t i = 0; i < count; ++i) --uses[{mesh.corners[i], mesh.corners[(i + 1) % count]}];
    for (const auto& [edge, number] : uses) {
        const auto back = uses.find({edge.second, edge.first});
        ASSERT_EQ(number, back == uses.end() ? 0 : back->second) << edge.first << " " << edge.second;
    }
}

// Expects, for an outline in the plane z = 0, that no triangle is reversed and that the areas add up. Together these
// imply that triangles do not overlap.
void expect_exact_cover(const PolygonMesh& mesh, const Triangulation& cut, double relative_rounding) {
    ASSERT_EQ(cut.triangles.size(), mesh.corners.size() - 2);
    ASSERT_EQ(cut.crossing_faces, 0U);
    const double area = twice_area(mesh.vertices) / 2;
    const int side = area > 0 ? 1 : -1;
    const auto flat = [&](std::uint32_t v) { return Point2{mesh.vertices[v].x, mesh.vertices[v].y}; };
    for (const Triangle& t : cut.triangles) ASSERT_GE(side * orient2d(flat(t[0]), flat(t[1]), flat(t[2])), 0);
    EXPECT_NEAR(area_of(mesh, cut), std::fabs(area), relative_rounding * std::fabs(area));
    expect_disk(mesh, cut);
}

Outline rotated(Outline outline, std::size_t by) {
    std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(by), outline.end());
    return outline;
}

const Outline kLetterL = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};

TEST(Triangulation, HasTheAreaOfALetterL) {
    for (std::size_t start = 0; start < kLetterL.size(); ++start) {
        SCOPED_TRACE(start);
        const PolygonMesh mesh = one_face(rotated(kLetterL, start));
        const Triangulation cut = triangulate(mesh);
        EXPECT_EQ(area_of(mesh, cut), 5.0);
        expect_exact_cover(mesh, cut, 0.0);
    }
}

TEST(Triangulation, KeepsTheWindingOfTheOutline) {
    Outline clockwise = kLetterL;
    std::reverse(clockwise.begin(), clockwise.end());
    const PolygonMesh mesh = one_face(clockwise);
    expect_exact_cover(mesh, triangulate(mesh), 0.0);
}

TEST(Triangulation, WorksInEveryPlane) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {1.0, -1.0}) {
            Outline turned;
            for (const Vec3& p : kLetterL) {
                const Vec3 q{p.x, side * p.y, 0.3 * p.x + 1e6};
                turned.push_back(axis == 0 ? q : (axis == 1 ? Vec3{q.z, q.x, q.y} : Vec3{q.y, q.z, q.x}));
            }
            const PolygonMesh mesh = one_face(turned);
            const Triangulation cut = triangulate(mesh);
            EXPECT_EQ(cut.crossing_faces, 0U);
            EXPECT_NEAR(area_of(mesh, cut), 5.0 * std::sqrt(1.09), 1e-8);
            expect_disk(mesh, cut);
        }
    }
}

TEST(Triangulation, CutsAConcaveQuadAlongTheDiagonalInside) {
    const Outline dart = {{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}};
    for (std::size_t start = 0; start < 4; ++start) {
        const PolygonMesh mesh = one_face(rotated(dart, start));
        expect_exact_cover(mesh, triangulate(mesh), 0.0);
        EXPECT_EQ(area_of(mesh, triangulate(mesh)), 1.0);
    }
}

TEST(Triangulation, CutsAConvexQuadFromItsFirstCorner) {
    const PolygonMesh mesh = one_face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    EXPECT_EQ(triangulate(mesh).triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Triangulation, CutsAQuadWithACollinearCornerIntoTwoTrianglesWithArea) {
    const Outline quad = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
    for (std::size_t start = 0; start < 4; ++start) {
        const PolygonMesh mesh = one_face(rotated(quad, start));
        const Triangulation cut = triangulate(mesh);
        expect_exact_cover(mesh, cut, 0.0);
        for (const Triangle& t : cut.triangles) {
            EXPECT_FALSE(are_collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
        }
    }
}

TEST(Triangulation, MakesNoDegenerateTriangleFromCollinearCorners) {
    // A square with four extra corners on every side.
    Outline square;
    for (int i = 0; i < 5; ++i) square.emplace_back(i, 0, 0);
    for (int i = 0; i < 5; ++i) square.emplace_back(5, i, 0);
    for (int i = 0; i < 5; ++i) square.emplace_back(5 - i, 5, 0);
    for (int i = 0; i < 5; ++i) square.emplace_back(0, 5 - i, 0);
    const PolygonMesh mesh = one_face(square);
    const Triangulation cut = triangulate(mesh);
    expect_exact_cover(mesh, cut, 0.0);
    for (const Triangle& t : cut.triangles) {
        EXPECT_FALSE(are_collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
    }
}

TEST(Triangulation, CutsAnOutlineWithABridgeToItsHole) {
    // A square with a square hole. They are joined by a bridge that the outline follows in both directions (corners 0
    // and 4 twice).
    PolygonMesh mesh;
    mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}};
    const std::vector<std::uint32_t> outline = {0, 1, 2, 3, 0, 4, 5, 6, 7, 4};
    for (std::size_t start = 0; start < outline.size(); ++start) {
        SCOPED_TRACE(start);
        mesh.corners = outline;
        std::rotate(mesh.corners.begin(), mesh.corners.begin() + static_cast<std::ptrdiff_t>(start),
                    mesh.corners.end());
        mesh.face_offsets = {0, static_cast<std::uint32_t>(outline.size())};
        const Triangulation cut = triangulate(mesh);
        EXPECT_EQ(cut.crossing_faces, 0U);
        EXPECT_EQ(cut.faces_with_repeated_corners, 1U);
        EXPECT_EQ(cut.triangles.size(), 8U);
        EXPECT_DOUBLE_EQ(area_of(mesh, cut), 12.0);
    }
}

TEST(Triangulation, CountsEqualNeighboursOnce) {
    PolygonMesh mesh = one_face(kLetterL);
    mesh.corners = {0, 0, 1, 2, 2, 2, 3, 4, 5, 0};
    mesh.face_offsets = {0, 10};
    const Triangulation cut = triangulate(mesh);
    EXPECT_EQ(cut.triangles.size(), 4U);
    EXPECT_EQ(cut.faces_with_repeated_corners, 1U);
    EXPECT_EQ(area_of(mesh, cut), 5.0);
}

TEST(Triangulation, KeepsAFaceOfTwoDifferentCornersAsOneDegenerateTriangle) {
    PolygonMesh mesh = one_face(kLetterL);
    mesh.corners = {1, 1, 2, 1, 1, 1, 1, 0, 0, 3};
    mesh.face_offsets = {0, 3, 7, 10};
    const Triangulation cut = triangulate(mesh);
    EXPECT_EQ(cut.triangles, (std::vector<Triangle>{{1, 1, 2}, {1, 1, 1}, {0, 0, 3}}));
    EXPECT_EQ(cut.faces_with_repeated_corners, 3U);
    EXPECT_EQ(cut.triangle_face, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(Triangulation, CoversAndReportsAnOutlineThatCrossesItself) {
    // A pentagram winds once around its five tips and twice around its middle.
    Outline star;
    for (int i = 0; i < 5; ++i) {
        const double angle = 2 * i * 2 * std::numbers::pi / 5;
        star.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    const PolygonMesh mesh = one_face(star);
    const Triangulation cut = triangulate(mesh);
    EXPECT_EQ(cut.crossing_faces, 1U);
    EXPECT_EQ(cut.triangles.size(), 3U);
    expect_disk(mesh, cut);
    // A sample point in every tip and in the middle must be covered.
    const auto covered = [&](const Point2& p) {
        return std::any_of(cut.triangles.begin(), cut.triangles.end(), [&](const Triangle& t) {
            const auto flat = [&](std::uint32_t v) { return Point2{mesh.vertices[v].x, mesh.vertices[v].y}; };
            const int a = orient2d(flat(t[0]), flat(t[1]), p);
            const int b = orient2d(flat(t[1]), flat(t[2]), p);
            const int c = orient2d(flat(t[2]), flat(t[0]), p);
            return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
        });
    };
    EXPECT_TRUE(covered({0.01, 0.02}));
    for (const Vec3& tip : star) EXPECT_TRUE(covered({0.9 * tip.x + 1e-3, 0.9 * tip.y}));
}

TEST(Triangulation, CallsABowTieCrossing) {
    EXPECT_EQ(triangulate(one_face({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}})).crossing_faces, 1U);
}

TEST(Triangulation, AcceptsAPolygonWithoutArea) {
    const Triangulation cut = triangulate(one_face({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1.5, 0, 0}}));
    EXPECT_EQ(cut.triangles.size(), 3U);
    EXPECT_EQ(cut.crossing_faces, 0U);
}

TEST(Triangulation, CountsRepeatedCornersEvenIfEveryFaceIsATriangle) {
    const PolygonMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 3, 6, 9}, {0, 1, 2, 1, 1, 0, 2, 1, 2}, {}, {}, {}};
    const Triangulation cut = triangulate(mesh);
    EXPECT_EQ(cut.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 1, 0}, {2, 1, 2}}));
    EXPECT_EQ(cut.triangle_face, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(cut.faces_with_repeated_corners, 2U);
    EXPECT_EQ(cut.crossing_faces, 0U);
}

TEST(Triangulation, RefusesPolygonsOutsideItsLimits) {
    PolygonMesh mesh = one_face(kLetterL);
    mesh.face_offsets = {0, 2};
    EXPECT_THROW((void)triangulate(mesh), InputError);
    mesh.corners.assign(kLargestPolygon + 1, 0);
    mesh.face_offsets = {0, static_cast<std::uint32_t>(mesh.corners.size())};
    EXPECT_THROW((void)triangulate(mesh), InputError);
}

// Returns a random simple polygon: corners at increasing angles and random distances.
Outline random_star(std::mt19937_64& random, std::size_t corners) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    Outline outline;
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle =
            2 * std::numbers::pi * (static_cast<double>(i) + 0.9 * unit(random)) / static_cast<double>(corners);
        const double radius = std::pow(unit(random), 2) + 0.01;
        outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    return outline;
}

// Returns a random simple polygon that is not star-shaped. Crossing edges are untangled until none is left.
Outline random_tangle(std::mt19937_64& random, std::size_t corners) {
    std::uniform_int_distribution<int> grid(0, 60);
    Outline p;
    while (p.size() < corners) {
        const Vec3 q{static_cast<double>(grid(random)), static_cast<double>(grid(random)), 0};
        if (std::find(p.begin(), p.end(), q) == p.end()) p.push_back(q);
    }
    const auto flat = [&](std::size_t i) { return Point2{p[i % corners].x, p[i % corners].y}; };
    const auto meet = [&](std::size_t i, std::size_t j) {
        const int a = orient2d(flat(i), flat(i + 1), flat(j));
        const int b = orient2d(flat(i), flat(i + 1), flat(j + 1));
        const int c = orient2d(flat(j), flat(j + 1), flat(i));
        const int d = orient2d(flat(j), flat(j + 1), flat(i + 1));
        return a * b <= 0 && c * d <= 0 && (a != 0 || b != 0 || c != 0 || d != 0);
    };
    for (int pass = 0; pass < 2000; ++pass) {
        bool changed = false;
        for (std::size_t i = 0; i < corners && !changed; ++i) {
            for (std::size_t j = i + 2; j < corners && !changed; ++j) {
                if ((j + 1) % corners == i || !meet(i, j)) continue;
                std::reverse(p.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                             p.begin() + static_cast<std::ptrdiff_t>(j) + 1);
                changed = true;
            }
        }
        if (!changed) return p;
    }
    return {};
}

bool is_simple(const Outline& p) {
    const std::size_t n = p.size();
    const auto flat = [&](std::size_t i) { return Point2{p[i % n].x, p[i % n].y}; };
    const auto on_segment = [&](std::size_t k, std::size_t i) {
        if (orient2d(flat(i), flat(i + 1), flat(k)) != 0) return false;
        const auto [u0, u1] = std::minmax({flat(i).u, flat(i + 1).u});
        const auto [v0, v1] = std::minmax({flat(i).v, flat(i + 1).v});
        return flat(k).u >= u0 && flat(k).u <= u1 && flat(k).v >= v0 && flat(k).v <= v1;
    };
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            if (j != i && j != (i + 1) % n && on_segment(j, i)) return false;
        }
        for (std::size_t j = i + 2; j < n; ++j) {
            if ((j + 1) % n == i) continue;
            if (orient2d(flat(i), flat(i + 1), flat(j)) * orient2d(flat(i), flat(i + 1), flat(j + 1)) < 0 &&
                orient2d(flat(j), flat(j + 1), flat(i)) * orient2d(flat(j), flat(j + 1), flat(i + 1)) < 0) {
                return false;
            }
        }
    }
    return true;
}

TEST(Triangulation, CoversRandomStarsExactly) {
    for (int seed = 0; seed < test::scaled(400); ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        const PolygonMesh mesh = one_face(random_star(random, 5 + random() % 200));
        expect_exact_cover(mesh, triangulate(mesh), 1e-9);
        if (HasFatalFailure()) return;
    }
}

TEST(Triangulation, CoversRandomPolygonsOnACoarseGridExactly) {
    int tried = 0;
    for (int seed = 0; seed < test::scaled(300); ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        const Outline outline = random_tangle(random, 5 + random() % 40);
        if (outline.empty() || !is_simple(outline)) continue;
        ++tried;
        const PolygonMesh mesh = one_face(outline);
        expect_exact_cover(mesh, triangulate(mesh), 1e-12);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(tried, 0);
}

TEST(Triangulation, IsADiskForAnyOutline) {
    for (int seed = 0; seed < test::scaled(2000); ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        std::uniform_int_distribution<int> grid(0, 4);
        Outline outline(4 + random() % 20);
        for (Vec3& p : outline) p = {static_cast<double>(grid(random)), static_cast<double>(grid(random)), 0};
        const PolygonMesh mesh = one_face(outline);
        const Triangulation cut = triangulate(mesh);
        ASSERT_EQ(cut.triangles.size(), outline.size() - 2);
        expect_disk(mesh, cut);
        // The signed areas must add up to the area of the outline.
        double twice = 0.0;
        for (const Triangle& t : cut.triangles)
            twice += twice_area({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
        ASSERT_EQ(twice, twice_area(outline));
        if (HasFatalFailure()) return;
    }
}

// Tests a closed prism over a polygon. Its faces share edges, and no triangulation may open it.
TEST(Triangulation, LeavesAClosedPolygonMeshClosed) {
    std::mt19937_64 random(7);
    const Outline base = random_star(random, 100);
    PolygonMesh prism;
    prism.vertices = base;
    for (const Vec3& p : base) prism.vertices.push_back(p + Vec3{0.1, 0.2, 1});
    const auto count = static_cast<std::uint32_t>(base.size());
    prism.face_offsets.push_back(0);
    const auto close = [&] { prism.face_offsets.push_back(static_cast<std::uint32_t>(prism.corners.size())); };
    for (std::uint32_t i = 0; i < count; ++i) prism.corners.push_back(count - 1 - i);
    close();
    for (std::uint32_t i = 0; i < count; ++i) prism.corners.push_back(count + i);
    close();
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t j = (i + 1) % count;
        prism.corners.insert(prism.corners.end(), {i, j, count + j, count + i});
        close();
    }
    const Triangulation cut = triangulate(prism);
    const MeshTopology topology(TriangleMesh{prism.vertices, cut.triangles});
    EXPECT_TRUE(topology.report().closed);
    EXPECT_TRUE(topology.report().consistently_oriented);
    EXPECT_EQ(topology.report().nonmanifold_edges, 0U);
    EXPECT_NEAR(signed_volume({prism.vertices, cut.triangles}), twice_area(base) / 2, 1e-12);
}

// Shapes on which simple ear clipping takes quadratic time (10^10 steps). The time limit of the test would detect that.
Outline spiral(std::size_t corners) {
    Outline outline;
    const std::size_t half = corners / 2;
    const auto at = [&](std::size_t i, double width) {
        const double turn = static_cast<double>(i) * 0.05;
        const double radius = 1.0 + turn - width;
        return Vec3{radius * std::cos(turn), radius * std::sin(turn), 0};
    };
    for (std::size_t i = 0; i < half; ++i) outline.push_back(at(i, 0.0));
    for (std::size_t i = half; i-- > 0;) outline.push_back(at(i, 0.5));
    return outline;
}

Outline comb(std::size_t corners) {
    Outline outline = {{static_cast<double>(corners), -1, 0}, {static_cast<double>(corners), 5, 0}};
    for (std::size_t i = corners; i-- > 0;) outline.emplace_back(static_cast<double>(i), i % 2 == 0 ? 0.0 : 5.0, 0);
    outline.emplace_back(-1.0, -1.0, 0);
    return outline;
}

TEST(Triangulation, CutsLargePolygonsInNearlyLinearTime) {
    const auto corners = static_cast<std::size_t>(test::scaled(50000));
    std::mt19937_64 random(3);
    for (const Outline& outline : {spiral(corners), comb(corners), random_star(random, corners)}) {
        const PolygonMesh mesh = one_face(outline);
        expect_exact_cover(mesh, triangulate(mesh), 1e-6);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
