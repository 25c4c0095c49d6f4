/// \file
/// How many repetitions a random test makes: the full number in an optimised build, fewer where each one costs more.
#pragma once

#include <algorithm>

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

/// `full` in an optimised build, a tenth of it without optimisation, a fiftieth under a sanitizer; at least 1.
/// A test must hold for every count: nothing that it claims may depend on the number of repetitions.
[[nodiscard]] constexpr int scaled(int full) {
    const int divisor = kSanitized ? 50 : (kOptimised ? 1 : 10);
    return std::max(1, full / divisor);
}

}  // namespace ricochet::test
