/// \file
/// Private to the responses: the ways of two spheres in a step, and whether they meet on them.
#pragma once

#include <optional>
#include <span>

#include "ricochet/dynamics/coupled_member.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// The way of a sphere that certainly touches no wall and meets no other one, until `end`, s.
[[nodiscard]] FlownPiece free_way(const ResponseRules& rules, const ForceInput& state, double end);
/// When spheres on two ways first meet, s; nothing where they do not. distance: of their centres then, m; slow: m/s, an
/// approach that does not count.
[[nodiscard]] std::optional<double> first_meeting(std::span<const FlownPiece> first, std::span<const FlownPiece> second,
                                                  double distance, double slow);

/// Two that are so much nearer at the end of a step than at its begin that they press on each other. distance: of the
/// centres where they touch, m.
[[nodiscard]] bool has_sunk(double distance, double smaller_radius, const Vec3& apart_before, const Vec3& apart_after);

}  // namespace ricochet
