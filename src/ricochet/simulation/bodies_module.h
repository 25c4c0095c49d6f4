/// \file
/// Private to the simulation: the module of bodies that impulses of particles move.
#pragma once

#include <vector>

#include "ricochet/simulation/driven_motion.h"
#include "ricochet/simulation/modules.h"

namespace ricochet {

/// Moves dynamic bodies. A step is divided into substeps in which planned and actual loads agree. Every run has this
/// module; it does nothing without bodies.
class BodiesModule final : public Module {
public:
    /// Plans the first step. bodies: see DrivenMotion.
    BodiesModule(std::vector<BodyDescription> bodies, const ModuleParts& parts);

    [[nodiscard]] const std::vector<DrivenBody>& bodies() const { return motion_.bodies(); }

    void begin_step(const TimeSpan& step) override;
    void before_generation(const ParticleRange& generation, const TimeSpan& step) override;
    double plan(const ParticleRange& generation, const TimeSpan& rest) override;
    void record(const ParticleRange& generation, const std::vector<BlockRecord>& blocks,
                std::vector<ColliderLoad>& loads) override;
    [[nodiscard]] bool allows_deferred_steps() const override { return true; }
    [[nodiscard]] const char* fault(double time) const override;
    void add_to_fingerprint(StateHash& hash) const override;
    void archive(BinaryWriter& a) override;
    void archive(BinaryReader& a) override;

private:
    template <class Archive>
    void archive_bodies(Archive& a);
    [[nodiscard]] double plan_new(const ParticleRange& generation, const TimeSpan& rest);
    [[nodiscard]] double settle(const ParticleRange& generation, TimeSpan part);
    [[nodiscard]] double oldest_position() const;

    ModuleParts parts_;
    DrivenMotion motion_;
};

}  // namespace ricochet
