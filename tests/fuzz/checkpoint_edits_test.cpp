// Tests of edited checkpoints with correct checksums. Each is refused or behaves like any other state.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ostream>
#include <string>

#include "fuzz/checkpoint_scenes.h"
#include "fuzz/fuzz_targets.h"
#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet::fuzz {

/// Prints a scene in GoogleTest's messages.
void PrintTo(const CheckpointScene& scene, std::ostream* out) {  // NOLINT(readability-identifier-naming)
    *out << scene.name;
}

namespace RICOCHET_FILE {

constexpr std::uint64_t kSeed = 4711;

/// Name of the current case, for the signal handler.
std::array<char, 128> current_case{};

extern "C" void name_case_and_die(int signal) {
    static_cast<void>(!::write(STDERR_FILENO, current_case.data(), current_case.size()));
    static_cast<void>(std::signal(signal, SIG_DFL));
    static_cast<void>(std::raise(signal));
}

/// Returns bytes for fuzz_checkpoint(): the scene's number, then one to three edits of its checkpoint.
std::string random_input(std::size_t scene, std::uint64_t number) {
    RandomSequence random(kSeed, static_cast<std::uint32_t>(scene), number);
    const auto below = [&](std::size_t count) {
        return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
    };
    std::string bytes(1, static_cast<char>(scene));
    const std::size_t edits = 1 + below(3);
    for (std::size_t k = 0; k < edits; ++k) {
        // An edit writes an extreme value, up to 16 other bytes, or a copy of another word of the file.
        const std::size_t length = 1 + below(8);
        const std::size_t kind = below(4);
        bytes += static_cast<char>(kind == 0 ? 0 : kind == 1 ? 1 : kCopyEdit);
        for (std::size_t byte = 0; byte < 2; ++byte) bytes += static_cast<char>(below(256));
        if (kind == 0) bytes += static_cast<char>(below(256));
        if (kind == 1) bytes += static_cast<char>(length - 1);
        for (std::size_t byte = 0; kind == 1 && byte < length; ++byte) bytes += static_cast<char>(below(256));
        for (std::size_t byte = 0; kind > 1 && byte < 2; ++byte) bytes += static_cast<char>(below(256));
    }
    return bytes;
}

/// Returns the number in an environment variable, or `otherwise` if it is not set.
int number_from_environment(const char* name, int otherwise) {
    const char* const number = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): no code sets it
    return number == nullptr ? otherwise : std::atoi(number);
}

class CheckpointEdits : public ::testing::TestWithParam<CheckpointScene> {};

TEST_P(CheckpointEdits, AreRefusedOrRunOn) {
    for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGTERM, SIGBUS}) {
        static_cast<void>(std::signal(signal, name_case_and_die));
    }
    std::size_t scene = 0;
    while (kCheckpointScenes[scene].name != GetParam().name) ++scene;
    // The environment can set the number of cases, and the first one to reproduce a failed case.
    const int cases = number_from_environment("RICOCHET_CASES", test::scaled(200 * test::case_factor(500)));
    const int first = number_from_environment("RICOCHET_FIRST_CASE", 0);
    int refused = 0;
    for (int k = first; k < cases; ++k) {
        static_cast<void>(std::snprintf(current_case.data(), current_case.size(), "scene %zu (%s), seed %d, case %d\n",
                                        scene, GetParam().name, static_cast<int>(kSeed), k));
        SCOPED_TRACE(current_case.data());
        bool is_accepted = false;
        EXPECT_NO_THROW(is_accepted = fuzz_checkpoint(random_input(scene, static_cast<std::uint64_t>(k))));
        refused += is_accepted ? 0 : 1;
    }
    // A small number of edits may all be refused.
    constexpr int kEnough = 100;
    EXPECT_TRUE(cases - first < kEnough || refused < cases - first) << refused;
    for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGTERM, SIGBUS})
        static_cast<void>(std::signal(signal, SIG_DFL));
}

INSTANTIATE_TEST_SUITE_P(All, CheckpointEdits, ::testing::ValuesIn(kCheckpointScenes), [](const auto& test) {
    std::string name = test.param.name;
    for (char& c : name) c = c == ' ' ? '_' : c;
    return name;
});

}  // namespace RICOCHET_FILE
}  // namespace ricochet::fuzz
