// Distributions, directions, thermal velocities, densities and times of births in scenes.
#include <gtest/gtest.h>

#include <string>

#include "io/sample_scene.h"
#include "ricochet/io/scene.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::SampleFolder;

std::string scene_of(const std::string& keys, const std::string& shape = R"("type": "point", "burst": 10)") {
    return R"({"ricochet": 1, "simulation": {"duration": 1}, "emitters": [{)" + shape + ", " + keys + "}]}";
}

EmitterDescription emitter_of(const std::string& keys, const std::string& shape) {
    const SampleFolder folder;
    return parse_scene(scene_of(keys, shape), folder.path("s.json")).setup.emitters.at(0);
}

std::string error_of(const std::string& keys) {
    const SampleFolder folder;
    try {
        (void)parse_scene(scene_of(keys), folder.path("s.json"));
        return "";
    } catch (const SceneError& error) {
        return error.messages().empty() ? "" : error.messages().front();
    }
}

const char* const kDisk = R"("type": "disk", "normal": [0, 0, 1], "radius": 1, "rate": 5)";

TEST(EmitterLaunchScene, ReadsEveryLaw) {
    const auto law_of = [](const std::string& text) { return emitter_of("\"speed\": " + text, kDisk).speed; };
    const Distribution uniform = *law_of(R"({"type": "uniform", "min": 1, "max": 2})").distribution;
    EXPECT_EQ(uniform.law, DistributionLaw::uniform);
    EXPECT_EQ(uniform.max, 2.0);
    const Distribution normal = *law_of(R"({"type": "normal", "mean": 1, "deviation": 2, "max": 5})").distribution;
    EXPECT_EQ(normal.law, DistributionLaw::normal);
    EXPECT_EQ(normal.center, 1.0);
    EXPECT_EQ(normal.width, 2.0);
    EXPECT_EQ(normal.max, 5.0);
    EXPECT_FALSE(normal.min.has_value());
    const DrawnValue cut = law_of(R"({"type": "truncated_normal", "mean": 1, "deviation": 2, "min": 0, "max": 5})");
    EXPECT_EQ(cut.distribution->law, DistributionLaw::normal);
    EXPECT_EQ(cut.distribution->min, 0.0);
    const Distribution logs = *law_of(R"({"type": "log_normal", "median": 3, "geometric_deviation": 2})").distribution;
    EXPECT_EQ(logs.law, DistributionLaw::log_normal);
    EXPECT_EQ(logs.center, 3.0);
    EXPECT_EQ(law_of(R"({"type": "exponential", "mean": 4})").distribution->law, DistributionLaw::exponential);
    const Distribution rosin = *law_of(R"({"type": "rosin_rammler", "scale": 5, "exponent": 3})").distribution;
    EXPECT_EQ(rosin.law, DistributionLaw::rosin_rammler);
    EXPECT_EQ(rosin.width, 3.0);
    const std::string points = R"("points": [{"value": 1, "weight": 2}, {"value": 3, "weight": 4}])";
    EXPECT_EQ(law_of(R"({"type": "table", )" + points + "}").distribution->law, DistributionLaw::values);
    const Distribution table = *law_of(R"({"type": "table", "linear": true, )" + points + "}").distribution;
    EXPECT_EQ(table.law, DistributionLaw::density);
    EXPECT_EQ(table.table.at(1).weight, 4.0);
}

TEST(EmitterLaunchScene, ReadsEveryKey) {
    const EmitterDescription gas = emitter_of(
        R"("thermal": {"law": "effusion", "temperature": 300, "molecule_mass": 5e-26, "drift": 40}, "births": "poisson")",
        kDisk);
    EXPECT_EQ(gas.thermal->law, ThermalLaw::effusion);
    EXPECT_EQ(gas.thermal->drift, 40.0);
    EXPECT_EQ(gas.spacing, BirthSpacing::poisson);
    const EmitterDescription grains = emitter_of(
        R"("density": 2500, "particle_radius": {"type": "rosin_rammler", "scale": 1e-3, "exponent": 3, "min": 1e-4,
           "by": "mass"}, "lifetime": {"type": "exponential", "mean": 2}, "direction_law": "cosine")",
        kDisk);
    EXPECT_EQ(grains.density, 2500.0);
    EXPECT_EQ(grains.radius.distribution->by, DistributionBasis::mass);
    EXPECT_EQ(grains.lifetime.distribution->center, 2.0);
    EXPECT_EQ(grains.direction_law, DirectionLaw::cosine);
    EXPECT_EQ(grains.cone_degrees, 90.0);
    EXPECT_EQ(emitter_of(R"("direction_law": "cosine", "cone": 20)", kDisk).cone_degrees, 20.0);
    const EmitterDescription rising =
        emitter_of(R"("rate_curve": [{"time": 0, "rate": 1}, {"time": 2, "rate": 7}])", R"("type": "point")");
    ASSERT_EQ(rising.rate_curve.size(), 2U);
    EXPECT_EQ(rising.rate_curve[1].rate, 7.0);
}

