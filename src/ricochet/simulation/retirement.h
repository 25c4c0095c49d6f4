/// \file
/// Private to the simulation: the particles that leave at the end of a step, and the reasons.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "ricochet/core/box3.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/simulation/query_schedule.h"

namespace ricochet {

/// Reason why a particle leaves.
enum class RemovalReason : std::uint8_t {
    none,           ///< it stays
    expired,        ///< its lifetime is over
    absorbed,       ///< by a surface
    shattered,      ///< fragments replace it
    out_of_bounds,  ///< it is outside the bounds
};

/// Counts at the end of a step. Particles that leave count only as leaving.
struct EndOfStepCounts {
    std::uint64_t leaving = 0;
    std::uint64_t resting = 0;
    std::uint64_t held = 0;  ///< resting particles that friction and support hold
};

/// Tests all particles once per step. Particles in free flight are tested only if there are bounds.
class Retirement {
public:
    /// All must outlive it.
    Retirement(const ParticleStore& store, const QuerySchedule& schedule, const std::optional<Box3>& bounds)
        : store_(store), schedule_(schedule), bounds_(bounds) {}

    /// time: end of the step, in s.
    [[nodiscard]] RemovalReason removal_reason(std::size_t i, double time) const;
    /// Counts all particles, on all threads.
    [[nodiscard]] EndOfStepCounts count(double time) const;

private:
    [[nodiscard]] bool is_outside(std::size_t i) const {
        return bounds_ && !bounds_->contains(store_.particles().position[i]);
    }
    [[nodiscard]] EndOfStepCounts count_block(std::size_t begin, std::size_t end, double time) const;

    const ParticleStore& store_;
    const QuerySchedule& schedule_;
    const std::optional<Box3>& bounds_;
};

}  // namespace ricochet
