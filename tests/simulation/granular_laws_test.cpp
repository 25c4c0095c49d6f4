// Known laws of dense grains: the load on the floor of a silo, the discharge rate of a hopper, and the slope of the
// surface in a drum.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::mesh_collider;
using testing::setup_of;

constexpr double kDiameter = 0.01;  // m, of the mean grain
constexpr double kSpread = 0.1;     // relative spread of the diameters, so that grains do not form crystals
constexpr double kG = 9.81;
constexpr double kPi = std::numbers::pi;

SimulationSetup grain_setup(double duration, double friction, FrameMotion motion) {
    SimulationSetup setup = setup_of(1e-3, duration, {"", 0.3, friction}, {0, 0, -kG});
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.3, .friction = friction};
    FrameDescription frame;
    frame.name = "mover";
    frame.motions = {std::move(motion)};
    setup.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{frame});
    return setup;
}

double grain_mass(double radius) { return 2500.0 * 4.0 / 3.0 * kPi * radius * radius * radius; }

/// Adds separate grains on a lattice around an axis up to the distance `reach`, layer by layer.
void add_cloud(SimulationSetup& setup, std::size_t count, double reach, double bottom, std::uint64_t seed) {
    constexpr double kPitch = (1.0 + kSpread) * 1.02 * kDiameter;
    RandomSequence random(seed, 0, 0);
    const int most = static_cast<int>(reach / kPitch);
    for (int layer = 0; setup.particles.size() < count; ++layer) {
        for (int i = -most; i <= most; ++i) {
            for (int j = -most; j <= most && setup.particles.size() < count; ++j) {
                const Vec3 place{kPitch * i, kPitch * j, bottom + kPitch * (layer + 0.5)};
                if (std::hypot(place.x, place.y) + 0.56 * kDiameter > 0.997 * reach) continue;
                Particle grain;
                grain.radius = 0.5 * kDiameter * (1.0 + kSpread * (2.0 * random.uniform() - 1.0));
                grain.position = place + 0.005 * kDiameter * random.unit_vector();
                grain.mass = grain_mass(grain.radius);
                setup.particles.push_back(grain);
            }
        }
    }
}

/// Returns an upright tube of 48 sides around the axis, in rings of two diameters.
TriangleMesh tube_mesh(double radius, double bottom, double top) {
    constexpr std::uint32_t kSides = 48;
    const auto rings = static_cast<std::uint32_t>(std::ceil((top - bottom) / (2.0 * kDiameter)));
    TriangleMesh mesh;
    for (std::uint32_t ring = 0; ring <= rings; ++ring) {
        for (std::uint32_t k = 0; k < kSides; ++k) {
            const double angle = 2.0 * kPi * k / kSides;
            const double z = bottom + (top - bottom) * ring / rings;
            mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
        }
    }
    for (std::uint32_t ring = 0; ring < rings; ++ring) {
        for (std::uint32_t k = 0; k < kSides; ++k) {
            const std::uint32_t here = ring * kSides + k;
            const std::uint32_t next = ring * kSides + (k + 1) % kSides;
            mesh.triangles.push_back({here, next, next + kSides});
            mesh.triangles.push_back({here, next + kSides, here + kSides});
        }
    }
    return mesh;
}

void expect_sound(const Simulation& simulation) {
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
    EXPECT_LT(simulation.statistics().overlap_largest, 0.01);
}

struct SiloLoad {
    double filled = 0.0;   // kg
    double carried = 0.0;  // kg, supported by the floor
    double density = 0.0;  // kg/m^3, of the column
};

constexpr double kSiloFriction = 0.5;

