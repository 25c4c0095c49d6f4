// Tests that the memory use of an endless run stays constant. The run has births, deaths, sleep, frames and
// checkpoints.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "faults/process_use.h"
#include "ricochet/io/scene.h"
#include "run/checkpoint.h"
#include "run/run_folder.h"
#include "run/run_writer.h"
#include "support/allocation_guard.h"
#include "support/counts.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

// About 500 spheres at a time fall into a bowl, bounce, come to rest, sleep, and die of age.
constexpr const char* kScene = R"({
  "ricochet": 1,
  "simulation": {"time_step": 0.01, "duration": 1e7, "seed": 5},
  "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
  "materials": {"plain": {"restitution": 0.3, "friction": 0.5, "rolling_friction": 0.05}},
  "colliders": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "material": "plain"},
                {"name": "box", "type": "box", "position": [0, 0, 0.1], "size": [0.3, 0.3, 0.2], "material": "plain"}],
  "emitters": [{"type": "disk", "center": [0, 0, 1.2], "normal": [0, 0, -1], "radius": 0.4, "rate": 100,
                "particle_radius": [0.02, 0.01], "lifetime": [5, 2]}],
  "output": {"contacts": true}
})";

constexpr std::uint64_t kFrameSteps = 200;
constexpr std::uint64_t kCheckpointSteps = 1000;
constexpr std::size_t kPhases = 20;

/// Returns the number of steps in each of kPhases. They take some seconds in all. A long run takes some minutes,
/// multiplied by RICOCHET_SOAK.
std::uint64_t steps_per_phase() {
    const char* text = std::getenv("RICOCHET_SOAK");  // NOLINT(concurrency-mt-unsafe): no code sets it
    const std::uint64_t times = text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
    if (test::is_long_run()) return 100000 * std::max<std::uint64_t>(1, times);
    return static_cast<std::uint64_t>(test::scaled(500));
}

/// Run as the tool makes it. Written files are removed, so that the disk does not fill.
class EndlessRun {
public:
    EndlessRun() {
        scene_ = read_scene(folder_.write("scene.json", kScene));
        info_ = run_info_of(scene_);
        region_ = particle_region(scene_.setup);
        simulation_.emplace(std::move(scene_.setup));
        writer_.emplace(folder_.path(""), info_, *simulation_, region_);
    }

    void advance(std::uint64_t steps) {
        for (std::uint64_t k = 0; k < steps; ++k) {
            simulation_->step();
            writer_->add_step(*simulation_);
            const std::uint64_t step = simulation_->step_index();
            most_asleep_ = std::max(most_asleep_, simulation_->statistics().asleep);
            if (step % kFrameSteps == 0) writer_->write_frame(*simulation_);
            if (step % kCheckpointSteps == 0) checkpoint();
        }
    }

    [[nodiscard]] const Simulation& simulation() const { return *simulation_; }
    [[nodiscard]] std::uint64_t most_asleep() const { return most_asleep_; }

    /// Continues in another simulation that has read the checkpoint of this one. The new writer starts without the list
    /// of files to remove.
    void resume() {
        writer_->write_frame(*simulation_);
        checkpoint();
        const std::uint64_t hash = simulation_->state_hash();
        Simulation resumed(read_scene(folder_.path("scene.json")).setup);
        Checkpoint read = read_checkpoint(folder_.path(kCheckpointFile), scene_.fingerprint, resumed);
        read.frames.clear();
        read.contacts.clear();
        EXPECT_EQ(resumed.state_hash(), hash);
        writer_.reset();
        simulation_.emplace(std::move(resumed));
        writer_.emplace(folder_.path(""), info_, *simulation_, region_, read);
    }

private:
    void checkpoint() {
        writer_->write_checkpoint(*simulation_, scene_.fingerprint, 0.0);
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path(""))) {
            const std::string name = entry.path().filename().string();
            if (step_of_frame_file(name) || step_of_contact_file(name)) std::filesystem::remove(entry.path());
        }
    }

    test::TemporaryFolder folder_;
    SceneDescription scene_;
    RunInfo info_;
    Box3 region_;
    std::optional<Simulation> simulation_;
    std::optional<RunWriter> writer_;
    std::uint64_t most_asleep_ = 0;
};

TEST(Soak, WithBirthsDeathsSleepAndCheckpointsNeedsNoMoreMemoryOnceWarm) {
    if (test::kSanitized) GTEST_SKIP() << "sanitizers keep freed memory for a while";
    EndlessRun run;
    std::vector<std::size_t> resident;
    for (std::size_t phase = 0; phase < kPhases; ++phase) {
        run.advance(steps_per_phase());
        run.resume();
        resident.push_back(test::resident_bytes());
    }
    const SimulationStatistics& statistics = run.simulation().statistics();
    EXPECT_GT(statistics.emitted, 5U * run.simulation().particles().size());
    EXPECT_GT(statistics.expired, 0U);
    EXPECT_GT(run.most_asleep(), 0U);
    if (test::kSanitized) return;  // sanitizers keep freed memory
    const std::size_t warm = *std::max_element(resident.begin(), resident.begin() + kPhases / 2);
    const std::size_t late = *std::max_element(resident.begin() + kPhases / 2, resident.end());
    std::string all;
    for (const std::size_t bytes : resident) all += " " + std::to_string(bytes / 1024);
    RecordProperty("resident_kilobytes", all);
    EXPECT_LE(late, warm + warm / 100) << "resident, KiB:" << all;
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
