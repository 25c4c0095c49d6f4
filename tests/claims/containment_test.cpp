// Particles that start inside a closed mesh end inside it. An exact parity test that shares no code with the library
// confirms this. Their segments intersect no triangle, also in open meshes. Rational arithmetic confirms this.
//
// A long run tests the same claims with ten thousand particles and a thousand steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "claims/billiard.h"
#include "support/counts.h"
#include "support/shared_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

/// Approximate number of impacts per step.
const double kImpacts = test::is_long_run() ? 0.75 : 1.5;

/// Amount of work for one placement of the mesh.
struct Amount {
    int particles;
    int steps;
};
Amount amount(const std::string& mesh, std::size_t placement) {
    const bool is_real = mesh.find('.') != std::string::npos;
    // Real meshes get the full number of particles in two placements: the original one, and moved by a thousand
    // diagonals.
    if (test::is_long_run()) return {test::scaled(is_real && placement < 2 ? 10000 : 1000), 1000};
    // The largest mesh takes long to load, so short runs use fewer particles in most of its placements.
    return {test::scaled(mesh == "armadillo.obj" && placement > 1 ? 20 : 60), 50};
}

class Containment : public ::testing::TestWithParam<std::string> {
protected:
    /// Calls run(billiard, amount) for every hard placement of the mesh.
    template <class Run>
    void everywhere(Run&& run) {
        const auto mesh = mesh_by_name(GetParam());
        if (!mesh) GTEST_SKIP() << missing_mesh_sentence(GetParam());
        const auto placements = hard_placements(mesh->mesh);
        for (std::size_t k = 0; k < placements.size(); ++k) {
            SCOPED_TRACE(mesh->name + ", " + placements[k].name);
            run(Billiard(*mesh, placements[k].placement), amount(mesh->name, k));
        }
    }
};

using ClosedMesh = Containment;
using MessyMesh = Containment;  // a mesh that is open, non-manifold or self-intersecting

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
    std::string name = info.param.substr(0, info.param.find('.'));
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Made, ClosedMesh, ::testing::Values("box", "sphere", "flat", "star", "shell", "wedge"),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Real, ClosedMesh,
                         ::testing::Values("bunny-closed.off", "armadillo.obj", "spot.obj", "fandisk.obj",
                                           "quadknot.obj", "ADIS16480.stl", "self_intersectA.obj"),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Real, MessyMesh,
                         ::testing::Values("stanford-bunny.obj", "teapot.obj", "featuretype.stl", "cycloidal.ply"),
                         test_name);

TEST_P(ClosedMesh, ContainsStraightFlights) {
    everywhere([](const Billiard& billiard, const Amount& n) {
        ASSERT_TRUE(billiard.is_closed());
        const BilliardTally tally = billiard.fly(n.particles, n.steps, kImpacts, 0.0, IntegratorKind::ballistic, 1);
        EXPECT_EQ(tally.not_inside, 0U);
        EXPECT_GT(tally.contacts, 0U);
    });
}

TEST_P(ClosedMesh, ContainsParabolicFlights) {
    everywhere([](const Billiard& billiard, const Amount& n) {
        const BilliardTally tally =
            billiard.fly(std::max(1, n.particles / 4), n.steps, kImpacts, 0.5, IntegratorKind::ballistic, 2);
        EXPECT_EQ(tally.not_inside, 0U);
        EXPECT_GT(tally.contacts, 0U);
    });
}

TEST_P(ClosedMesh, ContainsFallsInStraightPieces) {
    everywhere([](const Billiard& billiard, const Amount& n) {
        const BilliardTally tally =
            billiard.fly(std::max(1, n.particles / 4), n.steps, kImpacts, 0.5, IntegratorKind::symplectic_euler, 3);
        EXPECT_EQ(tally.not_inside, 0U);
        EXPECT_GT(tally.contacts, 0U);
    });
}

TEST_P(ClosedMesh, ContainsParticlesAimedAtItsVerticesAndEdges) {
    everywhere([](const Billiard& billiard, const Amount& n) {
        const int check_every = std::max(1, n.particles * n.steps / 200);
        const BilliardTally tally = billiard.aim(n.particles, n.steps, check_every, 4);
        EXPECT_EQ(tally.not_inside, 0U);
        EXPECT_GT(tally.contacts, 0U);
        EXPECT_EQ(tally.crossing_segments, 0U) << "of " << tally.checked_segments;
    });
}

TEST_P(MessyMesh, IsNotCrossedByAnySegment) {
    everywhere([](const Billiard& billiard, const Amount& n) {
        const int check_every = std::max(1, n.particles * n.steps / 40);
        const BilliardTally tally = billiard.aim(n.particles, n.steps, check_every, 5);
        EXPECT_GT(tally.contacts, 0U);
        EXPECT_GT(tally.checked_segments, 0U);
        EXPECT_EQ(tally.crossing_segments, 0U);
    });
}

// The vertex is at the world's origin, where coordinates can be arbitrarily small. Coordinates of nearby positions can
// be far smaller than the rounding error of distances from the triangles at the vertex.
TEST(VertexAtTheOrigin, ContainsParticlesAimedAtItAThousandTimes) {
    const NamedMesh wedge = *mesh_by_name("wedge");
    ASSERT_NE(std::find(wedge.mesh.vertices.begin(), wedge.mesh.vertices.end(), Vec3{}), wedge.mesh.vertices.end());
    const BilliardTally tally = Billiard(wedge, {}).aim(test::scaled(60), 1000, 1 << 30, 4);
    EXPECT_EQ(tally.not_inside, 0U);
    EXPECT_GT(tally.contacts, 0U);
}

// The reference must find the intersection of a segment with a wall, and no intersection of a segment beside the wall.
TEST(SegmentOracle, DistinguishesASegmentThroughAWallFromOneBesideIt) {
    const NamedMesh box = made_meshes().front();
    const Billiard billiard(box, {});
    const Vec3 inside = billiard.start_points(1, 1).front();
    EXPECT_TRUE(oracle_meets(billiard.mesh(), inside, inside + Vec3{100, 0, 0}));
    EXPECT_FALSE(oracle_meets(billiard.mesh(), inside, inside + Vec3{1e-12, 0, 0}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
