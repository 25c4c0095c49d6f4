// No particle leaks in very many bounces. Cases are random: placements of meshes, points and spheres, all integrators,
// materials with and without losses, and flows along both kinds of walls. The independent verifier checks every step.
//
// A long run has about 10^8 bounces in total. RICOCHET_BOUNCES sets the number of bounces for each mesh.
// RICOCHET_BOUNCE_LOG names a log file of counts, from which a later run continues. RICOCHET_SEED=... selects a single
// case.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "claims/hard_meshes.h"
#include "collision/worlds.h"
#include "ricochet/collision_queries.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/shared_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr int kParticles = 100;
constexpr int kSteps = 300;
constexpr double kFast = 1e4;  // in m/s; the program ends a run beyond the speed of light

/// Progress of the test with one mesh.
struct Count {
    std::uint64_t next_seed = 0;
    std::uint64_t bounces = 0;
    double seconds = 0.0;
};

const char* setting(const char* name) { return std::getenv(name); }  // NOLINT(concurrency-mt-unsafe): no code sets it

/// Reads the progress from the log. Each line has a mesh, the next seed, and the total bounces and seconds. Only the
/// last line of a mesh is used.
Count count_from_log(const std::string& mesh) {
    Count count;
    if (setting("RICOCHET_BOUNCE_LOG") == nullptr) return count;
    std::ifstream file(setting("RICOCHET_BOUNCE_LOG"));
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string name;
        Count read;
        if (words >> name >> read.next_seed >> read.bounces >> read.seconds && name == mesh) count = read;
    }
    return count;
}

void write_to_log(const std::string& mesh, const Count& count) {
    if (setting("RICOCHET_BOUNCE_LOG") == nullptr) return;
    std::ofstream file(setting("RICOCHET_BOUNCE_LOG"), std::ios::app);
    file << mesh << ' ' << count.next_seed << ' ' << count.bounces << ' ' << count.seconds << '\n';
}

/// Returns the number of bounces for each mesh. In a long run, 13 meshes together have about a hundred million bounces.
std::uint64_t bounces_wanted() {
    if (const char* wanted = setting("RICOCHET_BOUNCES")) return std::stoull(wanted);
    return static_cast<std::uint64_t>(test::scaled(2'000)) * static_cast<std::uint64_t>(test::case_factor(4'000));
}

/// Random choices that define a case.
class Case {
public:
    Case(const NamedMesh& mesh, std::uint64_t seed) : random_(seed, 41, 0), mesh_(mesh) {
        const Box3 box = bounds(mesh.mesh);
        const double scale = chance(0.5) ? std::ldexp(1.0, static_cast<int>(pick(81)) - 40) : 1.0;
        const double away = chance(0.7) ? std::pow(10.0, 6.0 * random_.uniform()) : 0.0;
        placement_.scale = {scale, scale, scale};
        placement_.rotation_axis = random_.unit_vector();
        placement_.rotation_degrees = 360.0 * random_.uniform();
        size_ = scale * box.diagonal();
        placement_.position = away * size_ * random_.unit_vector();
    }

    SimulationSetup setup() {
        SimulationSetup setup;
        setup.options.verify = true;
        setup.colliders.push_back(
            {mesh_.name, MeshShape{std::make_shared<const TriangleMesh>(mesh_.mesh), placement_, "", {}}, 0});
        const double restitution = std::array{1.0, 1.0, 0.95, 0.6}[pick(4)];
        const bool has_gravity = chance(0.5);
        // Without losses, friction and gravity make particles bounce endlessly in a crease, which costs a thousand
        // bounces per step. Such cases get no friction.
        const bool rattles = has_gravity && restitution == 1.0;
        setup.materials = {{"", restitution, rattles || chance(0.5) ? 0.0 : 0.4 * random_.uniform()}};
        const double stride = (0.05 + 0.3 * random_.uniform()) * size_;
        const double step = std::max(1.0, stride / kFast);
        setup.options.time_step = step;
        setup.options.duration = kSteps * step;
        chance(0.25) ? add_flow(setup, stride / step) : add_forces(setup, stride / step, has_gravity);
        add_particles(setup, stride / step);
        return setup;
    }

private:
    bool chance(double probability) { return random_.uniform() < probability; }
    std::size_t pick(std::size_t count) {
        return static_cast<std::size_t>(random_.uniform() * static_cast<double>(count));
    }

    void add_flow(SimulationSetup& setup, double speed) {
        TurbulenceSettings eddies;
        eddies.seed = pick(1000);
        eddies.speed = speed;
        eddies.length = (0.1 + 0.4 * random_.uniform()) * size_;
        eddies.rate = (chance(0.5) ? 0.0 : 0.2) / setup.options.time_step;
        setup.options.flow = make_turbulence(eddies);
        setup.options.walls = chance(0.5) ? WallRule::slide : WallRule::stop;
        setup.options.integrator =
            std::array{IntegratorKind::forward_euler, IntegratorKind::midpoint, IntegratorKind::rk4}[pick(3)];
    }