/// The floor moves down slowly, by one diameter before the measurement and further during it, so that wall friction is
/// fully mobilised. If the floor stops, the column lands on it, and less weight hangs on the wall.
SiloLoad silo_load(double width, std::size_t grains, std::uint64_t seed) {
    constexpr double kSettled = 0.4;
    constexpr double kWeighed = 0.9;
    constexpr double kEnd = 1.1;
    const Vec3 down{0, 0, -kDiameter * (kEnd - kSettled) / (kWeighed - kSettled)};
    const KeyedTranslation lowering{KeyedCurve<Vec3>({{0.0, {}}, {kSettled, {}}, {kEnd, down}})};
    SimulationSetup setup = grain_setup(kEnd, kSiloFriction, lowering);
    setup.colliders = {{"floor", PlaneShape{{}, {0, 0, 1}}, 0, "mover"},
                       mesh_collider(tube_mesh(0.5 * width, -0.02, 0.7))};
    add_cloud(setup, grains, 0.5 * width, 0.0, seed);
    Simulation simulation(std::move(setup));
    double before = 0.0;
    while (!simulation.finished()) {
        simulation.step();
        if (simulation.time() < kWeighed + 0.5e-3) before = simulation.collider_totals()[0].impulse.z;
    }
    expect_sound(simulation);
    SiloLoad load;
    double moment = 0.0;
    for (std::size_t i = 0; i < grains; ++i) {
        load.filled += simulation.particles().mass[i];
        moment += simulation.particles().mass[i] * (simulation.particles().position[i].z - down.z);
    }
    load.carried = (before - simulation.collider_totals()[0].impulse.z) / (kG * (kEnd - kWeighed));
    load.density = load.filled * load.filled / (2.0 * moment * 0.25 * kPi * width * width);
    return load;
}

/// Returns the load, in kg, on the floor under a column of a given mass (Janssen). `most` is the largest possible load.
double janssen(double filled, double most) { return most * (1.0 - std::exp(-filled / most)); }

/// Returns the largest possible load, in kg. The wall supports 4 mu K / D of the stress per metre. K is the ratio of
/// the stress across the axis to the stress along it.
double most_by(double ratio, double density, double width) {
    return density * kPi * width * width * width / (16.0 * kSiloFriction * ratio);
}

/// Returns the largest load, in kg, whose curve is nearest to all measured loads by relative distance.
double fitted_most(std::span<const SiloLoad> loads) {
    double best = 0.0;
    double nearest = INFINITY;
    for (double most = 0.02; most < 2.0; most *= 1.002) {
        double sum = 0.0;
        for (const SiloLoad& load : loads) {
            const double off = load.carried / janssen(load.filled, most) - 1.0;
            sum += off * off;
        }
        if (sum < nearest) nearest = sum, best = most;
    }
    return best;
}

// H. A. Janssen, Z. Ver. Dtsch. Ing. 39 (1895). The floor is lowered first: L. Vanel, E. Clement, Eur. Phys. J. B 11
// (1999). The load is the same while the floor moves: Y. Bertho, F. Giorgiutti-Dauphine, J.-P. Hulin, Phys. Rev. Lett.
// 90 (2003). A short run has one narrow column, with a load that must correspond to a K between 0.3 and 1.
TEST(GranularLaws, LoadOnASiloFloorFollowsJanssensLaw) {
    if (!test::is_long_run()) {
        if (test::scaled(10) < 10) GTEST_SKIP() << "too many grains for such a build";
        constexpr double kNarrow = 4.0 * kDiameter;
        const SiloLoad load = silo_load(kNarrow, 110, 1);
        EXPECT_LT(load.carried, janssen(load.filled, most_by(0.3, load.density, kNarrow)));
        EXPECT_GT(load.carried, janssen(load.filled, most_by(1.0, load.density, kNarrow)));
        return;
    }
    constexpr double kWidth = 8.0 * kDiameter;
    const std::vector<std::size_t> fillings = {200, 400, 650, 950, 1350, 1850};
    std::vector<SiloLoad> loads(fillings.size());
    parallel_for_blocks(fillings.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
        SiloLoad& mean = loads[k];
        for (const std::uint64_t seed : {1U, 2U}) {
            const SiloLoad load = silo_load(kWidth, fillings[k], seed);
            mean.filled += 0.5 * load.filled, mean.carried += 0.5 * load.carried, mean.density += 0.5 * load.density;
        }
    });
    const double most = fitted_most(loads);
    const double ratio = most_by(1.0, loads.back().density, kWidth) / most;
    std::string report = "most " + std::to_string(most) + " K " + std::to_string(ratio);
    for (const SiloLoad& load : loads) {
        EXPECT_NEAR(load.carried / janssen(load.filled, most), 1.0, 0.1) << load.filled;
        report += "; " + std::to_string(load.filled) + " " + std::to_string(load.carried / janssen(load.filled, most));
    }
    EXPECT_GT(ratio, 0.3);
    EXPECT_LT(ratio, 1.0);
    RecordProperty("silo", report);
}

