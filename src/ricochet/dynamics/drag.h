/// \file
/// Drag: what a medium does to a particle that moves through it. Laws differ in how the force grows with the velocity w
/// relative to the medium; each takes a flow, or leaves it out for a medium at rest. Drags store no energy.
#pragma once

#include <memory>

#include "ricochet/dynamics/flow_field.h"
#include "ricochet/dynamics/force.h"

namespace ricochet {

/// F = -coefficient w; coefficient in kg/s, >= 0.
[[nodiscard]] std::unique_ptr<Force> make_linear_drag(double coefficient, FlowPointer flow = nullptr);

/// F = -coefficient |w| w; coefficient in kg/m, >= 0: for particles of any radius, points too.
[[nodiscard]] std::unique_ptr<Force> make_quadratic_drag(double coefficient, FlowPointer flow = nullptr);

/// F = -1/2 fluid_density drag_coefficient pi radius^2 |w| w for the particle's own radius: none for points.
/// drag_coefficient: a pure number >= 0 (0.47 for a ball at medium speeds); fluid_density in kg/m^3, >= 0.
/// Source: G. K. Batchelor, "An Introduction to Fluid Dynamics", Cambridge 1967, section 5.11.
[[nodiscard]] std::unique_ptr<Force> make_sphere_drag(double drag_coefficient, double fluid_density,
                                                      FlowPointer flow = nullptr);

/// Stokes's law F = -6 pi viscosity radius w, for slow spheres (Reynolds numbers below some 0.1); none for points.
/// viscosity: dynamic, Pa s, >= 0. Source: G. G. Stokes, Trans. Cambridge Phil. Soc. 9, 1851.
[[nodiscard]] std::unique_ptr<Force> make_stokes_drag(double viscosity, FlowPointer flow = nullptr);

/// Spheres at any speed below some Re = 2e5: F = -1/2 fluid_density C_d pi radius^2 |w| w with the drag coefficient
/// below; none for points. fluid_density in kg/m^3, >= 0; viscosity: dynamic, Pa s, > 0.
[[nodiscard]] std::unique_ptr<Force> make_schiller_naumann_drag(double fluid_density, double viscosity,
                                                                FlowPointer flow = nullptr);

/// Drag coefficient of a sphere by its Reynolds number (> 0): 24 / Re (1 + 0.15 Re^0.687) below 1000, 0.44 above.
/// Source: L. Schiller, A. Naumann, Z. Ver. Dt. Ing. 77, 1933, as given in R. Clift, J. R. Grace, M. E. Weber,
/// "Bubbles, Drops, and Particles", Academic Press 1978, chapter 5.
[[nodiscard]] double schiller_naumann_coefficient(double reynolds);

}  // namespace ricochet
