/// \file
/// Private to the simulation: steps that coasting particles still have to make. A particle that makes many of them at
/// once is fetched from memory once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/dynamics/coasting.h"

namespace ricochet {

/// Which particle has made which of the latest steps. Particles that coast make none of them before they are asked to.
class OwedSteps {
public:
    /// No more steps are kept, so that they stay in the nearest memory and numbers small.
    static constexpr std::size_t kMost = 64;

    /// Nothing is owed by any of `count` particles.
    explicit OwedSteps(std::size_t count) : made_(count, 0) {}

    /// The step that all coasting particles owe from now on. Not when is_full().
    void add(const Coasting& step) { steps_.push_back(step); }
    [[nodiscard]] bool is_full() const { return steps_.size() == kMost; }
    [[nodiscard]] bool is_empty() const { return steps_.empty(); }

    /// A particle that is born within the step that is made now: it owes nothing.
    void append() { made_.push_back(static_cast<std::uint8_t>(steps_.size())); }
    /// Keeps the particles whose flag is not 0. keep.size() is the number of particles.
    void compact(const std::vector<std::uint8_t>& keep) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < keep.size(); ++i) {
            if (keep[i] != 0) made_[kept++] = made_[i];
        }
        made_.resize(kept);
    }

    /// Where a particle that owes steps is after them.
    [[nodiscard]] PhaseState after(std::size_t i, PhaseState state) const {
        for (std::size_t k = made_[i]; k < steps_.size(); ++k) state = steps_[k].step(state.position, state.velocity);
        return state;
    }
    /// The particle has made all steps so far and the one that is made now.
    void make_next(std::size_t i) { made_[i] = static_cast<std::uint8_t>(steps_.size() + 1); }
    /// Every particle has made all steps.
    void clear() {
        steps_.clear();
        std::fill(made_.begin(), made_.end(), std::uint8_t{0});
    }

private:
    std::vector<Coasting> steps_;
    std::vector<std::uint8_t> made_;  ///< of every particle how many of them
};

}  // namespace ricochet