/// Returns a flat sheet around a round hole. The hole is a polygon of the circle's area.
TriangleMesh sheet_with_hole(double width, double outer) {
    constexpr std::uint32_t kCorners = 48;
    const double turn = 2.0 * kPi / kCorners;
    const double inner = 0.5 * width * std::sqrt(turn / std::sin(turn));
    TriangleMesh mesh;
    for (std::uint32_t k = 0; k < kCorners; ++k) {
        for (const double radius : {inner, outer}) {
            mesh.vertices.push_back({radius * std::cos(turn * k), radius * std::sin(turn * k), 0.0});
        }
    }
    for (std::uint32_t k = 0; k < 2 * kCorners; k += 2) {
        const std::uint32_t next = (k + 2) % (2 * kCorners);
        mesh.triangles.push_back({k, k + 1, next + 1});
        mesh.triangles.push_back({k, next + 1, next});
    }
    return mesh;
}

struct Outflow {
    double begin = 0.0;     // s, start of the measurement
    double duration = 0.0;  // s, duration of the measurement
    double bin = 0.0;       // m, width of the flat-bottomed bin
    double height = 0.0;    // m, of the filling
};

/// Returns the grains per second that leave a bin through a hole in its floor.
double outflow(double hole, const Outflow& flow) {
    SimulationSetup setup = grain_setup(flow.begin + flow.duration, 0.5, Spin{});
    setup.colliders = {mesh_collider(sheet_with_hole(hole, flow.bin)),
                       mesh_collider(tube_mesh(0.5 * flow.bin, 0.0, 0.5), {}, "tube")};
    setup.bounds = Box3{{-1, -1, -0.05}, {1, 1, 4}};
    const double volume = 0.25 * kPi * flow.bin * flow.bin * flow.height;
    const auto grains = static_cast<std::size_t>(0.6 * volume / (kPi / 6.0 * kDiameter * kDiameter * kDiameter));
    add_cloud(setup, grains, 0.5 * flow.bin, 0.0, 3);
    Simulation simulation(std::move(setup));
    std::uint64_t before = 0;
    while (!simulation.finished()) {
        simulation.step();
        if (simulation.time() < flow.begin + 0.5e-3) before = simulation.statistics().out_of_bounds;
    }
    expect_sound(simulation);
    return static_cast<double>(simulation.statistics().out_of_bounds - before) / flow.duration;
}

/// Returns slope and intercept of the least-squares line.
std::pair<double, double> line_through(std::span<const double> x, std::span<const double> y) {
    const auto n = static_cast<double>(x.size());
    double sx = 0.0;
    double sy = 0.0;
    double sxx = 0.0;
    double sxy = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) sx += x[k], sy += y[k], sxx += x[k] * x[k], sxy += x[k] * y[k];
    const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    return {slope, (sy - slope * sx) / n};
}

// W. A. Beverloo, H. A. Leniger, J. van de Velde, Chem. Eng. Sci. 15 (1961): the rate is C sqrt(g) (D - k d)^(5/2)
// times the density, with C 0.58 and k 1.4 for spheres. A short run has one hole.
TEST(GranularLaws, DischargeOfAHopperFollowsBeverloosLaw) {
    if (!test::is_long_run()) {
        if (test::scaled(10) < 10) GTEST_SKIP() << "too many grains for such a build";
        const double rate = outflow(6.0 * kDiameter, {0.15, 0.15, 11.0 * kDiameter, 8.0 * kDiameter});
        const double density = 0.58 / (kPi / 6.0 * kDiameter * kDiameter * kDiameter);
        EXPECT_NEAR(rate / (0.58 * density * std::sqrt(kG) * std::pow(4.6 * kDiameter, 2.5)), 1.0, 0.25);
        return;
    }
    const std::vector<double> holes = {5.0, 6.5, 8.0, 10.0};
    std::vector<double> rates(holes.size());
    parallel_for_blocks(holes.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
        // Each measurement counts five hundred grains or more, and the bins are still more than half full.
        const double hole = holes[k];
        const Outflow flow{0.3, std::clamp(1.5 * std::pow(5.0 / hole, 2.5), 0.25, 1.5), (hole + 10.0) * kDiameter,
                           (hole + 5.0) * kDiameter};
        rates[k] = outflow(hole * kDiameter, flow);
    });
    std::vector<double> roots;
    std::vector<double> gaps;
    std::vector<double> logarithms;
    std::string report;
    for (std::size_t k = 0; k < holes.size(); ++k) {
        roots.push_back(std::pow(rates[k], 0.4));
        gaps.push_back(std::log(holes[k] - 1.4)), logarithms.push_back(std::log(rates[k]));
        report += std::to_string(holes[k]) + " " + std::to_string(rates[k]) + "; ";
    }
    const auto [slope, intercept] = line_through(holes, roots);
    const double k = -intercept / slope;
    const double exponent = line_through(gaps, logarithms).first;
    RecordProperty("outflow", report + "k " + std::to_string(k) + " exponent " + std::to_string(exponent));
    EXPECT_GT(k, 1.2);
    EXPECT_LT(k, 1.6);
    EXPECT_NEAR(exponent, 2.5, 0.1);
}

