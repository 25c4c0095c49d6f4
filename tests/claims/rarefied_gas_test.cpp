// Walls that reflect by the cosine law. Tests the transmission of tubes, chords in a sphere, residence times in a
// vessel, and gas under gravity.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/exact.h"
#include "support/counts.h"
#include "support/statistics.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Sample;

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kBlock = 256;

Material lambert() {
    Material material;
    material.diffuse = 1.0;
    return material;
}

/// Walls of one material, in a scene without forces.
struct Vessel {
    Vessel(std::vector<ColliderDescription> colliders, Material material)
        : world(std::move(colliders)),
          materials{std::move(material)},
          response({world, bodies, forces, materials, settings()}) {}
    static ResponseSettings settings() {
        ResponseSettings settings;
        settings.bounce_budget = 1000000;
        settings.seed = 11;
        return settings;
    }
    CollisionWorld world;
    MovingColliders bodies{world};
    ForceField forces{{}};
    std::vector<Material> materials;
    ExactResponse response;
};

/// Moves the particle in flights of duration `stride` until is_out(position) is true. Returns the particle at that
/// time.
template <class IsOut>
MovingParticle fly_out(const Vessel& vessel, MovingParticle particle, double stride, const IsOut& is_out) {
    MoveScratch scratch;
    while (!is_out(particle.state.position)) {
        scratch.hits.clear();
        (void)vessel.response.move(particle, stride, scratch);
    }
    return particle;
}

/// Returns the side faces of a prism along z with n sides, which is open at both ends.
TriangleMesh open_tube(int n, double radius, double tube_length) {
    TriangleMesh mesh;
    for (int k = 0; k < n; ++k) {
        const double angle = 2.0 * kPi * k / n;
        for (const double z : {0.0, tube_length}) {
            mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
        }
    }
    const auto count = static_cast<std::uint32_t>(n);
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t a = 2 * k;
        const std::uint32_t b = 2 * ((k + 1) % count);
        mesh.triangles.push_back({a, b, b + 1});
        mesh.triangles.push_back({a, b + 1, a + 1});
    }
    return mesh;
}

/// Returns a uniform point in a regular polygon with a corner on the x axis.
Vec3 place_in_polygon(int n, double radius, RandomSequence& random) {
    for (;;) {
        const Vec3 p = radius * random.in_unit_disk();
        const double sector = 2.0 * kPi / n;
        const double angle = std::atan2(p.y, p.x);
        const double off_middle = angle - (std::floor(angle / sector) + 0.5) * sector;
        if (std::hypot(p.x, p.y) * std::cos(off_middle) < (1.0 - 1e-9) * radius * std::cos(0.5 * sector)) return p;
    }
}

/// Returns the fraction of molecules that pass through a tube with L / R = ratio.
Sample transmission(double ratio, int sides, int molecules) {
    // The prism has the cross-sectional area of the circle.
    const double sector = 2.0 * kPi / sides;
    const double radius = std::sqrt(sector / std::sin(sector));
    const Vessel vessel({testing::mesh_collider(open_tube(sides, radius, ratio))}, lambert());
    const auto count = static_cast<std::size_t>(molecules);
    std::vector<char> passed(count);
    parallel_for_blocks(count, kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            RandomSequence random(3, 0, i);
            const Vec3 place = place_in_polygon(sides, radius, random);
            const MovingParticle start{{place, cosine_direction({0, 0, 1}, random), 1.0, 0.0, 0.0}, {}, i, 0};
            const auto is_out = [&](const Vec3& p) { return p.z < 0.0 || p.z > ratio; };
            passed[i] = fly_out(vessel, start, 2.0, is_out).state.position.z > ratio ? 1 : 0;
        }
    });
    Sample sample;
    for (const char value : passed) sample.add(value);
    return sample;
}

struct TubeRow {
    double ratio;
    double transmission;
};

