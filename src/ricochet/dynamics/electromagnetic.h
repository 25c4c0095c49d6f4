/// \file
/// Charged particles in uniform electric and magnetic fields.
#pragma once

#include <memory>

#include "ricochet/dynamics/force.h"

namespace ricochet {

/// The Lorentz force F = q (E + v x B) on particles that all carry the same charge q. The magnetic part does no work;
/// the potential is -q E . x, zero at the world's origin. Source: J. D. Jackson, "Classical Electrodynamics", 3rd ed.,
/// section 12.2 (slow particles).
struct LorentzSettings {
    double charge = 0.0;  ///< C, of every particle
    Vec3 electric;        ///< V/m
    Vec3 magnetic;        ///< T
};
[[nodiscard]] std::unique_ptr<Force> make_lorentz_force(const LorentzSettings& settings);

}  // namespace ricochet