TEST(EmitterLaunchScene, CountsOfChildrenCanHaveADistribution) {
    const SampleFolder folder;
    const SimulationSetup setup =
        parse_scene(R"({"ricochet": 1, "emitters": [{"name": "a", "type": "point", "burst": 1, "lifetime": 0.1},
            {"type": "child", "parent": "a", "on": "death",
             "count": {"type": "table", "points": [{"value": 1, "weight": 1}, {"value": 8, "weight": 1}]}}]})",
                    folder.path("s.json"))
            .setup;
    EXPECT_EQ(setup.emitters[1].parent->count.most(), 8.0);
}

struct Fault {
    const char* keys;
    const char* error;
};

const Fault kFaults[] = {
    {R"("mass": 1, "density": 2, "particle_radius": 1)", "mass: follows from \"density\", leave out one of the two"},
    {R"("density": 2)", "density: gives a particle no mass, expected a \"particle_radius\" above 0"},
    {R"("speed": {"type": "normal", "mean": 1})", "speed.deviation: missing, expected a number > 0"},
    {R"("speed": {"type": "gauss", "mean": 1})", "speed.type: found \"gauss\", expected one of \"uniform\""},
    {R"("speed": {"type": "uniform", "min": 2, "max": 1})", "speed: min must be below max"},
    {R"("mass": {"type": "normal", "mean": 1, "deviation": 1})", "expected >= 1e-300: set its \"min\""},
    {R"("lifetime": {"type": "exponential", "mean": 1, "by": "mass"})",
     "lifetime.by: only radii have a distribution by mass, leave it out"},
    {R"("particle_radius": {"type": "rosin_rammler", "scale": 1, "exponent": 2, "by": "mass"})",
     "particle_radius: a distribution by mass needs a min above 0"},
    {R"("particle_radius": {"type": "table", "points": []})", "particle_radius.points: found an empty list"},
    {R"("thermal": {"temperature": 300})", "thermal.molecule_mass: missing"},
    {R"("thermal": {"temperature": 300, "molecule_mass": 1e-26}, "speed": 1)",
     "speed: \"thermal\" gives direction and speed, leave out one of the two"},
    {R"("thermal": {"temperature": 300, "molecule_mass": 1e-26}, "direction": [0, 0, 1])",
     "direction: velocities in a volume have any direction, leave it out"},
    {R"("thermal": {"temperature": 300, "molecule_mass": 1e-26, "drift": 4})",
     "thermal.drift: is only for \"law\": \"effusion\"; expected the emitter's \"velocity\""},
    {R"("thermal": {"law": "effusion", "temperature": 300, "molecule_mass": 1e-26})",
     "thermal.law: needs a direction: set \"direction\""},
    {R"("thermal": {"law": "effusion", "temperature": 1, "molecule_mass": 1, "drift": 4}, "direction": [0, 0, 1])",
     "thermal: found a drift of 4 m/s, expected at most 1000 times the thermal speed"},
    {R"("direction_law": "cosine")", "direction_law: needs a direction"},
    {R"("direction_law": "cosine", "direction": [0, 0, 1], "cone": 120)", "cone: the cosine law ends at 90 degrees"},
    {R"("rate_curve": [{"time": 1, "rate": 1}, {"time": 0, "rate": 2}])",
     "rate_curve[1].time: found 0 s, expected a time after that of the point before (1 s)"},
    {R"("rate_curve": [{"time": 0, "rate": 1}, {"time": 1, "rate": 2}], "rate": 3)",
     "rate_curve: the emitter has another rate already"},
};

TEST(EmitterLaunchScene, FaultsAreReportedWithPlaceAndRemedy) {
    for (const Fault& fault : kFaults) {
        SCOPED_TRACE(fault.keys);
        const std::string error = error_of(fault.keys);
        EXPECT_NE(error.find("emitters[0]."), std::string::npos) << error;
        EXPECT_NE(error.find(fault.error), std::string::npos) << error;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
