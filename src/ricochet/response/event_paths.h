/// \file
/// Paths of two spheres in a step, and their first contact.
#pragma once

#include <optional>
#include <span>

#include "ricochet/dynamics/coupled_member.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Returns the path of a sphere that certainly touches nothing until `end`, in s.
[[nodiscard]] FlownPiece free_piece(const ResponseRules& rules, const ForceInput& state, double end);
/// Returns the time, in s, at which spheres on two paths first touch, or std::nullopt if they do not. distance:
/// distance of their centres at contact, in m. slow: largest approach speed, in m/s, that does not count as a contact.
[[nodiscard]] std::optional<double> first_meeting(std::span<const FlownPiece> first, std::span<const FlownPiece> second,
                                                  double distance, double slow);

/// Returns true if two spheres press on each other: after a step they overlap by more than kPressedOverlap times the
/// smaller radius, and are nearer than before. distance: distance of their centres at contact, in m.
[[nodiscard]] bool has_sunk(double distance, double smaller_radius, const Vec3& apart_before, const Vec3& apart_after);

}  // namespace ricochet
