/// \file
/// The ratios of a run kept in a file, to see whether later versions of the program have become slower. Ratios of two
/// runs can be compared where their times cannot.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/bench/measurement.h"

namespace ricochet::bench {

/// What is kept of a case.
struct CaseRatios {
    std::string name;
    std::optional<double> raw;             ///< Row::ratio_raw, > 0
    std::optional<double> native_bounces;  ///< Row::ratio_native_bounces, > 0
};

/// What is kept of a suite.
struct SuiteRatios {
    std::string suite;
    std::string machine;  ///< that they come from
    std::string version;  ///< of ricochet
    std::vector<CaseRatios> cases;
};

/// The ratios of measured rows; of a case's rows the first counts.
[[nodiscard]] SuiteRatios ratios_of(std::span<const Row> rows, std::string_view suite, std::string_view machine,
                                    std::string_view version);

/// As JSON.
[[nodiscard]] std::string to_json(const SuiteRatios& ratios);

/// Reads what to_json() has written. Throws InputError when the file cannot be read, is something else, or belongs to
/// another suite.
[[nodiscard]] SuiteRatios read_ratios(const std::filesystem::path& file, std::string_view suite);

/// One ratio, before and now; nothing where it does not exist.
struct RatioChange {
    std::string name;   ///< of the case
    std::string ratio;  ///< its field's name: "ratio_raw" or "ratio_native_bounces"
    std::optional<double> before;
    std::optional<double> now;
    bool fell = false;  ///< by more than the tolerance
};

/// Every ratio that is there before or now, in the order of the cases before, new ones last. Only a ratio that is there
/// on both sides can fall.
/// \param tolerance  part of the ratio before, in [0, 1)
[[nodiscard]] std::vector<RatioChange> compare_ratios(const SuiteRatios& before, const SuiteRatios& now,
                                                      double tolerance);

}  // namespace ricochet::bench
