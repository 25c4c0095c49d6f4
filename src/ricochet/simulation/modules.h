/// \file
/// Private to the simulation: the list of its modules.
#pragma once

#include <vector>

#include "ricochet/simulation.h"
#include "ricochet/simulation/module.h"
#include "ricochet/simulation/population.h"
#include "ricochet/simulation/rank_share.h"
#include "ricochet/simulation/start_warnings.h"

namespace ricochet {

/// Parts of a run that modules use. All must outlive the modules.
struct ModuleParts {
    const SimulationOptions& options;
    const StartWarnings& warnings;
    const StepClock& clock;
    RankShare& share;
    CollisionScene& scene;
    const Response& response;
    RunRecorder& recorder;
    Population& population;
    const std::vector<Emitter>& emitters;
    ActiveMover& mover;
    MoveObservers& observers;  ///< modules enter their objects
};

/// Adds the modules of a run, in the order of their calls. setup: gives the settings of modules away.
void add_modules(ModuleList& modules, SimulationSetup& setup, const ModuleParts& parts);

}  // namespace ricochet
