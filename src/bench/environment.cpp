#include "bench/environment.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/geometry/acceleration/triangle_bvh.h"

namespace ricochet::bench {
namespace {

#if defined(__clang__)
constexpr const char* kCompiler = "Clang " __clang_version__;
#else
constexpr const char* kCompiler = "GCC " __VERSION__;
#endif

std::string cpu_model() {
    std::ifstream stream("/proc/cpuinfo");
    for (std::string line; std::getline(stream, line);) {
        const std::size_t colon = line.find(':');
        if (line.starts_with("model name") && colon != std::string::npos && colon + 2 < line.size()) {
            return line.substr(colon + 2);
        }
    }
    return "unknown";
}

/// Words of small letters and digits. Marks in brackets and what comes after an at sign (the clock) are no words.
std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words(1);
    int depth = 0;
    for (const char c : text.substr(0, text.find('@'))) {
        const bool is_upper = c >= 'A' && c <= 'Z';
        const bool is_word = is_upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
        if (c == '(') ++depth;
        if (is_word && depth == 0) {
            words.back() += is_upper ? static_cast<char>(c - 'A' + 'a') : c;
        } else if (!words.back().empty()) {
            words.emplace_back();
        }
        if (c == ')') --depth;
    }
    return words;
}

bool tells_models_apart(const std::string& word) {
    constexpr std::array kSaidByAll{"", "intel", "amd", "cpu", "processor", "core"};
    return std::find(kSaidByAll.begin(), kSaidByAll.end(), word) == kSaidByAll.end();
}

}  // namespace

std::string machine_slug(std::string_view cpu, int hardware_threads) {
    std::string slug;
    for (const std::string& word : words_of(cpu)) {
        if (tells_models_apart(word)) slug += word + "-";
    }
    if (slug.empty()) slug = "unknown-";
    return slug + fmt::format("{}t", hardware_threads);
}

Environment this_environment(std::string_view version) {
    Environment e;
    e.cpu = cpu_model();
    {
        const ThreadLimit all(0);
        e.hardware_threads = thread_count();
    }
    e.machine = machine_slug(e.cpu, e.hardware_threads);
    e.compiler = kCompiler;
    e.build_type = RICOCHET_BUILD_TYPE;
    e.build_flags = RICOCHET_BUILD_FLAGS;
    e.ray_library = embree_version();
    e.thread_library = fmt::format("TBB {}", tbb_version());
    e.date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
    e.ricochet = version;
    return e;
}

Record record_of(const Environment& e) {
    return {{"machine", e.machine},
            {"cpu", e.cpu},
            {"hardware_threads", static_cast<std::uint64_t>(e.hardware_threads)},
            {"compiler", e.compiler},
            {"build_type", e.build_type},
            {"build_flags", e.build_flags},
            {"ray_library", e.ray_library},
            {"thread_library", e.thread_library},
            {"date", e.date},
            {"ricochet", e.ricochet}};
}

}  // namespace ricochet::bench
