// Plan of a study: one scene, run with many values of some keys, and several times with different random numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ricochet {

/// One key of the scene that a study varies.
struct StudyAxis {
    std::string key;                  ///< path of the key as in `--set`, for example materials.steel.friction
    std::vector<std::string> values;  ///< JSON texts, at least one
};

/// A study as its file describes it.
struct StudyPlan {
    std::filesystem::path scene;         ///< scene file, relative paths are relative to the study
    std::vector<std::string> overrides;  ///< PATH=VALUE for all runs
    std::vector<StudyAxis> axes;         ///< at least one
    std::uint32_t repeats = 1;           ///< runs of each case
    std::optional<std::uint64_t> seed;   ///< seed of the first repeat; the next ones follow. Without: the scene's seed
    std::vector<std::string> results;    ///< paths of numbers in summary.json, at least one
};

/// One run of a study.
struct StudyRun {
    std::size_t number = 0;              ///< from 1
    std::size_t study_case = 0;          ///< from 1; repeats of one case have the same number
    std::uint32_t repeat = 1;            ///< from 1
    std::vector<std::string> values;     ///< of the axes, as JSON texts
    std::vector<std::string> overrides;  ///< PATH=VALUE
};

/// Most runs of one study.
inline constexpr std::size_t kMostStudyRuns = 100'000;

/// Reads a study. Throws InputError with one line for a file that is no valid study.
[[nodiscard]] StudyPlan read_study(const std::filesystem::path& file);

/// Returns all runs. The last axis varies fastest, and the repeats of a case follow each other.
[[nodiscard]] std::vector<StudyRun> runs_of(const StudyPlan& plan);

}  // namespace ricochet
