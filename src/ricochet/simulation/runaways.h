/// \file
/// Private to the simulation: ends a run in which a particle exceeds the speed of light.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/simulation/modules.h"

namespace ricochet {

/// Throws DivergedError if a particle was accelerated beyond kMaxSpeed. A particle that is born faster than light is
/// allowed, and can hit others.
class Runaways final : public Module {
public:
    explicit Runaways(const ModuleParts& parts) : parts_(parts) {}

    void before_generation(const ParticleRange& generation, const TimeSpan& step) override;
    void correct(const ParticleRange& generation, const TimeSpan& substep, std::vector<BlockRecord>& blocks) override;
    void append() override;
    [[nodiscard]] bool allows_deferred_steps() const override { return true; }
    void archive(BinaryWriter& /*a*/) override {}
    /// A restored particle counts like one that is born.
    void archive(BinaryReader& a) override;

private:
    void note_speed(std::size_t i);
    [[nodiscard]] std::string message_of(const Runaway& runaway) const;

    ModuleParts parts_;
    double step_end_ = 0.0;  // s
    /// Id and speed, in m/s, of the first particle that was faster than light at its birth.
    std::optional<std::pair<std::uint64_t, double>> faster_than_light_;
};

}  // namespace ricochet
