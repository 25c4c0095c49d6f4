/// \file
/// Private to the simulation: the list of its modules.
#pragma once

#include "ricochet/simulation/module.h"

namespace ricochet {

class CloudMotion;
class CounterTally;
class CoupledMotion;
class DrivenMotion;
class HeatStage;
class MovingColliders;
class Offspring;
class PairMotion;
class RankShare;
class Retirement;

/// Objects of a run that modules use. Pointers are null if the run does not have the capability. All must outlive the
/// modules.
struct ModuleParts {
    ParticleStore& store;
    RunRecorder& recorder;
    ActiveMover& mover;
    const StepClock& clock;
    const CollisionWorld& world;
    const std::vector<Material>& materials;
    const SimulationOptions& options;
    const std::optional<Box3>& bounds;
    const Retirement& retirement;
    const RankShare& share;
    MovingColliders* bodies;
    Offspring* offspring;
    HeatStage* heat;
    CloudMotion* clouds;
    DrivenMotion& driven;
    CoupledMotion& coupled;
    PairMotion* pairs;
    RunCheck* check;
    CounterTally* counters;
};

/// Returns the modules of a run, in the order of their calls.
[[nodiscard]] ModuleList make_modules(const ModuleParts& parts);

}  // namespace ricochet