    void add_forces(SimulationSetup& setup, double speed, bool has_gravity) {
        using enum IntegratorKind;
        setup.options.integrator =
            std::array{forward_euler, symplectic_euler, implicit_euler, midpoint, velocity_verlet,
                       rk4,           dormand_prince,   ballistic}[pick(8)];
        if (setup.options.integrator.kind == dormand_prince) {
            setup.options.integrator =
                Integrator(dormand_prince, {1e-6 * size_, 1e-6 * size_ / setup.options.time_step});
        }
        setup.options.resting_speed = 1e-3 * speed;
        const Vec3 gravity = 0.3 * speed / setup.options.time_step * random_.unit_vector();
        if (has_gravity) setup.forces.push_back(make_gravity(gravity));
    }

    /// Adds particles inside the mesh that do not touch its surface.
    void add_particles(SimulationSetup& setup, double speed) {
        const CollisionQueries queries(setup.colliders);
        const AffineMap map = world_from_local(placement_);
        const Box3 box = bounds(mesh_.mesh);
        const Vec3 extent = box.size();
        for (int k = 0; k < kParticles; ++k) {
            Particle particle;
            particle.radius = k % 2 == 0 ? 0.0 : 0.02 * random_.uniform() * size_;
            for (int draw = 0; draw < 500; ++draw) {
                const double x = random_.uniform();
                const double y = random_.uniform();
                const Vec3 inside{x * extent.x, y * extent.y, random_.uniform() * extent.z};
                particle.position = map.point(box.lower + inside);
                if (!queries.is_inside(particle.position)) continue;
                if (particle.radius > 0.0 && queries.closest_point(particle.position, 1.01 * particle.radius)) continue;
                particle.velocity = (0.5 + random_.uniform()) * speed * random_.unit_vector();
                setup.particles.push_back(particle);
                break;
            }
        }
    }

    RandomSequence random_;
    const NamedMesh& mesh_;
    Placement placement_;
    double size_ = 0.0;  // diagonal of the mesh in the world, in m
};

/// Runs one case and checks it. Returns the number of bounces.
std::uint64_t run_case(const NamedMesh& mesh, std::uint64_t seed) {
    SCOPED_TRACE(mesh.name + ", RICOCHET_SEED=" + std::to_string(seed));
    Simulation simulation(Case(mesh, seed).setup());
    while (!simulation.finished()) simulation.step();
    const SimulationStatistics& statistics = simulation.statistics();
    EXPECT_EQ(statistics.violations, 0U);
    for (const Violation& violation : simulation.violations()) {
        const bool is_of_impacts = violation.kind == ViolationKind::energy;
        if (is_of_impacts) continue;  // other tests check the energy
        ADD_FAILURE() << "kind " << static_cast<int>(violation.kind) << " of particle " << violation.particle << " at "
                      << violation.time << " s, triangle " << violation.triangle.value_or(0);
        break;
    }
    EXPECT_EQ(statistics.frozen, 0U);
    EXPECT_EQ(statistics.started_inside, 0U);
    return statistics.contacts;
}

class ManyBounces : public ::testing::TestWithParam<std::string> {};

TEST_P(ManyBounces, LeaveEveryParticleOnItsSide) {
    const auto mesh = mesh_by_name(GetParam());
    if (!mesh) GTEST_SKIP() << missing_mesh_sentence(GetParam());
    if (const char* one = setting("RICOCHET_SEED")) {
        EXPECT_GT(run_case(*mesh, std::stoull(one)), 0U);
        return;
    }
    Count count = count_from_log(mesh->name);
    while (count.bounces < bounces_wanted() && !HasFailure()) {
        const auto start = std::chrono::steady_clock::now();
        count.bounces += run_case(*mesh, count.next_seed++);
        count.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        write_to_log(mesh->name, count);
    }
}

// In one case, points accumulate in a gap of a third of a degree, where friction stops them. In another case they
// accumulate beside a vertex at the origin, where coordinates can be arbitrarily small. Each of these cases once took
// minutes.
TEST(ManyBouncesOfOneCaseLong, EndIfPointsAccumulate) {
    if (test::kSanitized) GTEST_SKIP() << "some minutes in such a build";
    const std::array<std::pair<const char*, std::uint64_t>, 3> cases{
        {{"flat", 2'000'029}, {"wedge", 11'000'000}, {"box", 498}}};
    for (const auto& [name, seed] : cases) EXPECT_GT(run_case(*mesh_by_name(name), seed), 0U);
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
    std::string name = info.param.substr(0, info.param.find('.'));
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(In, ManyBounces,
                         ::testing::Values("box", "sphere", "flat", "star", "shell", "wedge", "bunny-closed.off",
                                           "armadillo.obj", "spot.obj", "fandisk.obj", "quadknot.obj", "ADIS16480.stl",
                                           "self_intersectA.obj"),
                         test_name);

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
