/// \file
/// Private to the simulation: removes the particles that leave at the end of a step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "ricochet/core/box3.h"
#include "ricochet/simulation/population.h"

namespace ricochet {

/// Removes particles at the end of each step. Particles in free flight are tested only if there are bounds.
class Retirement final : public Module {
public:
    /// All references must outlive the object.
    Retirement(const std::optional<Box3>& bounds, Population& population, ActiveMover& mover, RunRecorder& recorder)
        : bounds_(bounds), population_(population), mover_(mover), recorder_(recorder) {}

    [[nodiscard]] bool has_bounds() const { return bounds_.has_value(); }
    /// Statistic that counts the particles that leave for the same reason; null for a particle that stays.
    using Reason = std::uint64_t SimulationStatistics::*;
    /// Returns the reason for which particle i must be removed. time: end of the step, in s.
    [[nodiscard]] Reason removal_reason(std::size_t i, double time) const;

    void retire(double time) override;
    [[nodiscard]] bool allows_deferred_steps() const override { return !bounds_; }
    void add_to_fingerprint(StateHash& hash) const override;

private:
    /// Counts at the end of a step. Particles that leave count only as leaving.
    struct Counts {
        std::uint64_t leaving = 0;
        std::uint64_t resting = 0;
        std::uint64_t held = 0;  ///< resting particles that friction and supports keep in place
    };

    [[nodiscard]] bool is_outside(std::size_t i) const {
        return bounds_ && !bounds_->contains(population_.particles().position[i]);
    }
    [[nodiscard]] Counts count(double time) const;
    void remove_leavers(double time);

    std::optional<Box3> bounds_;
    Population& population_;
    ActiveMover& mover_;
    RunRecorder& recorder_;
};

}  // namespace ricochet
