/// \file
/// What a verified run found wrong, in words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ricochet/collision/collider.h"
#include "ricochet/verify/violation.h"

namespace ricochet::cli {

/// Most violations that are listed.
inline constexpr std::size_t kMostListedViolations = 20;

/// One line for every violation, up to kMostListedViolations, with particle, place, time, collider and triangle; and
/// one with the number of those that are not listed. violations: the first of the `count` that there are.
[[nodiscard]] std::vector<std::string> violation_lines(std::span<const Violation> violations, std::uint64_t count,
                                                       const std::vector<ColliderDescription>& colliders);

}  // namespace ricochet::cli
