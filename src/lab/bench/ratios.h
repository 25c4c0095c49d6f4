/// \file
/// Files with the ratios of a benchmark. A comparison with an earlier file shows if the program has become slower.
/// Ratios can be compared even if the times of both measurements cannot.
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
    std::string machine;  ///< Environment::machine of the measurement
    std::string version;  ///< version of ricochet
    std::vector<CaseRatios> cases;
};

/// Returns the ratios of measured rows. If a case has several rows, the first row counts.
[[nodiscard]] SuiteRatios ratios_of(std::span<const Row> rows, std::string_view suite, std::string_view machine,
                                    std::string_view version);

/// Returns the ratios as JSON.
[[nodiscard]] std::string to_json(const SuiteRatios& ratios);

/// Reads a file with the text of to_json(). Throws InputError if the file cannot be read, has an invalid content, or
/// belongs to another suite.
[[nodiscard]] SuiteRatios read_ratios(const std::filesystem::path& file, std::string_view suite);

/// Earlier and current value of one ratio. A missing value is std::nullopt.
struct RatioChange {
    std::string name;   ///< name of the case
    std::string ratio;  ///< name of its field: "ratio_raw" or "ratio_native_bounces"
    std::optional<double> before;
    std::optional<double> now;
    bool fell = false;  ///< the ratio fell by more than the tolerance
};

/// Returns every ratio that exists in `before` or `now`. Ratios are in the order of the cases in `before`, followed by
/// cases that exist only in `now`. `fell` is false if the ratio exists on one side only.
/// \param tolerance  allowed decrease relative to the earlier value, in [0, 1)
[[nodiscard]] std::vector<RatioChange> compare_ratios(const SuiteRatios& before, const SuiteRatios& now,
                                                      double tolerance);

}  // namespace ricochet::bench
