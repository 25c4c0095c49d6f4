/// \file
/// Reduction of a page's detail until the page fits a budget of bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "view/page/frame_encoder.h"

namespace ricochet {

/// Least and largest number of bits per coordinate of positions on any page.
inline constexpr int kLeastPositionBits = 11;
inline constexpr int kMostPositionBits = 16;

/// Returns levels of detail from full detail to the least useful one. Each level needs fewer bytes than the previous
/// level. First the bits decrease, then the number of frames, then the number of particles, then the number of frames
/// again. `frames` is the number of frames of the run, and `most_particles` the largest number of particles in a frame.
/// Positions never have fewer than `least_bits` bits, see needed_position_bits().
[[nodiscard]] std::vector<PageDetail> detail_ladder(std::size_t frames, std::uint64_t most_particles,
                                                    int least_bits = kLeastPositionBits);

/// Returns the least number of bits of positions for which rounding moves a sphere by at most a tenth of its radius.
/// The result is limited to kMostPositionBits. With fewer bits, spheres on a wall would visibly float above it or sink
/// into it. Lengths are in m. For a radius of 0, the result is kLeastPositionBits.
[[nodiscard]] int needed_position_bits(double radius, double longest_edge);

/// Returns the index of the first level, from `begin`, whose bytes fit into the budget. Returns the ladder's size if no
/// level fits. The bytes must decrease along the ladder. The search is binary, because `bytes` is expensive.
[[nodiscard]] std::size_t first_fitting(const std::vector<PageDetail>& ladder, std::size_t begin, double budget,
                                        const std::function<double(const PageDetail&)>& bytes);

}  // namespace ricochet