/// Returns the angle, in degrees, between the vertical and the line from the axis of the drum to the centre of the
/// grains. It equals the slope of a flat surface, and is the mean over the last half of the run.
double flowing_angle(double radius, double length, double friction, double duration, std::uint64_t seed = 4) {
    constexpr double kRate = 30.0;  // degrees/s
    SimulationSetup setup = grain_setup(duration, friction, Spin{{0, 1, 0}, kRate});
    setup.materials.push_back({"glass", 0.3, 0.0});
    CylinderShape shell{radius, 2.0 * length, {}};
    shell.placement.rotation_axis = {1, 0, 0};
    shell.placement.rotation_degrees = 90.0;
    // Smooth walls in front and behind support nothing.
    setup.colliders = {{"shell", shell, 0, "mover"},
                       {"front", PlaneShape{{0, -0.5 * length, 0}, {0, 1, 0}}, 1},
                       {"behind", PlaneShape{{0, 0.5 * length, 0}, {0, -1, 0}}, 1}};
    const double filled = 0.35 * kPi * radius * radius * length;
    const auto grains = static_cast<std::size_t>(0.6 * filled / (kPi / 6.0 * kDiameter * kDiameter * kDiameter));
    constexpr double kPitch = (1.0 + kSpread) * 1.02 * kDiameter;
    RandomSequence random(seed, 0, 0);
    const auto across = static_cast<int>(length / kPitch);
    const auto most = static_cast<int>(radius / kPitch);
    for (int z = -most; z <= most; ++z) {
        for (int x = -most; x <= most; ++x) {
            for (int y = 0; y < across && setup.particles.size() < grains; ++y) {
                const Vec3 place = kPitch * Vec3{x + 0.0, y - 0.5 * (across - 1), z + 0.0};
                if (std::hypot(place.x, place.z) + 0.56 * kDiameter > radius) continue;
                Particle grain;
                grain.radius = 0.5 * kDiameter * (1.0 + kSpread * (2.0 * random.uniform() - 1.0));
                grain.position = place + 0.005 * kDiameter * random.unit_vector();
                grain.mass = grain_mass(grain.radius);
                setup.particles.push_back(grain);
            }
        }
    }
    Simulation simulation(std::move(setup));
    Vec3 centre;
    while (!simulation.finished()) {
        simulation.step();
        if (simulation.time() < 0.5 * duration) continue;
        for (const Vec3& position : simulation.particles().position) centre += position;
    }
    expect_sound(simulation);
    return std::atan2(-centre.x, -centre.z) * 180.0 / kPi;
}

// Steady flows of glass beads have friction between tan 20.9 (slow) and tan 32.8 degrees (fast): P. Jop, Y. Forterre,
// O. Pouliquen, Nature 441 (2006). With less friction between the grains, the surface is less steep.
TEST(GranularLaws, SlopeInADrumMatchesGlassBeads) {
    if (test::scaled(10) < 10) GTEST_SKIP() << "too many grains for such a build";
    const bool is_long = test::is_long_run();
    const double radius = (is_long ? 15.0 : 6.0) * kDiameter;
    const double length = (is_long ? 7.0 : 3.0) * kDiameter;
    const double duration = is_long ? 5.0 : 2.4;
    double angle = flowing_angle(radius, length, 0.5, duration);
    // With so few grains and so short a time, the angle varies by some degrees. The mean of three drums varies less.
    if (!is_long) {
        angle += flowing_angle(radius, length, 0.5, duration, 5) + flowing_angle(radius, length, 0.5, duration, 6);
        angle /= 3.0;
    }
    RecordProperty("angle", std::to_string(angle));
    EXPECT_GT(angle, 20.9);
    EXPECT_LT(angle, 32.8);
    if (!is_long) return;
    const double smoother = flowing_angle(radius, length, 0.1, duration);
    RecordProperty("smoother", std::to_string(smoother));
    EXPECT_LT(smoother, angle - 2.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
