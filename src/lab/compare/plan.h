/// \file
/// What a comparison runs: which responses, at which time steps, against which reference.
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
    bool global_rollback = false;  ///< `rollback:global`: the whole system goes back, whatever the scene says

    friend bool operator==(const ResponseChoice&, const ResponseChoice&) = default;
};

/// `exact`, `rollback`, `rollback:global`, `project` or `penalty`.
[[nodiscard]] std::string name_of(const ResponseChoice& choice);
/// The options of a run that answers by this choice at this time step, s.
[[nodiscard]] SimulationOptions options_for(SimulationOptions options, const ResponseChoice& choice, double time_step);

/// What is asked for, as it stands on the command line.
struct ComparisonRequest {
    std::optional<std::string> responses =
        std::nullopt;  ///< names with commas between them; nothing: all response_kinds()
    std::optional<std::string> time_steps =
        std::nullopt;  ///< s, with commas; nothing: the scene's step times 2, 1, 1/2 and 1/4
    std::optional<std::string> reference_step = std::nullopt;  ///< s; nothing: half of the smallest time step
    std::optional<std::string> repeats = std::nullopt;  ///< timed runs of each row, 1 to kMostRepeats; nothing: 3
};

inline constexpr std::uint32_t kMostRepeats = 1000;

/// What is run.
struct ComparisonPlan {
    std::vector<ResponseChoice> responses;  ///< in the order asked for, each once
    std::vector<double> time_steps;         ///< s, descending, each once
    double reference_step = 0.0;            ///< s, of the exact run that everything is measured against
    std::uint32_t repeats = 3;              ///< timed runs of each row
    double shown_step = 0.0;                ///< s, the time step at which energies are drawn over time
};

/// Reads a request for a scene with these options. Default time steps longer than the duration are left out. Throws
/// InputError, one line that names the option: unknown response, empty entry, a number that is none or not above 0, a
/// step longer than the duration, a reference coarser than the smallest step, a scene without duration.
[[nodiscard]] ComparisonPlan make_plan(const ComparisonRequest& request, const SimulationOptions& options);

}  // namespace ricochet
