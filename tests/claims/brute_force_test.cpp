// Compares the program, which culls triangles, with a reference that applies the same rules to every triangle. The
// meshes, particles and steps are random.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/random_draws.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// A random case that depends only on its number.
class RandomCase {
public:
    explicit RandomCase(std::uint64_t seed) : random_(seed, 21, 0) {}

    SimulationSetup setup() {
        SimulationSetup setup;
        const auto kinds = std::array{IntegratorKind::ballistic, IntegratorKind::symplectic_euler,
                                      IntegratorKind::midpoint, IntegratorKind::rk4};
        setup.options.integrator = kinds[pick(4)];
        setup.options.time_step = std::array{1e-3, 0.02, 0.1, 0.5}[pick(4)];
        setup.options.duration = 12.0 * setup.options.time_step;
        setup.options.record_contacts = true;
        if (pick(4) != 0) setup.forces.push_back(make_gravity(testing::random_vector(random_, 4.0)));
        if (pick(2) == 0) setup.forces.push_back(make_linear_drag(random_.uniform()));
        setup.materials.push_back({"wall", pick(2) == 0 ? 1.0 : random_.uniform(), pick(2) == 0 ? 0.0 : 0.3});
        setup.colliders.push_back({"mesh", MeshShape{mesh(), {}, "", {}}, 0});
        if (pick(3) == 0) setup.colliders.push_back({"floor", PlaneShape{{0, 0, -0.9}, random_.unit_vector()}, 0});
        if (pick(3) == 0) setup.colliders.push_back({"ball", BallShape{0.4, {}}, 0});
        const double largest = std::array{0.0, 1e-6, 0.02, 0.2}[pick(4)];
        for (int i = 0; i < 25; ++i) setup.particles.push_back(particle(largest));
        return setup;
    }

private:
    std::size_t pick(int count) { return static_cast<std::size_t>(random_.uniform() * count); }

    Particle particle(double largest_radius) {
        Particle particle;
        particle.position = place();
        particle.velocity = testing::scaled({random_.unit_vector(), std::array{0.1, 1.0, 10.0}[pick(3)]});
        particle.radius = pick(2) == 0 ? largest_radius : largest_radius * random_.uniform();
        return particle;
    }

    Vec3 place() {
        const double x = random_.uniform();
        const double y = random_.uniform();
        return {2.0 * x - 1.0, 2.0 * y - 1.0, 2.0 * random_.uniform() - 1.0};
    }

    /// Returns a triangle soup, a crumpled ball, or slivers.
    std::shared_ptr<const TriangleMesh> mesh() {
        auto result = std::make_shared<TriangleMesh>();
        const std::size_t kind = pick(3);
        if (kind == 1) {
            *result = testing::sphere_mesh({}, 1.2, 2);
            for (Vec3& v : result->vertices) v *= 1.0 + 0.2 * random_.uniform();
            return result;
        }
        for (std::uint32_t k = 0; k < 60; ++k) {
            const Vec3 corner = place();
            const double size = kind == 0 ? 0.3 : 1.0;
            const Vec3 side = size * random_.unit_vector();
            const Vec3 width = (kind == 0 ? size : 1e-4) * random_.unit_vector();
            result->vertices.insert(result->vertices.end(), {corner, corner + side, corner + width});
            result->triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
        }
        return result;
    }

    RandomSequence random_;
};

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

void expect_same_impacts(const Simulation& a, const Simulation& b) {
    ASSERT_EQ(a.contact_records().size(), b.contact_records().size());
    for (std::size_t k = 0; k < a.contact_records().size(); ++k) {
        const ContactRecord& x = a.contact_records()[k];
        const ContactRecord& y = b.contact_records()[k];
        ASSERT_EQ(x.surface, y.surface) << k;
        ASSERT_EQ(x.particle, y.particle) << k;
        ASSERT_EQ(bits(x.time), bits(y.time)) << k;
    }
}

TEST(Culling, ChangesNoImpactAndNoBitOfTheStateInRandomCases) {
    std::uint64_t impacts = 0;
    for (int i = 0; i < test::scaled(100); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        const auto seed = static_cast<std::uint64_t>(i);
        SimulationSetup every_triangle = RandomCase(seed).setup();
        every_triangle.acceleration.culling = false;
        Simulation reference(std::move(every_triangle));
        Simulation simulation(RandomCase(seed).setup());
        while (!simulation.finished()) {
            simulation.step();
            reference.step();
            expect_same_impacts(simulation, reference);
            ASSERT_EQ(simulation.state_hash(), reference.state_hash()) << "step " << simulation.step_index();
            if (HasFatalFailure()) return;
        }
        impacts += simulation.statistics().contacts;
    }
    EXPECT_GT(impacts, static_cast<std::uint64_t>(test::scaled(100)) * 10);  // the test must contain impacts
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
