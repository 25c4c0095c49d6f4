/// \file
/// Private to the simulation: the stage of the step in which particles cool and are heated.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ricochet/core/motion_part.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/heat.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/active_mover.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/simulation/run_recorder.h"

namespace ricochet {

/// Tells from the record of a move what surfaces have taken of the particle's motion and made heat of it: the kinetic
/// energy that its parts in contact lose, with the work that forces do meanwhile, less the work that is done on
/// surfaces that move. Flights lose nothing to surfaces.
class FrictionMeter {
public:
    /// All must outlive it; bodies: null where no collider moves.
    FrictionMeter(const HeatSettings& heat, const ForceField& forces, const MovingColliders* bodies)
        : heat_(heat), forces_(forces), bodies_(bodies) {}

    /// Appends what heats particle i, the first to the last, by a move's lists from these entries on.
    void note(std::size_t i, const ForceInput& moved, const MoveScratch& scratch, std::size_t first_record,
              std::size_t first_load, std::vector<HeatGain>& gains) const;

private:
    [[nodiscard]] double work_of_forces(const MotionPart& part, const ForceInput& moved) const;

    const HeatSettings& heat_;
    const ForceField& forces_;
    const MovingColliders* bodies_;
};

/// Changes the temperatures of all particles that have been moved.
class HeatStage {
public:
    /// column: of the temperature among the attributes. The others as for FrictionMeter.
    HeatStage(HeatSettings heat, std::size_t column, const ForceField& forces, const MovingColliders* bodies);
    HeatStage(const HeatStage&) = delete;
    HeatStage& operator=(const HeatStage&) = delete;

    /// Null where surfaces do not heat.
    [[nodiscard]] const FrictionMeter* meter() const { return heat_.is_heated_by_surfaces() ? &meter_ : nullptr; }

    /// Keeps what convection is like for the particles of the range, which are about to be moved.
    void before_move(const Particles& particles, const ParticleRange& range, const TimeSpan& step);
    /// They have been moved: each cools for as long as it has lived in the step, and is heated at the times of its
    /// gains. gains: of all parts of the step, those of one particle in the order of time.
    void after_move(Particles& particles, const ParticleRange& range, const TimeSpan& step,
                    std::vector<HeatGain> gains) const;

private:
    [[nodiscard]] double coefficient(const Particles& particles, std::size_t i, double time) const;
    [[nodiscard]] double changed(const Particles& particles, std::size_t i, const TimeSpan& life, double before,
                                 std::span<const HeatGain> gains) const;

    HeatSettings heat_;
    std::size_t column_;
    FrictionMeter meter_;
    std::vector<double> coefficients_;  // W/(m^2 K), of the range at the begin of its move; empty where they are given
};

}  // namespace ricochet
