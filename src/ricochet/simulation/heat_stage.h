/// \file
/// Private to the simulation: changes of particle temperatures in a step.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ricochet/core/motion_part.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/heat.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/module.h"
#include "ricochet/simulation/particle_store.h"

namespace ricochet {

/// Measures the energy that surfaces turn into heat, from the record of a particle's move. This energy is the loss of
/// kinetic energy in contact, plus the work of forces in contact, minus the work on moving surfaces.
class FrictionMeter {
public:
    /// bodies: empty if no collider moves. All arguments must outlive the object.
    FrictionMeter(const HeatSettings& heat, const ForceField& forces, const MovingColliders& bodies)
        : heat_(heat), forces_(forces), bodies_(bodies) {}

    /// Appends the heat gains of a move in the order of time.
    void measure(const MoveReport& move, std::vector<HeatGain>& gains) const;

private:
    [[nodiscard]] double work_of_forces(const MotionPart& part, const ForceInput& moved) const;

    const HeatSettings& heat_;
    const ForceField& forces_;
    const MovingColliders& bodies_;
};

/// Changes the temperatures of the particles that have moved.
class HeatStage final : public Module {
public:
    /// store: particles with the temperature attribute. It must outlive the object. Other arguments: see FrictionMeter.
    HeatStage(HeatSettings heat, ParticleStore& store, const ForceField& forces, const MovingColliders& bodies);

    [[nodiscard]] MoveParts needs() const override { return {.motions = heat_.is_heated_by_surfaces()}; }
    void observe(const MoveReport& move, BlockRecord& block) override;
    /// Stores the coefficients of convection of the particles before they move.
    void before_generation(const ParticleRange& generation, const TimeSpan& step) override;
    void record(const ParticleRange& generation, const std::vector<BlockRecord>& blocks,
                std::vector<ColliderLoad>& loads) override;
    /// Cools each particle for the time that it has lived in the step. Heats it at the times of its heat gains.
    void after_generation(const ParticleRange& generation, const TimeSpan& step) override;

private:
    [[nodiscard]] double coefficient(std::size_t i, double time) const;
    [[nodiscard]] double changed(std::size_t i, const TimeSpan& life, double before,
                                 std::span<const HeatGain> gains) const;

    HeatSettings heat_;
    ParticleStore& store_;
    std::size_t column_;  // column of the temperature attribute
    FrictionMeter meter_;
    std::vector<double> coefficients_;  // W/(m^2 K), per particle before its move; empty if the scene gives one value
    std::vector<HeatGain> gains_;       // in this generation; the gains of one particle are in the order of time
};

}  // namespace ricochet
