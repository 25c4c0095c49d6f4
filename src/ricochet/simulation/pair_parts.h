/// \file
/// Private to the simulation: the parts that move spheres which touch each other.
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

/// Parts of the simulation that move spheres which touch each other. All must outlive the objects that use this struct.
struct PairParts {
    ParticleStore& store;
    QuerySchedule& schedule;
    ActiveMover& mover;
    const Response& response;
    const CoupledMotion& coupled;
    const PairContactSettings& settings;
    PairMaterials materials;                          ///< materials of the settings
    std::optional<std::size_t> material_column = {};  ///< of kMaterialAttribute; empty if all have one material

    /// Returns false if all islands are solved impact by impact.
    [[nodiscard]] bool may_be_contact_island() const { return settings.method != PairMethod::events; }
    /// Returns the number of a particle's material.
    [[nodiscard]] std::uint32_t material_of(std::size_t particle) const {
        if (!material_column) return 0;
        return static_cast<std::uint32_t>(store.particles().attributes.value(*material_column, particle).x);
    }
};

}  // namespace ricochet
