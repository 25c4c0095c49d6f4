/// \file
/// The benchmark's suites by name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ricochet::bench {

/// The suite whose cases are files, see load_cases.h; those of the others are in cases.h.
inline constexpr std::string_view kLoadSuite = "load";

/// The suite that is measured with several numbers of threads unless told otherwise.
inline constexpr std::string_view kThreadsSuite = "threads";

/// All suites in the order in which they are told.
[[nodiscard]] std::vector<std::string> suite_names();

/// Throws InputError that lists the suites when there is none of this name.
void require_suite(std::string_view suite);

/// The numbers of threads that a suite is measured with unless told otherwise: {0} (all), or 1, 2, 4 and so on up to
/// all of them, which come last.
/// \param hardware  threads that the machine has, >= 1
[[nodiscard]] std::vector<int> default_threads(std::string_view suite, int hardware);

}  // namespace ricochet::bench
