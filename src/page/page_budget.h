/// \file
/// What a page leaves out so that it fits its budget of bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "page/frame_encoder.h"

namespace ricochet {

/// Details from everything to the least that is worth a page, each asking for fewer bytes than the one before: fewer
/// bits first, then fewer frames, then fewer particles, then frames again. frames, most_particles: of the run.
[[nodiscard]] std::vector<PageDetail> detail_ladder(std::size_t frames, std::uint64_t most_particles);

/// The first index from `begin` of which the bytes fit, where they fall along the ladder; size() when none fits.
/// Looks at few of them.
[[nodiscard]] std::size_t first_fitting(const std::vector<PageDetail>& ladder, std::size_t begin, double budget,
                                        const std::function<double(const PageDetail&)>& bytes);

}  // namespace ricochet
