// Golden hashes of shipped scenes (shortened) and of random scenes. They cover the final state and every earlier
// impact. The committed values are in hashes.csv.
// They are the same for any number of threads, with every acceleration on or off, for every compiler, instruction set
// and version of Embree. The commit that changes a value must state the reason.
//
// This command prints the table for the current code, in the lines that begin with "golden,":
//   RICOCHET_PRINT_GOLDEN=1 golden_tests --gtest_filter='*Scene*'
// No program updates the table automatically.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "golden/random_scene.h"
#include "golden/shipped_scenes.h"
#include "golden/state_bits.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/acceleration/triangle_bvh.h"
#include "ricochet/io/scene.h"
#include "ricochet/simulation.h"
#include "support/counts.h"

namespace ricochet::golden {
namespace RICOCHET_FILE {

const std::filesystem::path kRoot = RICOCHET_SOURCE_DIR;

/// Hashes of the results of a run.
struct Outcome {
    std::uint64_t state = 0;
    std::uint64_t contacts = 0;  ///< hash of all contact records

    friend bool operator==(const Outcome&, const Outcome&) = default;
};

std::ostream& operator<<(std::ostream& out, const Outcome& outcome) {
    return out << std::hex << outcome.state << ',' << outcome.contacts << std::dec;
}

Outcome run(SimulationSetup setup, int threads) {
    const ThreadLimit limit(threads);
    setup.options.record_contacts = true;
    Simulation simulation(std::move(setup));
    StateHash contacts;
    while (!simulation.finished()) {
        simulation.step();
        add_records(simulation, contacts);
    }
    return {simulation.state_hash(), contacts.value()};
}

/// Returns the hash of the state alone, after one call that makes all steps.
std::uint64_t advance(SimulationSetup setup, int threads) {
    const ThreadLimit limit(threads);
    // Random scenes have small bounce budgets and may lose time. Shipped scenes must lose none.
    const bool may_lose_time = setup.options.bounce_budget == kRandomSceneBudget;
    Simulation simulation(std::move(setup));
    simulation.advance(simulation.step_count());
    EXPECT_TRUE(may_lose_time || simulation.statistics().budget_exhausted == 0);
    return simulation.state_hash();
}

void switch_accelerations_off(AccelerationSwitches& acceleration) {
    acceleration.look_ahead = false;
    acceleration.spatial_order = false;
    acceleration.sleeping = false;
}

const std::map<std::string, Outcome>& table() {
    static const std::map<std::string, Outcome> rows = [] {
        std::map<std::string, Outcome> result;
        std::ifstream file(kRoot / "tests/golden/hashes.csv");
        for (std::string line; std::getline(file, line);) {
            const std::size_t first = line.find(',');
            const std::size_t second = line.find(',', first + 1);
            if (line.starts_with('#') || second == std::string::npos) continue;
            const auto hex = [](const std::string& text) { return std::stoull(text, nullptr, 16); };
            result[line.substr(0, first)] = {hex(line.substr(first + 1, second - first - 1)),
                                             hex(line.substr(second + 1))};
        }
        return result;
    }();
    return rows;
}

/// Compares with the table, or prints the row for the table if the environment requests it.
void expect_golden(const std::string& name, const Outcome& outcome) {
    if (std::getenv("RICOCHET_PRINT_GOLDEN") != nullptr) {
        std::cout << "golden," << name << ',' << outcome << '\n';
        return;
    }
    const auto row = table().find(name);
    ASSERT_NE(row, table().end()) << name << " is not in tests/golden/hashes.csv";
    EXPECT_EQ(outcome, row->second) << name;
}

template <class MakeSetup>
void check(const std::string& name, const MakeSetup& make_setup) {
    SCOPED_TRACE(name);
    const Outcome golden = run(make_setup(), 1);
    expect_golden(name, golden);
    EXPECT_EQ(run(make_setup(), 7), golden) << "with 7 threads";
    EXPECT_EQ(advance(make_setup(), 2), golden.state) << "by advance() with 2 threads";
    SimulationSetup plain = make_setup();
    switch_accelerations_off(plain.acceleration);
    EXPECT_EQ(run(std::move(plain), 2), golden) << "without optimisations, with 2 threads";
}

class GoldenShippedScene : public ::testing::TestWithParam<ShippedScene> {};

TEST_P(GoldenShippedScene, EndsInTheSameBits) {
    if (test::kSanitized) GTEST_SKIP() << "long runs, whose parts other tests make under sanitizers";
    const ShippedScene scene = GetParam();
    std::vector<std::string> overrides;
    if (*scene.duration != '\0') overrides.push_back(std::string("simulation.duration=") + scene.duration);
    check(scene.name,
          [&] { return read_scene(kRoot / "scenes" / (std::string(scene.name) + ".json"), overrides).setup; });
}

/// Runs a shipped scene in full. Persistent contact must not consume the bounce budget, so no particle loses time.
using ShippedSceneLong = GoldenShippedScene;

TEST_P(ShippedSceneLong, LosesNoTime) {
    Simulation simulation(read_scene(kRoot / "scenes" / (std::string(GetParam().name) + ".json")).setup);
    simulation.advance(simulation.step_count());
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
    EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
    EXPECT_EQ(simulation.statistics().frozen, 0U);
}

/// Saves the state after two fifths of the run with one thread, and finishes with several threads.
TEST_P(ShippedSceneLong, ResumesWithOtherThreadCountsToTheSameBits) {
    const auto make = [] { return read_scene(kRoot / "scenes" / (std::string(GetParam().name) + ".json")).setup; };
    std::vector<std::byte> saved;
    Simulation whole(make());
    {
        const ThreadLimit one(1);
        whole.advance(whole.step_count() * 2 / 5);
        whole.save([&](std::span<const std::byte> bytes) { saved.insert(saved.end(), bytes.begin(), bytes.end()); });
        whole.advance(whole.step_count());
    }
    const ThreadLimit several(5);
    Simulation resumed(make());
    std::size_t read = 0;
    resumed.restore([&](std::span<std::byte> bytes) {
        ASSERT_LE(bytes.size(), saved.size() - read);
        std::copy_n(saved.begin() + static_cast<std::ptrdiff_t>(read), bytes.size(), bytes.begin());
        read += bytes.size();
    });
    EXPECT_EQ(resumed.step_index(), whole.step_count() * 2 / 5);
    resumed.advance(resumed.step_count());
    EXPECT_EQ(resumed.state_hash(), whole.state_hash());
    EXPECT_EQ(resumed.statistics().contacts, whole.statistics().contacts);
}

std::string shipped_name(const ::testing::TestParamInfo<ShippedScene>& info) {
    std::string name = info.param.name;
    for (char& c : name) {
        if (c == '/') c = '_';
    }
    return name;
}

INSTANTIATE_TEST_SUITE_P(Of, GoldenShippedScene, ::testing::ValuesIn(kShippedScenes), shipped_name);
INSTANTIATE_TEST_SUITE_P(Of, ShippedSceneLong, ::testing::ValuesIn(kShippedScenes), shipped_name);

/// Random scenes, eight in each test.
class GoldenRandomScenes : public ::testing::TestWithParam<int> {};

TEST_P(GoldenRandomScenes, EndInTheSameBits) {
    const int last = test::kSanitized ? 2 : 8;
    for (int k = 0; k < last; ++k) {
        const int number = 8 * GetParam() + k;
        check("random_" + std::to_string(number),
              [&] { return parse_scene(random_scene(number), kRoot / "scenes" / "random.json").setup; });
    }
}

INSTANTIATE_TEST_SUITE_P(Of, GoldenRandomScenes, ::testing::Range(0, kRandomScenes / 8));

/// Some of the random scenes, with Embree limited to one instruction set.
class GoldenInstructionSet : public ::testing::TestWithParam<const char*> {
protected:
    void TearDown() override { set_embree_config(""); }
};

bool processor_has(const std::string& instructions) {
    if (instructions == "avx2") return __builtin_cpu_supports("avx2") != 0;
    if (instructions == "avx512") return __builtin_cpu_supports("avx512dq") != 0;
    return true;
}

TEST_P(GoldenInstructionSet, EndsInTheSameBits) {
    if (!processor_has(GetParam())) GTEST_SKIP() << "this processor lacks " << GetParam();
    set_embree_config(std::string("isa=") + GetParam());
    for (int number = 0; number < kRandomScenes; number += test::kSanitized ? 31 : 5) {
        SimulationSetup setup = parse_scene(random_scene(number), kRoot / "scenes" / "random.json").setup;
        expect_golden("random_" + std::to_string(number), run(std::move(setup), 2));
    }
}

INSTANTIATE_TEST_SUITE_P(Of, GoldenInstructionSet, ::testing::Values("sse2", "sse4.2", "avx2", "avx512"),
                         [](const auto& test) {
                             std::string name = test.param;
                             std::erase(name, '.');
                             return name;
                         });

TEST(GoldenTable, NamesEveryShippedScene) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kRoot / "scenes")) {
        if (entry.path().extension() != ".json") continue;
        const std::string name = entry.path().lexically_relative(kRoot / "scenes").replace_extension().generic_string();
        EXPECT_TRUE(table().contains(name)) << name;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::golden
