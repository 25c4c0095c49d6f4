/// \file
/// Fingerprint of a scene's forces, for states that continue under the same forces.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet {

/// Returns a hash of the values of "forces", "particle_forces" and "flows" in a scene after the overrides. The hash
/// excludes the contents of files; an empty list equals a missing one.
/// Throws InputError if parse_scene() refuses the syntax of the text.
[[nodiscard]] std::uint64_t forces_fingerprint(std::string_view text, const std::vector<std::string>& overrides);

}  // namespace ricochet
