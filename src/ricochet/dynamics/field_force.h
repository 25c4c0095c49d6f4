/// \file
/// Vector fields that act as forces by themselves.
#pragma once

#include <memory>

#include "ricochet/dynamics/flow_field.h"
#include "ricochet/dynamics/force.h"

namespace ricochet {

/// What the vectors of a field mean.
enum class FieldMeaning {
    acceleration,  ///< m/s^2, the same for every mass
    force,         ///< N
};

/// A flow's vectors taken as accelerations or forces. It has no potential.
[[nodiscard]] std::unique_ptr<Force> make_field_force(FlowPointer field, FieldMeaning meaning);

/// A force around an axis, by the right-hand rule: tangential acceleration `acceleration` (m/s^2) at the distance
/// core_radius (m, > 0), growing linearly from the axis to there and falling as one over the distance outside. axis: of
/// any length but zero. It has no potential: a particle that goes round gains energy.
[[nodiscard]] std::unique_ptr<Force> make_swirl(const Vec3& point, const Vec3& axis, double acceleration,
                                                double core_radius);

}  // namespace ricochet
