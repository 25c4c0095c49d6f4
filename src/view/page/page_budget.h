/// \file
/// What a page leaves out so that it fits its budget of bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "view/page/frame_encoder.h"

namespace ricochet {

/// Of positions on any page, and the most of them.
inline constexpr int kLeastPositionBits = 11;
inline constexpr int kMostPositionBits = 16;

/// Details from everything to the least that is worth a page, each asking for fewer bytes than the one before: fewer
/// bits first, then fewer frames, then fewer particles, then frames again. frames, most_particles: of the run;
/// least_bits: of positions, see needed_position_bits().
[[nodiscard]] std::vector<PageDetail> detail_ladder(std::size_t frames, std::uint64_t most_particles,
                                                    int least_bits = kLeastPositionBits);

/// The bits from which on rounding puts spheres of this radius no more than a tenth of it from their place, where the
/// box's longest edge is so long; m. Spheres that lie on a wall would be seen to stand off it, or in it. radius 0: any.
[[nodiscard]] int needed_position_bits(double radius, double longest_edge);

/// The first index from `begin` of which the bytes fit, where they fall along the ladder; size() when none fits.
/// Looks at few of them.
[[nodiscard]] std::size_t first_fitting(const std::vector<PageDetail>& ladder, std::size_t begin, double budget,
                                        const std::function<double(const PageDetail&)>& bytes);

}  // namespace ricochet
