/// \file
/// Results of counters: tables over time and of histograms, and the entries of the summary.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// Passages of a counter at the time of the last rows.
struct CounterCounts {
    std::uint64_t forward = 0;
    std::uint64_t backward = 0;
    double forward_mass = 0.0;   ///< kg
    double backward_mass = 0.0;  ///< kg
};

/// Rows of counters.csv so far, and the state at the start of the next rows' interval. Stored in checkpoints.
struct CounterRows {
    std::string text;                   ///< lines without the header
    std::vector<CounterCounts> counts;  ///< one entry for each counter; empty before the first rows
};

/// Table with one row per output time for each counter, and a table of all histograms.
class CounterTables {
public:
    /// rows: rows of the interrupted run that continues here.
    explicit CounterTables(std::filesystem::path folder, CounterRows rows = {})
        : folder_(std::move(folder)), rows_(std::move(rows)) {}

    /// Appends the rows of the current output time, with the passages since the rows before.
    void add(const Simulation& simulation);
    /// Writes the tables that apply to this simulation. Throws RunError if writing fails.
    void write(const Simulation& simulation) const;
    [[nodiscard]] const CounterRows& rows() const { return rows_; }

private:
    std::filesystem::path folder_;
    CounterRows rows_;
};

/// Returns the results of a counter as JSON: its entry in summary.json.
[[nodiscard]] std::string counter_json(const CounterTotals& counter);

}  // namespace ricochet
