/// \file
/// Reduction of a page's detail to fit a budget of bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "view/page/frame_encoder.h"

namespace ricochet {

/// Limits of the bits of positions on any page.
inline constexpr int kLeastPositionBits = 11;
inline constexpr int kMostPositionBits = 16;

/// Returns levels of detail from full detail to the least useful one, each smaller than the previous one. First the
/// bits decrease, then the frames, then the particles, then the frames again. `frames` and `most_particles` describe
/// the run. `least_bits` is the limit for positions, see needed_position_bits().
[[nodiscard]] std::vector<PageDetail> detail_ladder(std::size_t frames, std::uint64_t most_particles,
                                                    int least_bits = kLeastPositionBits);

/// Returns the bits of positions at which rounding moves a sphere by at most a tenth of its radius. With fewer bits,
/// spheres on a wall would visibly float above it or sink into it. Lengths are in m. A radius of 0 sets no limit.
[[nodiscard]] int needed_position_bits(double radius, double longest_edge);

/// Returns the first index from `begin` whose bytes fit into the budget, or size() if none fits. The bytes must
/// decrease along the ladder. The search is binary, because `bytes` is expensive.
[[nodiscard]] std::size_t first_fitting(const std::vector<PageDetail>& ladder, std::size_t begin, double budget,
                                        const std::function<double(const PageDetail&)>& bytes);

}  // namespace ricochet