class ClausingTube : public ::testing::TestWithParam<TubeRow> {};
// P. Clausing, Ann. Phys. 12, 1932. The digits come from a numerical solution of the integral equation.
INSTANTIATE_TEST_SUITE_P(Ratios, ClausingTube,
                         ::testing::Values(TubeRow{0.5, 0.801271}, TubeRow{1, 0.671984}, TubeRow{2, 0.514231},
                                           TubeRow{5, 0.310525}, TubeRow{10, 0.190942}, TubeRow{20, 0.109321}),
                         [](const auto& row) {
                             return "LOverR" + std::to_string(static_cast<int>(10.0 * row.param.ratio)) + "Tenths";
                         });

// The tube is a prism of n sides with the cross-sectional area of the circle. Its perimeter is longer by the relative
// amount (pi / n)^2 / 3. The transmission is smaller at most by the same relative amount.
TEST_P(ClausingTube, PassesTheFractionOfTheIntegralEquation) {
    constexpr int kSides = 256;
    const int molecules = test::is_long_run() ? 1000000 : test::scaled(8000);
    const Sample sample = transmission(GetParam().ratio, kSides, molecules);
    const double faceting = GetParam().transmission * (kPi / kSides) * (kPi / kSides);
    EXPECT_NEAR(sample.mean(), GetParam().transmission, 3.0 * sample.error() + faceting);
}

// In a sphere with cosine-law walls, every hit is uniform over the sphere and independent of the previous hit. The
// square of the chord length is uniform in [0, 4 R^2].
TEST(LambertSphere, HitsUniformlyAndIndependentlyOfTheLastHit) {
    const Vessel vessel({{"ball", BallShape{1.0, {}}, 0}}, lambert());
    Sample chord;
    Sample chord_squared;
    Sample same_side;
    std::vector<double> bins(20, 0.0);
    const int molecules = test::scaled(400);
    MoveScratch scratch;
    scratch.record_contacts = true;
    for (int i = 0; i < molecules; ++i) {
        RandomSequence random(4, 0, static_cast<std::uint64_t>(i));
        MovingParticle particle{{{}, random.unit_vector(), 1.0, 0.0, 0.0}, {}, static_cast<std::uint64_t>(i), 0};
        scratch.hits.clear();
        scratch.records.clear();
        (void)vessel.response.move(particle, 200.0, scratch);
        for (std::size_t k = 1; k < scratch.records.size(); ++k) {
            const Vec3& a = scratch.records[k - 1].position;
            const Vec3& b = scratch.records[k].position;
            const double l = length(b - a);
            chord.add(l);
            chord_squared.add(l * l);
            same_side.add(dot(a, b));
            bins[std::min<std::size_t>(19, static_cast<std::size_t>(5.0 * l * l))] += 1.0;
        }
    }
    EXPECT_NEAR(chord.mean(), 4.0 / 3.0, 4.0 * chord.error());
    EXPECT_NEAR(chord_squared.mean(), 2.0, 4.0 * chord_squared.error());
    EXPECT_NEAR(same_side.mean(), 0.0, 4.0 * same_side.error());
    double chi_squared = 0.0;
    const double expected = static_cast<double>(chord.count()) / 20.0;
    for (const double bin : bins) chi_squared += (bin - expected) * (bin - expected) / expected;
    EXPECT_LT(chi_squared, 50.8);  // chi-square limit for 19 degrees of freedom, which random data exceed once in 10^4
                                   // cases
}

/// Returns the unit cube [0, 1]^3 with a square hole |x - 1/2|, |y - 1/2| < half in its bottom.
TriangleMesh cube_with_a_hole(double half) {
    TriangleMesh mesh = {
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
        {{4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}}};
    for (const Vec3 corner : {Vec3{-1, -1, 0}, Vec3{1, -1, 0}, Vec3{1, 1, 0}, Vec3{-1, 1, 0}}) {
        mesh.vertices.push_back(Vec3{0.5, 0.5, 0} + half * corner);
    }
    for (std::uint32_t k = 0; k < 4; ++k) {
        const std::uint32_t next = (k + 1) % 4;
        mesh.triangles.push_back({k, 8 + next, next});
        mesh.triangles.push_back({k, 8 + k, 8 + next});
    }
    return mesh;
}

