/// \file
/// Which forces a scene names: for states that are to go on under the same ones.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet {

/// A hash of the values of "forces", "particle_forces" and "flows" as they stand in a scene after the overrides,
/// without what is in files that they name; an empty list counts as none. Throws InputError for a text that
/// parse_scene() refuses for its syntax.
[[nodiscard]] std::uint64_t forces_fingerprint(std::string_view text, const std::vector<std::string>& overrides);

}  // namespace ricochet
