/// \file
/// Plan of a comparison: responses, time steps and reference.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/response/response.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// Response in a comparison, with the option of a global rollback.
struct ResponseChoice {
    ResponseKind kind = ResponseKind::exact;
    /// `rollback:global`: the whole system is rolled back, independent of the scene's setting.
    bool global_rollback = false;

    friend bool operator==(const ResponseChoice&, const ResponseChoice&) = default;
};

/// Returns the name of a response: `exact`, `rollback`, `rollback:global`, `project` or `penalty`.
[[nodiscard]] std::string name_of(const ResponseChoice& choice);
/// Returns the options of a scene, changed to this response and to this time step, in s.
[[nodiscard]] SimulationOptions options_for(SimulationOptions options, const ResponseChoice& choice, double time_step);

/// Command-line options of a comparison. An option that is not given is std::nullopt.
struct ComparisonRequest {
    std::optional<std::string> responses = std::nullopt;  ///< names separated by commas; default: all response_kinds()
    std::optional<std::string> time_steps =
        std::nullopt;  ///< in s, separated by commas; default: 2, 1, 1/2 and 1/4 times the scene's time step
    std::optional<std::string> reference_step = std::nullopt;  ///< in s; default: half of the smallest time step
    /// Number of timed runs per row, 1 to kMostRepeats; default: 3.
    std::optional<std::string> repeats = std::nullopt;
};

inline constexpr std::uint32_t kMostRepeats = 1000;

/// Plan of a comparison.
struct ComparisonPlan {
    std::vector<ResponseChoice> responses;  ///< in the requested order, without duplicates
    std::vector<double> time_steps;         ///< in s, descending, without duplicates
    double reference_step = 0.0;  ///< in s, time step of the run with `exact` that is the reference for all errors
    std::uint32_t repeats = 3;    ///< number of timed runs per row
    double shown_step = 0.0;      ///< in s, time step of the rows whose energy is drawn over time
};

/// Creates the plan of a request for a scene with these options. If default time steps exceed the duration, they are
/// left out. Throws InputError, with one line that names the option, for:
/// - an unknown response or an empty entry;
/// - a number that is invalid or not above 0;
/// - a step longer than the duration;
/// - a reference step longer than the smallest time step;
/// - a scene without duration.
[[nodiscard]] ComparisonPlan make_plan(const ComparisonRequest& request, const SimulationOptions& options);

}  // namespace ricochet
