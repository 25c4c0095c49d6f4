// Passages of single paths through planes, rectangles, boxes and meshes: edges, corners, curved paths, and comparison
// with other ways to count.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/core/transform.h"
#include "ricochet/geometry/mesh/mesh_interior.h"
#include "ricochet/simulation/counters/passages.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

FlownPiece piece(const Path& path, double begin = 0.0) {
    return {path, begin, path.duration, path.velocity(0.0), path.velocity(path.duration), true};
}

std::vector<Passage> passages_of(const CounterShape& shape, const std::vector<FlownPiece>& pieces) {
    const CounterDescription counter{"counter", shape};
    std::vector<Passage> passages;
    const Vec3 from = pieces.front().path.c[0];
    const Vec3 to = pieces.back().path.end;
    PassageFinder({&counter, 1}).trace({.id = 7, .mass = 0.5, .from = from, .to = to}, pieces, passages);
    return passages;
}

/// Returns the passages of pieces as letters: f forward, b backward.
std::string along(const CounterShape& shape, const std::vector<FlownPiece>& pieces) {
    std::string all;
    for (const Passage& passage : passages_of(shape, pieces)) all += passage.is_forward ? 'f' : 'b';
    return all;
}

/// Returns the passages of straight moves from each point to the next.
std::string through(const CounterShape& shape, const std::vector<Vec3>& points) {
    std::string all;
    for (std::size_t k = 1; k < points.size(); ++k) {
        all += along(shape, {piece(line_path(points[k - 1], points[k] - points[k - 1], 1.0))});
    }
    return all;
}

MeshCounter mesh_of(TriangleMesh mesh) { return {std::make_shared<const TriangleMesh>(std::move(mesh))}; }

MeshCounter cube() { return mesh_of(testing::box_mesh({-1, -1, -1}, {1, 1, 1})); }

BoxCounter box() { return {{0, 0, 0}, {2, 2, 2}}; }

/// Random coordinate that is often on a face, an edge or a corner of the cube.
double coarse(RandomSequence& random) { return std::round(8.0 * (random.uniform() - 0.5)) / 2.0; }

Vec3 coarse_point(RandomSequence& random) { return {coarse(random), coarse(random), coarse(random)}; }

TEST(PlaneCounter, CountsEverywhereOnThePlane) {
    const PlaneCounter plane{{0, 0, 0.5}, {0, 0, 2}};
    EXPECT_EQ(through(plane, {{1e6, -1e9, 0}, {1e6, -1e9, 1}}), "f");
    EXPECT_EQ(through(plane, {{0, 0, 1}, {5, 0, 0}}), "b");
    EXPECT_EQ(through(plane, {{0, 0, 0}, {0, 0, 0.5}, {0, 0, 0}}), "fb");
}

TEST(RectangleCounter, HasTwoSidesAndItsRim) {
    // A rectangle of 4 m along x + y and 1 m across.
    const RectangleCounter rectangle{{0, 0, 0}, {0, 0, 1}, {1, 1, 5}, {4, 1}};
    const auto at = [&](double along, double across) {
        const double s = std::sqrt(0.5);
        const Vec3 point{s * (along - across), s * (along + across), -1};
        return through(rectangle, {point, point + Vec3{0, 0, 2}});
    };
    EXPECT_EQ(at(0, 0), "f");
    EXPECT_EQ(at(1.999999, -0.499999), "f");
    EXPECT_EQ(at(2.000001, 0), "");
    EXPECT_EQ(at(0, 0.500001), "");
    const RectangleCounter straight{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {2, 1}};
    EXPECT_EQ(through(straight, {{1, 0.5, -1}, {1, 0.5, 1}}), "f");
    EXPECT_EQ(through(straight, {{std::nextafter(1.0, 2.0), 0.5, -1}, {std::nextafter(1.0, 2.0), 0.5, 1}}), "");
}

