/// \file
/// One run against the reference: energies at equal times, first impacts and last places of equal particles.
#pragma once

#include <span>

#include "ricochet/compare/figures.h"
#include "ricochet/compare/measured_run.h"

namespace ricochet {

/// Value at `time` of a series given at ascending times, linear between them and constant beyond both ends. Not empty.
[[nodiscard]] double interpolate(std::span<const double> times, std::span<const double> values, double time);

/// What energy errors are divided by, J: the largest rise of the reference's energy over its minimum, or its largest
/// kinetic energy where that is larger.
[[nodiscard]] double energy_scale(const RunTrace& reference);

/// A particle is the same one where the ids are: the schedule of births does not depend on the time step.
[[nodiscard]] ReferenceErrors errors_against(const RunTrace& run, const RunTrace& reference);

}  // namespace ricochet
