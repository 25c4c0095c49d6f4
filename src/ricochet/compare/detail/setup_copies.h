/// \file
/// The same scene again and again: a simulation takes its setup with it, a comparison needs one for every run.
#pragma once

#include <memory>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet::detail {

/// Makes setups that share what never changes (forces, meshes) and nothing else.
class SetupCopies {
public:
    explicit SetupCopies(SimulationSetup setup);
    /// A setup with these options.
    [[nodiscard]] SimulationSetup make(const SimulationOptions& options) const;
    [[nodiscard]] const SimulationOptions& options() const { return setup_.options; }

private:
    SimulationSetup setup_;  // without its forces
    std::vector<std::shared_ptr<const Force>> forces_;
};

}  // namespace ricochet::detail
