/// \file
/// Private to the simulation: the module of springs, and of other actions of particles on each other.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/simulation/coupled_motion.h"
#include "ricochet/simulation/modules.h"

namespace ricochet {

class PairMotion;

/// Plans the motion of particles that springs, or forces between particles, couple. Children join in the next step.
/// Every run has this module; it does nothing if no particles are coupled. If ranks share the run, particles with
/// springs live on the first rank, which plans their motion.
class SpringsModule final : public Module {
public:
    /// setup: gives springs and forces away.
    SpringsModule(SimulationSetup& setup, const ModuleParts& parts);

    [[nodiscard]] const CoupledMotion& motion() const { return motion_; }
    [[nodiscard]] const std::vector<SpringFace>& faces() const { return faces_; }
    /// Sets the spheres that meet each other, which must outlive it.
    void set_pairs(const PairMotion& pairs) { pairs_ = &pairs; }

    void before_generation(const ParticleRange& generation, const TimeSpan& step) override;
    double plan(const ParticleRange& generation, const TimeSpan& rest) override;
    void correct(const ParticleRange& generation, const TimeSpan& substep, std::vector<BlockRecord>& blocks) override;
    void after_generation(const ParticleRange& generation, const TimeSpan& step) override;
    void end_step(SimulationStatistics& statistics) override;
    void bind() override;
    [[nodiscard]] bool allows_deferred_steps() const override { return !motion_.is_active(); }
    void archive(BinaryWriter& a) override { motion_.archive(a); }
    void archive(BinaryReader& a) override { motion_.archive(a); }

private:
    [[nodiscard]] bool moves(const ParticleRange& generation) const {
        return motion_.is_active() && !generation.are_children;
    }
    [[nodiscard]] double plan_here(const TimeSpan& rest);
    [[nodiscard]] double plan_on_first_rank(const TimeSpan& rest);

    ModuleParts parts_;
    CoupledMotion motion_;
    std::vector<SpringFace> faces_;
    const PairMotion* pairs_ = nullptr;  // null if spheres do not meet each other
};

}  // namespace ricochet
