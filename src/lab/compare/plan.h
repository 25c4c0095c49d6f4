/// \file
/// Plan of a comparison: its responses, time steps and reference.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/response/response.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// A response as a comparison names it.
struct ResponseChoice {
    ResponseKind kind = ResponseKind::exact;
    bool global_rollback = false;  ///< `rollback:global`: the whole system is rolled back, whatever the scene says

    friend bool operator==(const ResponseChoice&, const ResponseChoice&) = default;
};

/// Returns `exact`, `rollback`, `rollback:global`, `project` or `penalty`.
[[nodiscard]] std::string name_of(const ResponseChoice& choice);
/// Returns the options of a run with this response and time step, in s.
[[nodiscard]] SimulationOptions options_for(SimulationOptions options, const ResponseChoice& choice, double time_step);

/// Request for a comparison, as the command line gives it.
struct ComparisonRequest {
    std::optional<std::string> responses = std::nullopt;  ///< names separated by commas; nothing: all response_kinds()
    std::optional<std::string> time_steps =
        std::nullopt;  ///< in s, separated by commas; nothing: the scene's step times 2, 1, 1/2 and 1/4
    std::optional<std::string> reference_step = std::nullopt;  ///< in s; nothing: half of the smallest time step
    std::optional<std::string> repeats = std::nullopt;         ///< timed runs per row, 1 to kMostRepeats; nothing: 3
};

inline constexpr std::uint32_t kMostRepeats = 1000;

/// Plan of a comparison.
struct ComparisonPlan {
    std::vector<ResponseChoice> responses;  ///< in the requested order, without duplicates
    std::vector<double> time_steps;         ///< in s, descending, without duplicates
    double reference_step = 0.0;            ///< in s, of the exact run that is the reference for all errors
    std::uint32_t repeats = 3;              ///< timed runs per row
    double shown_step = 0.0;                ///< in s, the time step at which energies are drawn over time
};

/// Creates the plan of a request for a scene with these options. Default time steps longer than the duration are left
/// out. Throws InputError, with one line that names the option, for:
/// - an unknown response or an empty entry;
/// - a number that is invalid or not above 0;
/// - a step longer than the duration;
/// - a reference coarser than the smallest step;
/// - a scene without duration.
[[nodiscard]] ComparisonPlan make_plan(const ComparisonRequest& request, const SimulationOptions& options);

}  // namespace ricochet
