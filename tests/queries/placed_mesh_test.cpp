#include "ricochet/queries/placed_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Points = std::vector<Vec3>;

/// Returns a rotation by a random angle about a random axis, perhaps a reflection, times a scale, and a translation.
AffineMap drawn_similarity(RandomSequence& random) {
    Placement placement;
    placement.rotation_axis = random.unit_vector();
    placement.rotation_degrees = 360.0 * random.uniform();
    const double scale = std::exp2(8.0 * random.uniform() - 4.0);
    placement.scale = {random.uniform() < 0.5 ? -scale : scale, scale, scale};
    placement.position = 10.0 * random.unit_vector();
    return world_from_local(placement);
}

TriangleMesh mapped(TriangleMesh mesh, const AffineMap& map) {
    for (Vec3& v : mesh.vertices) v = map.point(v);
    return mesh;
}

struct Questions {
    Points from;
    Points to;
    Points directions;
};

Questions drawn_questions(const AffineMap& map, RandomSequence& random) {
    Questions questions;
    for (int k = 0; k < test::scaled(200); ++k) {
        questions.from.push_back(map.point(1.5 * random.unit_vector() * random.uniform()));
        questions.to.push_back(map.point(1.5 * random.unit_vector() * random.uniform()));
        questions.directions.push_back(questions.to.back() - questions.from.back());
    }
    return questions;
}

void expect_near(const std::vector<double>& found, const std::vector<double>& known, double error) {
    ASSERT_EQ(found.size(), known.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!std::isfinite(known[i])) {
            ASSERT_EQ(found[i], known[i]);
        } else {
            ASSERT_NEAR(found[i], known[i], error);
        }
    }
}

TEST(PlacedMesh, ResultsMatchATransformedCopy) {
    RandomSequence random(41, 0, 0);
    const MeshQueries mesh(testing::sphere_mesh({0, 0, 0}, 1.0, 2));
    for (int variant = 0; variant < 12; ++variant) {
        SCOPED_TRACE(variant);
        const AffineMap map = drawn_similarity(random);
        const PlacedMesh placed(mesh, map);
        const MeshQueries copy(mapped(mesh.mesh(), map));
        const Questions q = drawn_questions(map, random);
        const double scale = std::cbrt(std::fabs(map.determinant()));
        const double error = 1e-12 * (10.0 + scale);
        const std::vector<double> most{0.7 * scale};
        const RayBatch rays{q.from, q.directions, most};
        EXPECT_EQ(placed.first_hits(rays).triangle, copy.first_hits(rays).triangle);
        expect_near(placed.first_hits(rays).distance, copy.first_hits(rays).distance, 100 * error);
        EXPECT_EQ(placed.all_hits(rays).crossing, copy.all_hits(rays).crossing);
        EXPECT_EQ(placed.count_hits(rays), copy.count_hits(rays));
        EXPECT_EQ(placed.occluded(rays), copy.occluded(rays));
        EXPECT_EQ(placed.inside(q.from), copy.inside(q.from));
        EXPECT_EQ(placed.inside(q.from, InsideRule::winding), copy.inside(q.from, InsideRule::winding));
        expect_near(placed.signed_distances(q.from), copy.signed_distances(q.from), error);
        expect_near(placed.closest_points(q.from, 0.3 * scale).distance,
                    copy.closest_points(q.from, 0.3 * scale).distance, error);
        const std::vector<double> radius{0.1 * scale};
        EXPECT_EQ(placed.sweep(q.from, q.to, radius).triangle, copy.sweep(q.from, q.to, radius).triangle);
    }
}

TEST(PlacedMesh, WindingNumbersMatchATransformedCopy) {
    RandomSequence random(42, 0, 0);
    TriangleMesh sphere = testing::sphere_mesh({0, 0, 0}, 1.0, 2);
    for (const bool is_open : {false, true}) {
        if (is_open) sphere.triangles.resize(sphere.triangles.size() / 2);
        const MeshQueries mesh(sphere);
        for (int variant = 0; variant < 12; ++variant) {
            SCOPED_TRACE(variant);
            const AffineMap map = drawn_similarity(random);
            const Questions q = drawn_questions(map, random);
            const std::vector<double> found = PlacedMesh(mesh, map).winding_numbers(q.from);
            expect_near(found, MeshQueries(mapped(sphere, map)).winding_numbers(q.from), 1e-6);
        }
    }
}

TEST(PlacedMesh, MapsThatAreNoSimilarityAreRefused) {
    const MeshQueries mesh(testing::box_mesh({0, 0, 0}, {1, 1, 1}));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const std::vector<AffineMap> wrong = {
        {{1, 0, 0}, {0, 2, 0}, {0, 0, 1}, {}},       {{1, 0.1, 0}, {0, 1, 0}, {0, 0, 1}, {}},
        {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {}},       {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {}},
        {{nan, 0, 0}, {0, 1, 0}, {0, 0, 1}, {}},     {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {infinity, 0, 0}},
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1.00001}, {}},
    };
    for (const AffineMap& map : wrong) EXPECT_THROW(PlacedMesh(mesh, map), InputError);
}

TEST(PlacedMesh, ErrorNamesTheInvalidQuery) {
    const PlacedMesh placed(MeshQueries(testing::box_mesh({0, 0, 0}, {1, 1, 1})), AffineMap{});
    const Points points{{0, 0, 0}, {0, std::numeric_limits<double>::infinity(), 0}};
    try {
        (void)placed.inside(points);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("points[1]: found [0, inf, 0]"), std::string::npos) << error.what();
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
