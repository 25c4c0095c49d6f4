// Runs every fuzz target over its seeds, over all inputs that once failed, and over random ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

#include "fuzz/fuzz_targets.h"
#include "ricochet/core/random.h"
#include "support/allocation_guard.h"
#include "support/counts.h"

namespace ricochet::fuzz {

/// Prints a target in GoogleTest's messages.
void PrintTo(const FuzzTarget& target, std::ostream* out) {  // NOLINT(readability-identifier-naming)
    *out << target.name;
}

namespace RICOCHET_FILE {

const std::filesystem::path kFolder = std::filesystem::path(RICOCHET_SOURCE_DIR) / "tests/fuzz";

/// Size in bytes from which on scripts/fuzz refuses single allocations.
constexpr std::size_t kMostMemory = 200'000'000;

/// Returns the files of a folder in the order of their names, or none if the folder does not exist.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
    std::error_code none;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

class FuzzReplay : public ::testing::TestWithParam<FuzzTarget> {
protected:
    /// Fails if the target finds an error. Returns true if it accepts the bytes.
    static bool run(const std::string& bytes) {
        const test::AllocationGuard guard;
        bool is_accepted = false;
        EXPECT_NO_THROW(is_accepted = GetParam().run(bytes));
        EXPECT_LT(guard.peak_bytes(), kMostMemory);
        return is_accepted;
    }
};

// Refused seeds would be useless as starting points of a search.
TEST_P(FuzzReplay, AcceptsItsSeedsAndFindsNothingWrong) {
    const auto seeds = files_of(kFolder / "corpus" / GetParam().name);
    EXPECT_FALSE(seeds.empty());
    for (const auto& seed : seeds) {
        SCOPED_TRACE(seed);
        EXPECT_TRUE(run(bytes_of(seed)));
    }
}

TEST_P(FuzzReplay, FindsNothingWrongInFormerFailures) {
    for (const auto& file : files_of(kFolder / "regressions" / GetParam().name)) {
        SCOPED_TRACE(file);
        static_cast<void>(run(bytes_of(file)));
    }
}

// The targets must handle every truncation of a seed, and seeds with one changed byte.
TEST_P(FuzzReplay, HandlesTruncatedAndChangedSeeds) {
    constexpr std::size_t kCuts = 16;
    for (const auto& seed : files_of(kFolder / "corpus" / GetParam().name)) {
        SCOPED_TRACE(seed);
        const std::string bytes = bytes_of(seed);
        for (std::size_t k = 0; k < kCuts; ++k) {
            const std::size_t at = bytes.size() * k / kCuts;
            SCOPED_TRACE("byte " + std::to_string(at));
            static_cast<void>(run(bytes.substr(0, at)));
            std::string changed = bytes;
            if (!changed.empty()) changed[at] = static_cast<char>(changed[at] ^ 0x15);
            static_cast<void>(run(changed));
        }
    }
}

class FuzzRandom : public ::testing::TestWithParam<FuzzTarget> {};

// Every byte of these inputs is a choice. Targets that read text refuse all of them. A finding reports its seed.
TEST_P(FuzzRandom, FindsNothingWrongWithRandomChoices) {
    constexpr std::size_t kLongest = 256;
    const auto inputs = static_cast<std::uint64_t>(test::scaled(100) * test::case_factor(1000));
    std::uint64_t accepted = 0;
    for (std::uint64_t seed = 0; seed < inputs && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomSequence random(seed, 71, 0);
        std::string bytes(kLongest, '\0');
        for (char& byte : bytes) byte = static_cast<char>(static_cast<unsigned char>(256.0 * random.uniform()));
        EXPECT_NO_THROW(accepted += GetParam().run(bytes) ? 1 : 0);
    }
    std::cout << GetParam().name << ": " << inputs << " inputs, " << accepted << " accepted\n";
    if (std::string(GetParam().name) == "run") {
        EXPECT_GT(2 * accepted, inputs);
    }
}

INSTANTIATE_TEST_SUITE_P(All, FuzzRandom, ::testing::ValuesIn(kFuzzTargets),
                         [](const auto& test) { return std::string(test.param.name); });

INSTANTIATE_TEST_SUITE_P(All, FuzzReplay, ::testing::ValuesIn(kFuzzTargets),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(FuzzReplayFolders, EveryFolderOfInputsHasATarget) {
    for (const char* kind : {"corpus", "regressions"}) {
        for (const auto& folder : files_of(kFolder / kind)) {
            EXPECT_TRUE(std::any_of(kFuzzTargets.begin(), kFuzzTargets.end(), [&](const FuzzTarget& target) {
                return folder.filename() == target.name;
            })) << folder;
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::fuzz
