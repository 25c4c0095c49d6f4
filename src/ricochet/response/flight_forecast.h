/// \file
/// The path that a particle is expected to take after a step, for the look-ahead of its contact query.
#pragma once

#include <optional>

#include "ricochet/collision/look_ahead.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Returns the look-ahead of the last flight of a step, as far as its path can be forecast; nothing if it cannot.
/// remaining: rest of the step, in s.
///
/// Under uniform forces the path is known. Under forces that vary, the forecast is a parabola, and LookAhead::deviation
/// is not 0. Each later step must then show that it stays within this deviation (ClearSpace).
[[nodiscard]] std::optional<LookAhead> look_ahead_of(const ResponseRules& rules, const MovingParticle& particle,
                                                     const Flight& flight, double remaining);

/// A part of a path, in s from its start.
struct PartOfPath {
    double from = 0.0;
    double until = 0.0;
};

/// Returns the free space along a part of a forecast that begins at a time, in s. Only the query's own path is known to
/// be free before its end. radius: of the particle for which the forecast was made, in m.
[[nodiscard]] ClearSpace space_along(const LookAhead& forecast, double begin, const PartOfPath& free, double radius);

}  // namespace ricochet
