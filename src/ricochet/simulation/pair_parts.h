/// \file
/// Private to the simulation: what spheres that meet each other are moved by.
#pragma once

#include "ricochet/response/response.h"
#include "ricochet/simulation/active_mover.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/simulation/query_schedule.h"

namespace ricochet {

/// All must outlive who has it.
struct PairParts {
    ParticleStore& store;
    QuerySchedule& schedule;
    ActiveMover& mover;
    const Response& response;
    const PairContactSettings& settings;

    /// False: impacts are worked off one after the other, whatever comes.
    [[nodiscard]] bool may_be_dense() const { return settings.method != PairMethod::events; }
};

}  // namespace ricochet
