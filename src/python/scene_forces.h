/// \file
/// Fingerprint of a scene's forces. It shows whether a saved state continues under the same forces.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet {

/// Returns a hash of the values of "forces", "particle_forces" and "flows" in a scene after the overrides. The hash
/// excludes the contents of files. An empty list has the same hash as a missing list. Throws InputError if
/// parse_scene() refuses the syntax of the text.
[[nodiscard]] std::uint64_t forces_fingerprint(std::string_view text, const std::vector<std::string>& overrides);

}  // namespace ricochet
