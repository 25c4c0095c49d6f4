#include "bench/suites.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bench/cases.h"
#include "ricochet/core/error.h"

namespace ricochet::bench {

std::vector<std::string> suite_names() {
    std::vector<std::string> names;
    for (const Case& c : all_cases()) {
        if (names.empty() || names.back() != c.suite) names.emplace_back(c.suite);
    }
    names.emplace_back(kLoadSuite);
    return names;
}

void require_suite(std::string_view suite) {
    const std::vector<std::string> names = suite_names();
    if (std::find(names.begin(), names.end(), suite) != names.end()) return;
    throw InputError(fmt::format("--suite {}: there is no such suite; there are {}", suite, fmt::join(names, ", ")));
}

std::vector<int> default_threads(std::string_view suite, int hardware) {
    if (suite != kThreadsSuite) return {0};
    std::vector<int> counts;
    for (int threads = 1; threads < hardware; threads *= 2) counts.push_back(threads);
    counts.push_back(hardware);
    return counts;
}

}  // namespace ricochet::bench
