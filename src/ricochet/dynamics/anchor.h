/// \file
/// Springs from particles to fixed points.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ricochet/dynamics/force.h"

namespace ricochet {

/// F = -stiffness (|d| - rest_length) d / |d| - damping (v . d) d / |d|^2 with d from the anchor to the particle: the
/// damper acts along the spring alone. At the anchor itself, where a spring has no direction, it does nothing. The
/// potential is that of the spring, stiffness / 2 (|d| - rest_length)^2; damping stores none.
struct AnchorSettings {
    Vec3 position;                           ///< m
    double stiffness = 0.0;                  ///< N/m, >= 0
    double rest_length = 0.0;                ///< m, >= 0
    double damping = 0.0;                    ///< kg/s, >= 0
    std::vector<std::uint64_t> particles{};  ///< ids of those that hang on it; empty: all
};
[[nodiscard]] std::unique_ptr<Force> make_anchor(AnchorSettings settings);

}  // namespace ricochet
