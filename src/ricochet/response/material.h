/// \file
/// What a surface does to what hits it.
#pragma once

#include <string>

namespace ricochet {

/// Surface material; particles take the collider's.
struct Material {
    std::string name;
    double restitution = 1.0;  ///< rebound speed over approach speed along the normal, 0..1
    double friction = 0.0;     ///< Coulomb coefficient, >= 0, for impacts and sliding
};

}  // namespace ricochet
