/// \file
/// Tables over time of what particles do to colliders that move, and of how the bodies that they push move.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// The rows of colliders.csv and bodies.csv so far, and where the next ones begin; part of a checkpoint.
struct LoadRows {
    std::string colliders;               ///< lines of text, without the header
    std::string bodies;                  ///< the same
    double since = 0.0;                  ///< s, of the last rows
    std::vector<ColliderTotals> totals;  ///< then
};

/// One row a collider and one a body at each output time. Colliders have rows where some of them move, or their
/// material does: each of those that do.
class LoadTables {
public:
    /// rows: of the interrupted run that goes on.
    explicit LoadTables(std::filesystem::path folder, LoadRows rows = {})
        : folder_(std::move(folder)), rows_(std::move(rows)) {}

    /// At an output time.
    void add(const Simulation& simulation);
    /// Writes the files that have a meaning for this simulation. Throws RunError when the disk does not take them.
    void write(const Simulation& simulation) const;
    [[nodiscard]] const LoadRows& rows() const { return rows_; }

private:
    std::filesystem::path folder_;
    LoadRows rows_;
};

/// True where the table of colliders has rows of collider i.
[[nodiscard]] bool has_loads(const Simulation& simulation, std::size_t i);

}  // namespace ricochet
