/// \file
/// Turbulence without divergence: the curl of a noise.
#pragma once

#include <cstdint>

#include "ricochet/dynamics/flow_field.h"

namespace ricochet {

/// Eddies of several sizes. Octave k has eddies of size length / 2^k, speeds times gain^k, and changes (2 gain)^k times
/// as fast as the first, as eddies that turn over do.
struct TurbulenceSettings {
    std::uint64_t seed = 0;
    double speed = 1.0;         ///< m/s, root mean square over space and seeds, >= 0
    double length = 1.0;        ///< m, size of the largest eddies (distance of the noise's lattice points), > 0
    std::uint32_t octaves = 3;  ///< 1 to kMostOctaves
    double gain = 0.5;          ///< speed of an octave over that of the one before, > 0 and <= 1; 0.79: Kolmogorov's
    double rate = 0.0;          ///< 1/s: how often the largest eddies are replaced by new ones; 0: frozen
};
inline constexpr std::uint32_t kMostOctaves = 16;

/// The curl of three gradient noises, taken analytically: its divergence is zero but for rounding. An eddy pattern
/// repeats after 256 lengths of its octave. In time it goes from one noise to the next with weights whose squares add
/// up to 1, so that the mean speed stays.
/// Method: R. Bridson, J. Hourihan, M. Nordenstam, "Curl-noise for procedural fluid flow", ACM TOG 26(3), 2007;
/// gradient noise: K. Perlin, "Improving noise", ACM TOG 21(3), 2002.
[[nodiscard]] FlowPointer make_turbulence(const TurbulenceSettings& settings);

}  // namespace ricochet