TEST(BoxCounter, EnteringIsForwardAndLeavingBackward) {
    EXPECT_EQ(through(box(), {{-3, 0, 0}, {0, 0, 0}}), "f");
    EXPECT_EQ(through(box(), {{0, 0, 0}, {0, 5, 0}}), "b");
    EXPECT_EQ(through(box(), {{-3, 0.5, 0.25}, {3, 0.5, 0.25}}), "fb");
    EXPECT_EQ(through(box(), {{-3, 3, 0}, {3, 3, 0}}), "");
    EXPECT_EQ(through(box(), {{0.5, 0.5, 0.5}, {-0.5, 0.5, 0.5}}), "");
}

TEST(BoxCounter, PathsThroughEdgesAndCornersCountOnce) {
    EXPECT_EQ(through(box(), {{-3, -3, 0}, {0, 0, 0}, {3, 3, 0}}), "fb");
    EXPECT_EQ(through(box(), {{-3, -3, -3}, {0, 0, 0}, {3, 3, 3}}), "fb");
    EXPECT_EQ(through(box(), {{-3, -3, -3}, {3, 3, 3}}), "fb");
    EXPECT_EQ(through(box(), {{0, 2, 0}, {2, 0, 0}}), "") << "touches an edge";
    EXPECT_EQ(through(box(), {{-3, 0, 0}, {-1, 0, 0}, {-3, 0, 0}}), "fb") << "the lower face is inside";
    EXPECT_EQ(through(box(), {{3, 0, 0}, {1, 0, 0}, {3, 0, 0}}), "") << "the upper face is outside";
}

TEST(BoxCounter, BalanceIsTheChangeOfSideForAnyPath) {
    RandomSequence random(3, 1, 0);
    const BoxSurface surface(box());
    for (int trial = 0; trial < test::scaled(3000); ++trial) {
        SCOPED_TRACE(trial);
        Vec3 at = coarse_point(random);
        for (int k = 0; k < 5; ++k) {
            const Vec3 to = coarse_point(random);
            const Path path = hermite_path(at, coarse_point(random), to, coarse_point(random), 1.5);
            bool is_inside = surface.contains(at);
            for (const char c : along(box(), {piece(path)})) {
                ASSERT_EQ(c == 'f', !is_inside) << "passages alternate";
                is_inside = !is_inside;
            }
            at = to;
            ASSERT_EQ(is_inside, surface.contains(at));
        }
    }
}

