#include "ricochet/dynamics/springs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "ricochet/core/error.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

double total_mass(const SpringBody& body) {
    double sum = 0.0;
    for (const Particle& particle : body.particles) sum += particle.mass;
    return sum;
}

double distance(const SpringBody& body, const Spring& spring) {
    return length(body.particles[spring.second].position - body.particles[spring.first].position);
}

RopeSettings rope_of(std::size_t nodes) {
    RopeSettings rope;
    rope.to = {3, 0, 4};
    rope.nodes = nodes;
    rope.mass = 2.0;
    rope.stiffness = 100.0;
    return rope;
}

template <typename Call>
std::string refusal(Call&& call) {
    try {
        (void)call();
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

TEST(Rope, IsAStraightLineOfEqualSegmentsAtRest) {
    RopeSettings settings = rope_of(6);
    settings.radius = 0.1;
    settings.damping = 0.5;
    settings.breaking_stretch = 2.0;
    settings.pin_from = true;
    const SpringBody rope = make_rope(settings);
    ASSERT_EQ(rope.particles.size(), 6U);
    ASSERT_EQ(rope.springs.size(), 5U);
    EXPECT_EQ(rope.particles.front().position, Vec3{});
    EXPECT_EQ(rope.particles.back().position, (Vec3{3, 0, 4}));
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(rope.springs[i].first, i);
        EXPECT_EQ(rope.springs[i].second, i + 1);
        EXPECT_DOUBLE_EQ(rope.springs[i].rest_length, 1.0);
        EXPECT_NEAR(distance(rope, rope.springs[i]), 1.0, 1e-15);
        EXPECT_EQ(rope.springs[i].damping, 0.5);
        EXPECT_EQ(rope.springs[i].breaking_stretch, 2.0);
        EXPECT_EQ(rope.particles[i].id, i);
        EXPECT_EQ(rope.particles[i].radius, 0.1);
        EXPECT_EQ(rope.particles[i].pinned, i == 0);
    }
    EXPECT_TRUE(rope.faces.empty());
}

TEST(Rope, SplitsItsMassByLengthSoThatEndsHaveHalf) {
    const SpringBody rope = make_rope(rope_of(5));
    EXPECT_DOUBLE_EQ(total_mass(rope), 2.0);
    EXPECT_DOUBLE_EQ(rope.particles[0].mass, 0.25);
    EXPECT_DOUBLE_EQ(rope.particles[2].mass, 0.5);
    EXPECT_DOUBLE_EQ(rope.particles[4].mass, 0.25);
}

TEST(Rope, HasTheStiffnessOfItsMaterialForAnyNumberOfSegments) {
    for (const std::size_t nodes : {2U, 5U, 40U}) {
        RopeSettings settings = rope_of(nodes);
        settings.stiffness.reset();
        settings.axial_stiffness = 1000.0;
        double compliance = 0.0;
        for (const Spring& spring : make_rope(settings).springs) compliance += 1.0 / spring.stiffness;
        EXPECT_NEAR(1.0 / compliance, 1000.0 / 5.0, 1e-10);
    }
}

TEST(Rope, LongerThanTheDistanceHangsAsACatenary) {
    RopeSettings settings = rope_of(401);
    settings.to = {2, 0, 0};
    settings.length = 2.0 * std::sinh(1.0);  // the catenary y = cosh(x) between x = -1 and 1
    const SpringBody rope = make_rope(settings);
    double along = 0.0;
    for (const Spring& spring : rope.springs) along += distance(rope, spring);
    EXPECT_NEAR(along, *settings.length, 1e-5);
    for (const Particle& node : rope.particles) {
        EXPECT_NEAR(node.position.z, std::cosh(node.position.x - 1.0) - std::cosh(1.0), 1e-12);
        EXPECT_NEAR(node.position.y, 0.0, 1e-15);
    }
}

TEST(Rope, KeepsItsLengthAndEndPoints) {
    for (const Vec3& to : {Vec3{3, 0, 4}, Vec3{0, 0, -2}, Vec3{0, 0, 2}, Vec3{0.001, -5, 1}, Vec3{1, 1, -1}}) {
        for (const double slack : {1.0, 1.0000000001, 1.0001, 1.5, 30.0}) {
            RopeSettings settings = rope_of(2001);
            settings.to = to;
            settings.length = slack * length(to);
            const SpringBody rope = make_rope(settings);
            double along = 0.0;
            for (const Spring& spring : rope.springs) along += distance(rope, spring);
            EXPECT_NEAR(along, *settings.length, 2e-3 * *settings.length) << to.x << " " << slack;
            EXPECT_EQ(rope.particles.back().position, to);
            // There is no kink at the end: the last segment is as long as its neighbours.
            EXPECT_LE(distance(rope, rope.springs.back()), 1.001 * rope.springs.back().rest_length) << slack;
        }
    }
}

TEST(Rope, SagsInTheDirectionGiven) {
    RopeSettings settings = rope_of(11);
    settings.to = {0, 0, 2};
    settings.length = 3.0;
    settings.sag = {0, -2, 0};
    const SpringBody rope = make_rope(settings);
    EXPECT_LT(rope.particles[5].position.y, -0.5);
    EXPECT_NEAR(rope.particles[5].position.z, 1.0, 1e-12);
    EXPECT_EQ(rope.particles[5].position.x, 0.0);
}

TEST(Rope, ShorterThanTheDistanceStartsUnderTension) {
    RopeSettings settings = rope_of(6);
    settings.length = 4.0;
    const SpringBody rope = make_rope(settings);
    EXPECT_DOUBLE_EQ(rope.springs[0].rest_length, 0.8);
    EXPECT_NEAR(distance(rope, rope.springs[0]), 1.0, 1e-15);
}

TEST(Rope, RefusesValuesOutOfRange) {
    const auto refused = [](auto change) {
        RopeSettings settings = rope_of(5);
        change(settings);
        return refusal([&] { return make_rope(settings); });
    };
    EXPECT_EQ(refused([](RopeSettings& rope) { rope.nodes = 1; }), "rope: it needs at least 2 nodes, found 1");
    EXPECT_NE(refused([](RopeSettings& rope) { rope.mass = 0.0; }), "");
    EXPECT_NE(refused([](RopeSettings& rope) { rope.to = {}; }), "");
    EXPECT_NE(refused([](RopeSettings& rope) { rope.length = -1.0; }), "");
    EXPECT_NE(refused([](RopeSettings& rope) { rope.axial_stiffness = 1.0; }), "");
    EXPECT_NE(refused([](RopeSettings& rope) { rope.stiffness.reset(); }), "");
    EXPECT_NE(refused([](RopeSettings& rope) { rope.sag = {}; }), "");
    EXPECT_NE(refused([](RopeSettings& rope) { rope.breaking_stretch = 0.0; }), "");
    EXPECT_EQ(refused([](RopeSettings&) {}), "");
}

TEST(Cloth, HasASpringForEveryEdgeAndABendingSpringAcrossEveryInnerOne) {
    const TriangleMesh sphere = testing::sphere_mesh({}, 1.0, 2);
    ClothSettings settings;
    settings.stiffness = 10.0;
    settings.bending_stiffness = 2.0;
    settings.breaking_stretch = 0.5;
    const SpringBody cloth = make_cloth(sphere, settings);
    const std::size_t vertices = sphere.vertices.size();
    const std::size_t faces = sphere.triangles.size();
    const std::size_t edges = vertices + faces - 2;  // Euler's formula
    ASSERT_EQ(cloth.particles.size(), vertices);
    ASSERT_EQ(cloth.springs.size(), 2 * edges);
    EXPECT_EQ(cloth.faces.size(), faces);
    for (std::size_t i = 0; i < cloth.springs.size(); ++i) {
        EXPECT_EQ(cloth.springs[i].stiffness, i < edges ? 10.0 : 2.0);
        EXPECT_DOUBLE_EQ(cloth.springs[i].rest_length, distance(cloth, cloth.springs[i]));
        EXPECT_EQ(std::isfinite(cloth.springs[i].breaking_stretch), i < edges);
    }
    EXPECT_NEAR(total_mass(cloth), surface_area(sphere), 1e-12);
}

TEST(Cloth, FacesNameTheSpringsAlongTheirEdges) {
    const SpringBody cloth = make_cloth(sheet_mesh({}, {1, 0, 0}, {0, 1, 0}, 3, 2), {});
    ASSERT_EQ(cloth.faces.size(), 12U);
    for (const SpringFace& face : cloth.faces) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Spring& spring = cloth.springs[face.springs[k]];
            EXPECT_EQ((std::set<std::uint64_t>{spring.first, spring.second}),
                      (std::set<std::uint64_t>{face.corners[k], face.corners[(k + 1) % 3]}));
        }
    }
}

