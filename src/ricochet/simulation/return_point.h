/// \file
/// Private to the simulation: the state to which a stopped step goes back.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "ricochet/core/byte_stream.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/verify/verifier.h"

namespace ricochet {

/// A state that is saved now and then. After going back, the steps since then are repeated with the same bits. So the
/// wall-clock time decides when a state is saved, and never the results.
class ReturnPoint {
public:
    /// Parts of the simulation outside a saved state.
    struct Beside {
        std::vector<Emitter> emitters;
        std::vector<Violation> violations;
    };

    /// Returns true if saving the state now costs a small part of the time since it was last saved.
    [[nodiscard]] bool is_due() const;
    /// Saves the bytes that `save` writes. A state of more than kMostBytes is not kept.
    void keep(const std::function<void(const ByteSink&)>& save, Beside beside);
    /// Marks the state as changed by more than the steps that add_step() counts.
    void invalidate() { is_valid_ = false; }
    /// Counts a step since the state was saved.
    void add_step(double seconds) { ++steps_, seconds_ += seconds; }

    /// Returns true if going back takes a fraction of a second.
    [[nodiscard]] bool is_near() const { return is_valid_ && seconds_ <= kLongestReplay; }
    /// Returns the number of steps since the state was saved.
    [[nodiscard]] std::uint64_t steps() const { return steps_; }
    /// Returns the bytes of the state, from their start.
    [[nodiscard]] ByteSource source() const;
    [[nodiscard]] const Beside& beside() const { return beside_; }

private:
    using Clock = std::chrono::steady_clock;

    /// Most bytes of a saved state: some hundred thousand particles. More would count in estimates of memory.
    static constexpr std::size_t kMostBytes = std::size_t{1} << 24U;
    // Local, because only the cost depends on it.
    static constexpr double kShortestInterval = 0.25;  // s between two states
    static constexpr double kCostInterval = 50.0;      // multiple of the time to save one
    static constexpr double kLongestReplay = 0.5;      // s

    std::vector<std::byte> bytes_;
    Beside beside_;
    bool is_valid_ = false;
    bool has_tried_ = false;
    Clock::time_point tried_at_;
    double cost_ = 0.0;        // s, to save the last state
    std::uint64_t steps_ = 0;  // since then
    double seconds_ = 0.0;     // s, that they took
};

}  // namespace ricochet
