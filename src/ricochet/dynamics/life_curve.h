/// \file
/// Attributes that change with a particle's age: factors keyed over its life, worked out when a state is shown and
/// never stored, so that they do not depend on the time step.
#pragma once

#include <span>
#include <string>

#include "ricochet/dynamics/attributes.h"
#include "ricochet/dynamics/keyed_curve.h"

namespace ricochet {

/// A factor for one attribute over a particle's life.
struct LifeCurve {
    std::string name;         ///< of the attribute
    KeyedCurve<Vec3> factor;  ///< of each component; of one component: x
    bool of_lifetime = true;  ///< the curve's time is the part of the lifetime that has passed, 0..1; false: the age, s
};

/// A value with the factors of all curves of that name at an age (s). A lifetime without end counts as just begun.
[[nodiscard]] AttributeValue shown_value(std::span<const LifeCurve> curves, std::string_view name,
                                         const AttributeValue& value, double age, double lifetime);

}  // namespace ricochet
