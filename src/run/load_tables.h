/// \file
/// Tables over time: loads on moving colliders, and the motion of dynamic bodies.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// Rows of colliders.csv and bodies.csv so far, and the state at the start of the next rows' interval. Stored in
/// checkpoints.
struct LoadRows {
    std::string colliders;               ///< lines of text, without the header
    std::string bodies;                  ///< lines of text, without the header
    double since = 0.0;                  ///< time of the last rows, in s; the next rows cover the interval from here
    std::vector<ColliderTotals> totals;  ///< totals at the time `since`
};

/// Tables with one row per output time for each body and for some colliders. A collider has rows only if it moves, or
/// if the surface of its material moves, such as a conveyor belt.
class LoadTables {
public:
    /// rows: rows of the interrupted run that continues here.
    explicit LoadTables(std::filesystem::path folder, LoadRows rows = {})
        : folder_(std::move(folder)), rows_(std::move(rows)) {}

    /// Appends the rows of the current output time.
    void add(const Simulation& simulation);
    /// Writes the tables that apply to this simulation. Throws RunError if writing fails.
    void write(const Simulation& simulation) const;
    [[nodiscard]] const LoadRows& rows() const { return rows_; }

private:
    std::filesystem::path folder_;
    LoadRows rows_;
};

/// Returns true if the table of colliders has rows for collider i.
[[nodiscard]] bool has_loads(const Simulation& simulation, std::size_t i);

}  // namespace ricochet
