/// \file
/// A scene with all keys that change temperatures.
#pragma once

namespace ricochet::test {

inline constexpr const char* kHeatScene = R"({
  "ricochet": 1,
  "simulation": {"time_step": 0.01, "duration": 1},
  "attributes": {"temperature": {"default": 350}},
  "heat": {"specific_heat": 460, "ambient_temperature": 290, "emissivity": 0.7, "impact_fraction": 0.5,
           "friction_fraction": 0.4,
           "convection": {"conductivity": 0.03, "fluid_density": 1.1, "viscosity": 2e-5, "prandtl": 0.7,
                          "flow": {"type": "uniform", "velocity": [1, 0, 0]}}},
  "particles": [{"position": [0, 0, 1], "radius": 0.001, "mass": 3e-5}]
}
)";

}  // namespace ricochet::test
