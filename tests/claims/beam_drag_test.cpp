// Force and torque of a parallel cold beam on bodies. The drag coefficients F / (1/2 rho v^2 A), with the frontal area
// A, are compared with closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "collision/worlds.h"
#include "response/course.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/statistics.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Course;
using testing::Sample;

constexpr double kPi = 3.14159265358979323846;

Material specular() { return {"specular", 1.0, 0.0}; }
Material absorbing() {
    Material material;
    material.absorption = 1.0;
    return material;
}
Material lambert() {
    Material material;
    material.diffuse = 1.0;
    return material;
}

/// Beam along +x through a rectangle of the y-z plane. Its molecules have unit mass and unit speed, and fly one after
/// the other.
struct Beam {
    double y_from, y_to, z_from, z_to;
    [[nodiscard]] double area() const { return (y_to - y_from) * (z_to - z_from); }
};

struct Answer {
    Sample drag;  // F_x / (1/2 rho v^2) per molecule; the mean is the drag coefficient times the frontal area
    Sample lift;
    Sample torque;  // about z, divided by 1/2 rho v^2
};

Answer shine(const std::vector<ColliderDescription>& body, const Material& material, const Beam& beam, int molecules) {
    Course course(body, material, {});
    Answer answer;
    for (int i = 0; i < molecules; ++i) {
        RandomSequence random(9, 0, static_cast<std::uint64_t>(i));
        const double y = beam.y_from + (beam.y_to - beam.y_from) * random.uniform();
        const double z = beam.z_from + (beam.z_to - beam.z_from) * random.uniform();
        MovingParticle molecule{{{-5, y, z}, {1, 0, 0}, 1.0, 0.0, 0.0}, {}, static_cast<std::uint64_t>(i), 0};
        (void)course.move(molecule, 10.0);
        Vec3 impulse;
        for (const SurfaceHit& hit : course.scratch.hits) impulse += hit.impulse;
        Vec3 moment;
        for (const ContactRecord& record : course.scratch.records) {
            moment += cross(record.position, record.mass * (record.velocity_before - record.velocity_after));
        }
        // One molecule per second through the beam's area A gives rho = 1 / (v A).
        answer.drag.add(2.0 * beam.area() * impulse.x);
        answer.lift.add(2.0 * beam.area() * impulse.y);
        answer.torque.add(2.0 * beam.area() * moment.z);
    }
    return answer;
}

void expect_drag(const std::vector<ColliderDescription>& body, const Material& material, const Beam& beam,
                 double coefficient, double frontal_area, double faceting = 0.0) {
    const Answer answer = shine(body, material, beam, test::scaled(60000));
    EXPECT_NEAR(answer.drag.mean(), coefficient * frontal_area,
                4.0 * answer.drag.error() + (faceting + 1e-12) * frontal_area);
    EXPECT_NEAR(answer.lift.mean(), 0.0, 4.0 * answer.lift.error() + 1e-12);
}

// An absorbing plate receives the whole momentum of each molecule. The contact record of an absorbed molecule has zero
// velocity after the impact.
TEST(FlatPlateInABeam, HasDragFourIfSpecularTwoIfAbsorbingAndTenThirdsIfDiffuse) {
    const std::vector<ColliderDescription> plate{{"plate", CuboidShape{{0.02, 1, 1}, {}}, 0}};
    const Beam beam{-0.5, 0.5, -0.5, 0.5};
    expect_drag(plate, specular(), beam, 4.0, 1.0);
    expect_drag(plate, absorbing(), beam, 2.0, 1.0);
    expect_drag(plate, lambert(), beam, 10.0 / 3.0, 1.0);
}

TEST(SphereInABeam, HasDragTwoIfSpecularAndTwentySixNinthsIfDiffuse) {
    const std::vector<ColliderDescription> sphere{{"sphere", BallShape{1.0, {}}, 0}};
    const Beam beam{-1, 1, -1, 1};
    expect_drag(sphere, specular(), beam, 2.0, kPi);
    expect_drag(sphere, lambert(), beam, 26.0 / 9.0, kPi);
    expect_drag(sphere, absorbing(), beam, 2.0, kPi);
}

TEST(CylinderAcrossABeam, HasDragEightThirdsIfSpecular) {
    const std::vector<ColliderDescription> cylinder{{"cylinder", CylinderShape{1.0, 4.0, {}}, 0}};
    expect_drag(cylinder, specular(), {-1, 1, -1, 1}, 8.0 / 3.0, 4.0);
}

/// Returns a cone of half angle 30 degrees with its tip towards the beam.
TriangleMesh cone(int sides) {
    TriangleMesh mesh{{{0, 0, 0}}, {}};
    const auto n = static_cast<std::uint32_t>(sides);
    const double height = std::sqrt(3.0);
    for (std::uint32_t k = 0; k < n; ++k) {
        const double angle = 2.0 * kPi * k / n;
        mesh.vertices.push_back({height, std::cos(angle), std::sin(angle)});
    }
    for (std::uint32_t k = 0; k < n; ++k) mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % n});
    return mesh;
}

TEST(ConeInABeam, HasDragFourTimesTheSquaredSineOfItsHalfAngleIfSpecular) {
    constexpr int kSides = 512;
    // The facets are less steep than the cone. The tangent of their inclination is smaller by the factor cos(pi / n).
    // The area of the polygon is smaller than the circle's by the relative amount 2 (pi / n)^2 / 3.
    const double faceting = 4.0 * (kPi / kSides) * (kPi / kSides);
    expect_drag({testing::mesh_collider(cone(kSides))}, specular(), {-1, 1, -1, 1}, 1.0, kPi, faceting);
}

// The beam hits the half y > 0 of a plate. The torque about z is minus the force times the mean lever arm.
TEST(HalfLitPlate, HasATorqueOfTheForceTimesItsLeverArm) {
    const std::vector<ColliderDescription> plate{{"plate", CuboidShape{{0.02, 1, 1}, {}}, 0}};
    const Answer answer = shine(plate, specular(), {0.0, 0.5, -0.5, 0.5}, test::scaled(60000));
    EXPECT_NEAR(answer.drag.mean(), 4.0 * 0.5, 1e-12);
    EXPECT_NEAR(answer.torque.mean(), -4.0 * 0.5 * 0.25, 4.0 * answer.torque.error());
}

// The totals per triangle that a simulation records add up to the same force.
TEST(ImpulsePerTriangle, AddsUpToTheForceOnThePlate) {
    SimulationSetup setup;
    setup.options.duration = 10.0;
    setup.options.time_step = 10.0;
    setup.materials.push_back(specular());
    setup.colliders.push_back({"plate", CuboidShape{{0.02, 1, 1}, {}}, 0});
    const int molecules = test::scaled(2000);
    for (int i = 0; i < molecules; ++i) {
        RandomSequence random(10, 0, static_cast<std::uint64_t>(i));
        Particle molecule;
        const double y = random.uniform() - 0.5;
        molecule.position = {-5, y, random.uniform() - 0.5};
        molecule.velocity = {1, 0, 0};
        setup.particles.push_back(molecule);
    }
    Simulation simulation(std::move(setup));
    simulation.step();
    const TriangleTotals totals = simulation.triangle_totals(0);
    Vec3 sum;
    std::uint64_t hits = 0;
    for (const Vec3& impulse : totals.impulse) sum += impulse;
    for (const std::uint64_t count : totals.hits) hits += count;
    EXPECT_EQ(hits, static_cast<std::uint64_t>(molecules));
    EXPECT_NEAR(length(sum - Vec3{2.0 * molecules, 0, 0}), 0.0, 1e-9 * molecules);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