// A molecule enters a vessel through an opening of area A, with the cosine law. By the mean chord theorem with
// reflections, its mean path length inside is 4 V / A, for any walls. The time constant of effusion is 4 V / (A v).
TEST(Effusion, KeepsAMoleculeInsideForFourVolumesOverTheOpening) {
    const double half = 0.25;
    const double area = 4.0 * half * half;
    for (const Material& wall : {lambert(), Material{"mirror", 1.0, 0.0}}) {
        SCOPED_TRACE(wall.is_random() ? "cosine law" : "mirror");
        const Vessel vessel({testing::mesh_collider(cube_with_a_hole(half))}, wall);
        Sample translation;
        for (int i = 0; i < test::scaled(20000); ++i) {
            RandomSequence random(5, 0, static_cast<std::uint64_t>(i));
            const double x = 2.0 * random.uniform() - 1.0;
            const Vec3 place{0.5 + half * x, 0.5 + half * (2.0 * random.uniform() - 1.0), 0.0};
            const MovingParticle start{
                {place, cosine_direction({0, 0, 1}, random), 1.0, 0.0, 0.0}, {}, static_cast<std::uint64_t>(i), 0};
            const auto is_out = [](const Vec3& p) { return p.z < 0.0; };
            const MovingParticle out = fly_out(vessel, start, 0.5, is_out);
            // The molecule flies straight after it has left the vessel, so the path outside can be subtracted.
            translation.add(out.state.time + out.state.position.z / std::fabs(out.state.velocity.z));
        }
        EXPECT_NEAR(translation.mean(), 4.0 / area, 4.0 * translation.error());
    }
}

// The floor reflects molecules diffusely at temperature T. The heights of the molecules have an exponential
// distribution with mean k T / (m g).
TEST(GasUnderGravity, HasTheBarometricProfileOverADiffuseFloor) {
    constexpr double kBoltzmann = 1.380649e-23;
    constexpr double kTemperature = 300.0;
    constexpr double kMass = kBoltzmann * kTemperature;  // so that k T / m = 1 m^2/s^2
    constexpr double kGravity = 2.0;
    Material floor = lambert();
    floor.wall_temperature = kTemperature;
    const std::vector<Material> materials{floor};
    const CollisionWorld world({testing::plane_collider({0, 0, 0}, {0, 0, 1})});
    std::vector<std::unique_ptr<Force>> list;
    list.push_back(make_gravity({0, 0, -kGravity}));
    const ForceField forces(std::move(list));
    const MovingColliders bodies(world);
    const ExactResponse response({world, bodies, forces, materials, Vessel::settings()});
    Sample height;
    Sample above_scale_height;
    MoveScratch scratch;
    for (int i = 0; i < test::scaled(4000); ++i) {
        RandomSequence random(6, 0, static_cast<std::uint64_t>(i));
        MovingParticle molecule{{{0, 0, 1e-12}, {0, 0, 1}, kMass, 0.0, 0.0}, {}, static_cast<std::uint64_t>(i), 0};
        (void)response.move(molecule, 20.0, scratch);  // a first flight makes the state independent of the start
        double sum = 0.0;
        double above = 0.0;
        for (int k = 0; k < 30; ++k) {
            (void)response.move(molecule, 2.0 + random.uniform(), scratch);
            sum += molecule.state.position.z;
            above += molecule.state.position.z > 1.0 / kGravity ? 1.0 : 0.0;
        }
        scratch.hits.clear();
        height.add(sum / 30.0);
        above_scale_height.add(above / 30.0);
    }
    EXPECT_NEAR(height.mean(), 1.0 / kGravity, 4.0 * height.error());
    EXPECT_NEAR(above_scale_height.mean(), std::exp(-1.0), 4.0 * above_scale_height.error());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
