// Results of a study: the numbers of each run, their means and errors for each case, and a plot.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/study/study_plan.h"

namespace ricochet {

/// Outcome of one run.
struct StudyOutcome {
    std::vector<double> results;  ///< in the order of the plan; empty if the run failed
    std::string failure;          ///< reason in one line; empty if the run succeeded
};

/// Mean of one result over the repeats of a case that have succeeded.
struct StudyMean {
    double mean = 0.0;            ///< NaN without a run
    std::optional<double> error;  ///< standard error of the mean; from two runs on
};

/// One case of a study.
struct StudyRow {
    std::size_t study_case = 0;
    std::vector<std::string> values;  ///< of the axes, as JSON texts
    std::size_t runs = 0;             ///< runs that have succeeded
    std::size_t failed = 0;           ///< runs that have failed
    std::vector<StudyMean> results;
};

/// Returns the number at a path in a summary, for example `contacts` or `counters.outlet.forward`. An entry of a list
/// is selected by its name. Returns nothing if there is no number at this path.
[[nodiscard]] std::optional<double> number_in_summary(const std::string& summary, const std::string& path);

/// Returns the rows of all cases. outcomes: those of `runs`, in the same order.
[[nodiscard]] std::vector<StudyRow> study_rows(const StudyPlan& plan, const std::vector<StudyRun>& runs,
                                               const std::vector<StudyOutcome>& outcomes);

/// Return tables as CSV: one line for each case, and one for each run.
[[nodiscard]] std::string study_csv(const StudyPlan& plan, const std::vector<StudyRow>& rows);
[[nodiscard]] std::string study_runs_csv(const StudyPlan& plan, const std::vector<StudyRun>& runs,
                                         const std::vector<StudyOutcome>& outcomes);

/// Returns a gnuplot script with one picture study_K.png for each result: the result over the first axis with its
/// error, and a line for each combination of the other axes. The data are in the script.
[[nodiscard]] std::string study_script(const StudyPlan& plan, const std::vector<StudyRow>& rows);
/// Returns the names of the pictures of the script.
[[nodiscard]] std::vector<std::string> study_pictures(const StudyPlan& plan);

}  // namespace ricochet