TEST(Cloth, HasASpringForEveryEdgeOfASheet) {
    const TriangleMesh sheet = sheet_mesh({1, 2, 3}, {4, 0, 0}, {0, 3, 0}, 4, 3);
    EXPECT_EQ(sheet.vertices.size(), 20U);
    EXPECT_EQ(sheet.triangles.size(), 24U);
    EXPECT_DOUBLE_EQ(surface_area(sheet), 12.0);
    EXPECT_EQ(sheet.vertices[19], (Vec3{5, 5, 3}));
    ClothSettings settings;
    settings.stiffness = 1.0;
    settings.pinned = {0, 4};
    const std::size_t edges = 20 + 24 - 1;  // Euler's formula for a disk
    const SpringBody plain = make_cloth(sheet, settings);
    EXPECT_EQ(plain.springs.size(), edges);
    EXPECT_TRUE(plain.particles[0].pinned);
    EXPECT_TRUE(plain.particles[4].pinned);
    EXPECT_FALSE(plain.particles[1].pinned);
    settings.bending_stiffness = 1.0;
    EXPECT_EQ(make_cloth(sheet, settings).springs.size(), edges + (edges - 14));  // 14 edges are on the rim
}

TEST(Cloth, HasNoBendingSpringIfThreeFacesShareAnEdge) {
    const TriangleMesh fins{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}},
                            {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
    ClothSettings settings;
    settings.stiffness = 1.0;
    settings.bending_stiffness = 1.0;
    EXPECT_EQ(make_cloth(fins, settings).springs.size(), 7U);
}

