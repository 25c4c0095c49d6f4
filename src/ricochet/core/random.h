/// \file
/// Counter-based random numbers: the value depends on the key and the counter only, not on the order of draws.
#pragma once

#include <array>
#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Philox4x32 with ten rounds.
/// Method: J. Salmon et al., "Parallel Random Numbers: As Easy as 1, 2, 3", SC 2011.
[[nodiscard]] std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                      std::array<std::uint32_t, 2> key);

/// One particle's (or emitter's) own sequence of draws, keyed by (seed, stream, id); the draw counter is the state
/// that has to be kept. Two sequences with different keys are independent.
class RandomSequence {
public:
    /// seed: the scene's seed. stream: what the draws are for (one number per purpose or emitter, below 2^32).
    /// id: particle id. draw: number of draws already made.
    RandomSequence(std::uint64_t seed, std::uint32_t stream, std::uint64_t id, std::uint32_t draw = 0);

    /// Uniform in [0, 1): 53 random bits.
    double uniform();
    /// Uniform in [a - b, a + b): the scene file's pair [mean, spread].
    double uniform_around(double mean, double spread);
    /// Uniform direction on the unit sphere.
    Vec3 unit_vector();
    /// Uniform point of the unit disk (x, y); z = 0.
    Vec3 in_unit_disk();
    /// Uniform point of the unit ball.
    Vec3 in_unit_ball();

    /// Draws made so far; a sequence constructed with this number continues here.
    [[nodiscard]] std::uint32_t draws() const { return draw_; }

private:
    std::uint64_t id_;
    std::uint32_t stream_;
    std::uint32_t draw_;
    std::array<std::uint32_t, 2> key_;
};

}  // namespace ricochet
