// Runs of a study, each in a process and a folder of its own.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lab/study/study_plan.h"
#include "lab/study/study_table.h"

namespace ricochet {

/// How the runs of a study are started.
struct StudyProcesses {
    std::string program;           ///< the tool, with a command `run`
    std::filesystem::path folder;  ///< the runs have folders `run_N` in it
    std::size_t at_a_time = 1;     ///< processes that run at the same time, >= 1
    int threads = 1;               ///< of each process, >= 1
};

/// Progress of a study.
struct StudyProgress {
    std::size_t finished = 0;  ///< runs that have ended, or whose results were there
    std::size_t failed = 0;
    std::size_t runs = 0;
};

/// Returns the folder of a run.
[[nodiscard]] std::filesystem::path folder_of(const StudyProcesses& processes, const StudyRun& run);

/// Runs all runs of a study, except those whose results are there already from an earlier study with the same scene
/// file and the same values. A run that was interrupted continues from its checkpoint. Returns the outcomes in the
/// order of the runs. should_stop is called now and then with the progress; if it returns true, running processes are
/// asked to end (SIGTERM), and the function returns after them, with runs without an outcome marked as failures. Throws
/// RunError if no process can be started, and InputError if the summary of a run lacks a result.
[[nodiscard]] std::vector<StudyOutcome> run_study(const StudyPlan& plan, const std::vector<StudyRun>& runs,
                                                  const StudyProcesses& processes,
                                                  const std::function<bool(const StudyProgress&)>& should_stop);

}  // namespace ricochet