TEST(Cloth, RefusesUnsuitableMeshes) {
    const TriangleMesh sheet = sheet_mesh({}, {1, 0, 0}, {0, 1, 0}, 1, 1);
    TriangleMesh stray = sheet;
    stray.vertices.push_back({9, 9, 9});
    EXPECT_NE(refusal([&] { return make_cloth(stray, {}); }).find("vertex 4"), std::string::npos);
    EXPECT_NE(refusal([&] { return make_cloth(TriangleMesh{}, {}); }), "");
    ClothSettings settings;
    settings.pinned = {4};
    EXPECT_EQ(refusal([&] { return make_cloth(sheet, settings); }),
              "cloth: there is no vertex 4 to pin, the mesh has 4 (numbered from 0)");
    settings = {};
    settings.mass_per_area = 0.0;
    EXPECT_NE(refusal([&] { return make_cloth(sheet, settings); }), "");
    EXPECT_THROW((void)sheet_mesh({}, {1, 0, 0}, {2, 0, 0}, 1, 1), InputError);
    EXPECT_THROW((void)sheet_mesh({}, {1, 0, 0}, {0, 1, 0}, 1, 0), InputError);
}

TEST(SpringBody, AppendsBodiesWithShiftedIdsAndSprings) {
    SpringBody body = make_rope(rope_of(3));
    body.append(make_cloth(sheet_mesh({}, {1, 0, 0}, {0, 1, 0}, 1, 1), {}));
    ASSERT_EQ(body.particles.size(), 7U);
    for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(body.particles[i].id, i);
    ASSERT_EQ(body.springs.size(), 7U);
    EXPECT_EQ(body.springs[1].second, 2U);
    EXPECT_EQ(body.springs[2].first, 3U);
    for (const SpringFace& face : body.faces) {
        const Spring& spring = body.springs[face.springs[0]];
        EXPECT_EQ((std::set<std::uint64_t>{spring.first, spring.second}),
                  (std::set<std::uint64_t>{face.corners[0], face.corners[1]}));
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
