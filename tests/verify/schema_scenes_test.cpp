// Random scenes over all keys of the scene schema. A run that verifies itself must find no violation in them.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>

#include "inspect/scene_schema.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "ricochet/verify/sphere_overlaps.h"
#include "support/counts.h"
#include "support/temporary_folder.h"
#include "verify/schema_scene.h"

namespace ricochet::test {
namespace RICOCHET_FILE {

/// Returns the number of time losses and unsolved contacts that the run itself has counted.
std::uint64_t reported(const SimulationStatistics& statistics) {
    return statistics.budget_exhausted + statistics.squeezed + statistics.unsolved_steps;
}

/// Returns true if a violation is a limit that the documents state and that the run has also reported. was_reported:
/// the run has counted a limit in the step of the violation.
bool is_known_limit(const Violation& violation, const Simulation& simulation, bool was_reported) {
    const SimulationOptions& options = simulation.options();
    // These two responses let particles pass walls that are thin for the time step.
    if (options.response == ResponseKind::project || options.response == ResponseKind::penalty) return true;
    const SimulationStatistics& statistics = simulation.statistics();
    switch (violation.kind) {
        case ViolationKind::wrong_side:  // a collider has passed a pinched particle (docs/moving.md)
            return statistics.squeezed > 0 && simulation.finished();
        case ViolationKind::pair_overlap:  // contact planned for a step (docs/particle-contacts.md)
            return was_reported || (options.particle_contacts->method != PairMethod::events &&
                                    statistics.overlap_largest > kMostPlannedOverlap);
        default:
            return false;
    }
}

struct Outcome {
    bool was_run = false;
    std::uint64_t impacts = 0;
    std::string alarms;
};

std::string text_of(const Violation& violation) {
    return "kind " + std::to_string(static_cast<int>(violation.kind)) + " particle " +
           std::to_string(violation.particle) + " at " + std::to_string(violation.time) + " s; ";
}

Outcome run(SimulationSetup setup) {
    setup.options.verify = true;
    Outcome outcome;
    try {
        Simulation simulation(std::move(setup));
        outcome.was_run = true;
        while (!simulation.finished()) {
            const std::uint64_t before = reported(simulation.statistics());
            const std::size_t known = simulation.violations().size();
            simulation.step();
            const bool was_reported = reported(simulation.statistics()) > before;
            for (std::size_t k = known; k < simulation.violations().size(); ++k) {
                const Violation& violation = simulation.violations()[k];
                if (!is_known_limit(violation, simulation, was_reported)) outcome.alarms += text_of(violation);
            }
        }
        outcome.impacts = simulation.statistics().contacts + simulation.statistics().pair_impacts;
    } catch (const DivergedError&) {
        return outcome;  // named and reported
    } catch (const InputError&) {
        return {};
    }
    return outcome;
}

/// Runs `count` scenes, beginning with a seed. With RICOCHET_SEED it runs only that scene and writes its text to
/// RICOCHET_SCENE_FILE.
void run_scenes(std::uint64_t count, std::set<std::string>* keys) {
    const ThreadLimit one_thread(1);
    const nlohmann::json schema = nlohmann::json::parse(scene_schema());
    const TemporaryFolder folder;
    write_scene_files(folder.path(""));
    const char* const asked = std::getenv("RICOCHET_SEED");  // NOLINT(concurrency-mt-unsafe): nothing sets it
    const std::uint64_t first = asked == nullptr ? 0 : std::strtoull(asked, nullptr, 10);
    if (asked != nullptr) count = 1;
    std::uint64_t runs = 0;
    std::uint64_t with_impacts = 0;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        nlohmann::json scene = SchemaScene(schema, seed).draw();
        std::optional<SceneDescription> read = accepted(scene, folder.path(""));
        if (const char* const file = std::getenv("RICOCHET_SCENE_FILE")) {  // NOLINT(concurrency-mt-unsafe)
            std::ofstream(file) << scene.dump(1);
            write_scene_files(std::filesystem::path(file).parent_path());
        }
        if (!read) continue;
        const Outcome outcome = run(std::move(read->setup));
        runs += outcome.was_run ? 1 : 0;
        with_impacts += outcome.impacts > 0 ? 1 : 0;
        EXPECT_TRUE(outcome.alarms.empty()) << "RICOCHET_SEED=" << seed << ": " << outcome.alarms;
        if (outcome.was_run && keys != nullptr) add_keys(schema, scene, *keys);
    }
    std::cout << count << " scenes, " << runs << " accepted, " << with_impacts << " with impacts\n";
    if (asked != nullptr) return;
    EXPECT_GE(10 * runs, 7 * count);
    EXPECT_GE(10 * with_impacts, 3 * count);
}

TEST(RandomSchemaScene, RunReportsNoViolation) { run_scenes(static_cast<std::uint64_t>(scaled(60)), nullptr); }

TEST(RandomSchemaSceneLong, RunsReportNoViolationAndCoverEveryKey) {
    std::set<std::string> drawn;
    run_scenes(3000, &drawn);
    for (const std::string& key : all_keys(nlohmann::json::parse(scene_schema()))) {
        EXPECT_TRUE(drawn.contains(key) || !reason_not_drawn(key).empty()) << key << " was never drawn";
        EXPECT_TRUE(!drawn.contains(key) || reason_not_drawn(key).empty())
            << key << " was drawn, although the list excludes it";
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::test
