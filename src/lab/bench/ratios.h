/// \file
/// Stores the ratios of a run in a file, so that slower later versions of the program can be detected. Ratios of two
/// runs can be compared even if their times cannot.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/bench/measurement.h"

namespace ricochet::bench {

/// Stored ratios of a case.
struct CaseRatios {
    std::string name;
    std::optional<double> raw;             ///< Row::ratio_raw, > 0
    std::optional<double> native_bounces;  ///< Row::ratio_native_bounces, > 0
};

/// Stored ratios of a suite.
struct SuiteRatios {
    std::string suite;
    std::string machine;  ///< machine on which they were measured
    std::string version;  ///< version of ricochet
    std::vector<CaseRatios> cases;
};

/// Returns the ratios of measured rows. The first row of a case counts.
[[nodiscard]] SuiteRatios ratios_of(std::span<const Row> rows, std::string_view suite, std::string_view machine,
                                    std::string_view version);

/// Returns the ratios as JSON.
[[nodiscard]] std::string to_json(const SuiteRatios& ratios);

/// Reads a file that contains the text of to_json(). Throws InputError if the file cannot be read, has another content,
/// or belongs to another suite.
[[nodiscard]] SuiteRatios read_ratios(const std::filesystem::path& file, std::string_view suite);

/// One ratio, before and now; nothing if it does not exist.
struct RatioChange {
    std::string name;   ///< of the case
    std::string ratio;  ///< name of its field: "ratio_raw" or "ratio_native_bounces"
    std::optional<double> before;
    std::optional<double> now;
    bool fell = false;  ///< by more than the tolerance
};

/// Returns every ratio that exists before or now, in the order of the cases before, followed by new cases. `fell` can
/// be true only for a ratio that exists on both sides.
/// \param tolerance  part of the ratio before, in [0, 1)
[[nodiscard]] std::vector<RatioChange> compare_ratios(const SuiteRatios& before, const SuiteRatios& now,
                                                      double tolerance);

}  // namespace ricochet::bench
