/// \file
/// Counter-based random numbers: the value depends only on the key and the counter, not on the order of draws.
#pragma once

#include <array>
#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Philox4x32 with ten rounds.
/// Method: J. Salmon et al., "Parallel Random Numbers: As Easy as 1, 2, 3", SC 2011.
[[nodiscard]] std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                      std::array<std::uint32_t, 2> key);

/// Sequence of draws of one particle or emitter, keyed by (seed, stream, id). Only the draw counter has to be saved.
/// Two sequences with different keys are independent.
class RandomSequence {
public:
    /// seed: the scene's seed. stream: the purpose of the draws (one number per purpose or emitter, below 2^32).
    /// id: particle id. draw: number of draws already made.
    RandomSequence(std::uint64_t seed, std::uint32_t stream, std::uint64_t id, std::uint32_t draw = 0);

    /// Draws uniformly in [0, 1), with 53 random bits.
    double uniform();
    /// Draws uniformly in [mean - spread, mean + spread), as the pair [mean, spread] of a scene file specifies.
    double uniform_around(double mean, double spread);
    /// Draws a uniform direction on the unit sphere.
    Vec3 unit_vector();
    /// Draws a uniform point of the unit disk (x, y), with z = 0.
    Vec3 in_unit_disk();
    /// Draws a uniform point of the unit ball.
    Vec3 in_unit_ball();

    /// Returns the number of draws made so far. A sequence constructed with this number continues after them.
    [[nodiscard]] std::uint32_t draws() const { return draw_; }

private:
    std::uint64_t id_;
    std::uint32_t stream_;
    std::uint32_t draw_;
    std::array<std::uint32_t, 2> key_;
};

}  // namespace ricochet
