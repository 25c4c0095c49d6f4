/// \file
/// Private to the simulation: the state to which a step that is stopped goes back.
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

/// A state that is kept now and then. The steps since then are made again after going back, to the same bits; so the
/// wall-clock time decides when a state is kept, and never what comes out.
class ReturnPoint {
public:
    /// Parts of the simulation outside a saved state.
    struct Beside {
        std::vector<Emitter> emitters;
        std::vector<Violation> violations;
    };

    /// True when keeping the state now costs a small part of the time since it was kept last.
    [[nodiscard]] bool is_due() const;
    /// Keeps the bytes that `save` writes. A state of more than kMostBytes is not kept.
    void keep(const std::function<void(const ByteSink&)>& save, Beside beside);
    /// The state has changed by more than steps that add_step() counts.
    void invalidate() { is_valid_ = false; }
    /// A step has been made since the state was kept.
    void add_step(double seconds) { ++steps_, seconds_ += seconds; }

    /// True when going back takes a fraction of a second.
    [[nodiscard]] bool is_near() const { return is_valid_ && seconds_ <= kLongestReplay; }
    /// Steps since the state was kept.
    [[nodiscard]] std::uint64_t steps() const { return steps_; }
    /// The bytes of the state, from their begin.
    [[nodiscard]] ByteSource source() const;
    [[nodiscard]] const Beside& beside() const { return beside_; }

private:
    using Clock = std::chrono::steady_clock;

    /// Bytes of a state that is kept: some hundred thousand particles. More would count in estimates of memory.
    static constexpr std::size_t kMostBytes = std::size_t{1} << 24U;
    // Local, because only the cost depends on it.
    static constexpr double kShortestInterval = 0.25;  // s between two states
    static constexpr double kCostInterval = 50.0;      // times that it takes to keep one
    static constexpr double kLongestReplay = 0.5;      // s

    std::vector<std::byte> bytes_;
    Beside beside_;
    bool is_valid_ = false;
    bool has_tried_ = false;
    Clock::time_point tried_at_;
    double cost_ = 0.0;        // s, of the last time that a state was kept
    std::uint64_t steps_ = 0;  // since then
    double seconds_ = 0.0;     // that they took
};

}  // namespace ricochet
