/// \file
/// Private to the simulation: what spheres that meet each other are moved by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "ricochet/response/pair_materials.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/active_mover.h"
#include "ricochet/simulation/coupled_motion.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/simulation/query_schedule.h"

namespace ricochet {

/// What it refers to must outlive who has it.
struct PairParts {
    ParticleStore& store;
    QuerySchedule& schedule;
    ActiveMover& mover;
    const Response& response;
    const CoupledMotion& coupled;
    const PairContactSettings& settings;
    PairMaterials materials;                          ///< of the settings
    std::optional<std::size_t> material_column = {};  ///< of kMaterialAttribute; none where all are of one

    /// False: impacts are worked off one after the other, whatever comes.
    [[nodiscard]] bool may_be_contact_island() const { return settings.method != PairMethod::events; }
    /// Its number.
    [[nodiscard]] std::uint32_t material_of(std::size_t particle) const {
        if (!material_column) return 0;
        return static_cast<std::uint32_t>(store.particles().attributes.value(*material_column, particle).x);
    }
};

}  // namespace ricochet