TEST(MeshCounter, FrontToBackIsForward) {
    EXPECT_EQ(through(cube(), {{-3, 0.1, 0.2}, {0, 0, 0}}), "f");
    EXPECT_EQ(through(cube(), {{0, 0.1, 0.2}, {0, 5, 0}}), "b");
    EXPECT_EQ(through(mesh_of(testing::flipped(testing::box_mesh({-1, -1, -1}, {1, 1, 1}))), {{-3, 0, 0}, {0, 0, 0}}),
              "b");
    const TriangleMesh sheet{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(through(mesh_of(sheet), {{0.5, 0.5, 1}, {0.5, 0.5, -1}}), "f");
    EXPECT_EQ(through(mesh_of(sheet), {{0.5, 0.5, -1}, {0.5, 0.5, 1}}), "b");
    EXPECT_EQ(through(mesh_of(sheet), {{1.5, 1.5, -1}, {1.5, 1.5, 1}}), "");
}

TEST(MeshCounter, PathsThroughEdgesAndVerticesCountOnce) {
    // The diagonal of a face goes through its centre.
    EXPECT_EQ(through(cube(), {{-3, 0, 0}, {3, 0, 0}}), "fb");
    EXPECT_EQ(through(cube(), {{-3, -3, 0}, {0, 0, 0}, {3, 3, 0}}), "fb");
    EXPECT_EQ(through(cube(), {{-3, -3, -3}, {3, 3, 3}}), "fb");
    EXPECT_EQ(through(cube(), {{0, 2, 0}, {2, 0, 0}}), "") << "touches an edge";
}

TEST(MeshCounter, PathThatStopsOnAFacePassesOnce) {
    const std::string stops = through(cube(), {{-3, 0.5, 0.25}, {-1, 0.5, 0.25}, {0, 0.5, 0.25}});
    EXPECT_EQ(stops, "f");
    const std::string slides = through(cube(), {{-3, 0.5, 0.25}, {-1, 0.5, 0.25}, {-1, -0.5, 0}, {-1, 3, 0}});
    EXPECT_TRUE(slides.empty() || slides == "fb") << slides;
}

TEST(MeshCounter, BalanceIsTheChangeOfSideForAnyPath) {
    RandomSequence random(4, 1, 0);
    const MeshCounter counter = cube();
    const MeshInterior interior(counter.mesh);
    const auto is_on_a_face = [](const Vec3& p) { return max_abs(p) == 1.0; };
    for (int trial = 0; trial < test::scaled(2000); ++trial) {
        SCOPED_TRACE(trial);
        Vec3 at{0, 0, 0};
        int balance = 1;
        for (int k = 0; k < 5; ++k) {
            const Vec3 to = coarse_point(random);
            const Path path = hermite_path(at, coarse_point(random), to, coarse_point(random), 1.5);
            for (const char c : along(counter, {piece(path)})) balance += c == 'f' ? 1 : -1;
            at = to;
            ASSERT_TRUE(balance == 0 || balance == 1) << balance;
            if (!is_on_a_face(at)) {
                ASSERT_EQ(balance, interior.contains(at) ? 1 : 0);
            }
        }
    }
}

TEST(MeshCounter, CubeCountsLikeABoxForCurvedPaths) {
    RandomSequence random(9, 1, 0);
    const auto point = [&] {
        return Vec3{6 * random.uniform() - 3, 6 * random.uniform() - 3, 6 * random.uniform() - 3};
    };
    std::size_t count = 0;
    for (int trial = 0; trial < test::scaled(2000); ++trial) {
        SCOPED_TRACE(trial);
        const std::vector<FlownPiece> pieces{
            piece(hermite_path(point(), 3.0 * point(), point(), 3.0 * point(), 2.0), 4.0)};
        const std::vector<Passage> of_box = passages_of(box(), pieces);
        const std::vector<Passage> of_mesh = passages_of(cube(), pieces);
        ASSERT_EQ(of_mesh.size(), of_box.size());
        count += of_box.size();
        for (std::size_t k = 0; k < of_box.size(); ++k) {
            EXPECT_EQ(of_mesh[k].is_forward, of_box[k].is_forward);
            EXPECT_NEAR(of_mesh[k].time, of_box[k].time, 1e-12);
            EXPECT_NEAR(length(of_mesh[k].velocity - of_box[k].velocity), 0.0, 1e-11);
            EXPECT_EQ(of_mesh[k].direction, of_box[k].direction);
        }
    }
    EXPECT_GE(count, static_cast<std::size_t>(test::scaled(1000)));
}

TEST(MeshCounter, TurnedAndMovedMeshCountsTheSame) {
    RandomSequence random(11, 1, 0);
    const auto point = [&] {
        return Vec3{6 * random.uniform() - 3, 6 * random.uniform() - 3, 6 * random.uniform() - 3};
    };
    const AffineMap map = world_from_local({{5, -7, 2}, {1, 2, 3}, 40, {2, 2, 2}});
    TriangleMesh turned = testing::sphere_mesh({0, 0, 0}, 1.5, 2);
    const MeshCounter counter = mesh_of(turned);
    for (Vec3& vertex : turned.vertices) vertex = map.point(vertex);
    const MeshCounter other = mesh_of(turned);
    for (int trial = 0; trial < test::scaled(1000); ++trial) {
        SCOPED_TRACE(trial);
        const Vec3 from = point(), to = point(), start = 3.0 * point(), end = 3.0 * point();
        const Path path = hermite_path(from, start, to, end, 2.0);
        const Path image = hermite_path(map.point(from), map.direction(start), map.point(to), map.direction(end), 2.0);
        EXPECT_EQ(along(other, {piece(image)}), along(counter, {piece(path)}));
    }
}

TEST(MeshCounter, CurvedPathInThePlaneOfATriangleIsFollowedInBoundedTime) {
    const Path arc = parabola_path({-0.5, -0.5, -1}, {1, 1, 0}, {0, -1, 0}, 1.0);
    const std::string letters = along(cube(), {piece(arc)});
    EXPECT_TRUE(letters.empty() || letters == "fb" || letters == "bf") << letters;
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
