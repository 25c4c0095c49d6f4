/// \file
/// Numbers of repetitions for random tests. Optimised builds use the full number, slower builds use fewer repetitions,
/// and long runs use more.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <initializer_list>
#include <vector>

namespace ricochet::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

#ifdef NDEBUG
inline constexpr bool kOptimised = true;
#else
inline constexpr bool kOptimised = false;
#endif

/// Returns `full` in an optimised build, a tenth of it without optimisation, and a fiftieth under a sanitizer. The
/// result is at least 1. A test must pass with every count, so its claims must not depend on the number of repetitions.
[[nodiscard]] constexpr int scaled(int full) {
    const int divisor = kSanitized ? 50 : (kOptimised ? 1 : 10);
    return std::max(1, full / divisor);
}

/// Returns true if the tests run with full counts, that is, if the environment variable RICOCHET_LONG_TESTS is set.
[[nodiscard]] inline bool is_long_run() noexcept {
    return std::getenv("RICOCHET_LONG_TESTS") != nullptr;  // NOLINT(concurrency-mt-unsafe): nothing sets it
}

/// Returns the factor on the number of cases. It is `in_a_long_run` in a long run, otherwise 1.
[[nodiscard]] inline int case_factor(int in_a_long_run) noexcept { return is_long_run() ? in_a_long_run : 1; }

/// Returns the cases that run: all of them in a long run, otherwise every `stride`-th, the first included.
template <class Case>
[[nodiscard]] std::vector<Case> chosen_cases(std::initializer_list<Case> all, std::size_t stride) {
    std::vector<Case> chosen;
    for (std::size_t k = 0; k < all.size(); k += is_long_run() ? 1 : stride) chosen.push_back(all.begin()[k]);
    return chosen;
}

}  // namespace ricochet::test
