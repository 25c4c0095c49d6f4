/// \file
/// Private to the simulation: the module that adds the particles that particles spawn.
#pragma once

#include <vector>

#include "ricochet/simulation/modules.h"
#include "ricochet/simulation/offspring.h"

namespace ricochet {

class CloudMotion;

/// Adds the children of each generation, and records all births.
class ChildrenModule final : public Module {
public:
    explicit ChildrenModule(const ModuleParts& parts);

    /// Sets the clouds, which must outlive it.
    void set_clouds(CloudMotion& clouds);
    /// Returns the particles born in the last step.
    [[nodiscard]] const std::vector<BirthRecord>& births() const { return births_; }
    /// Forgets the births of a stopped step.
    void forget_births() { births_.clear(); }

    void begin_step(const TimeSpan& step) override;
    void before_generation(const ParticleRange& generation, const TimeSpan& step) override;
    bool spawn(const TimeSpan& step) override;
    void end_step(SimulationStatistics& statistics) override;
    void append() override;
    void restart(double /*time*/) override { is_in_step_ = false; }

private:
    void inherit_sides(const Child& child);
    void count(const OffspringCounts& counts);

    ModuleParts parts_;
    Offspring offspring_;
    CloudMotion* clouds_ = nullptr;  // null without clouds
    std::vector<BirthRecord> births_;
    bool is_in_step_ = false;  // users can add particles between steps
};

}  // namespace ricochet
