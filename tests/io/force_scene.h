/// \file
/// A scene with every force and flow of the format. Tests modify it to provoke errors.
#pragma once

#include "support/temporary_folder.h"

namespace ricochet::test {

inline constexpr const char* kSampleGrid =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\">\n<ImageData WholeExtent=\"0 1 0 0 0 0\" Origin=\"0 0 0\" "
    "Spacing=\"1 1 1\">\n<Piece Extent=\"0 1 0 0 0 0\">\n<PointData>\n<DataArray type=\"Float64\" Name=\"velocity\" "
    "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 2 4 6</DataArray>\n</PointData>\n</Piece>\n</ImageData>\n"
    "</VTKFile>\n";

inline constexpr const char* kForceScene = R"({
  "ricochet": 1,
  "flows": {
    "breeze": {"type": "uniform", "velocity": [1, 0, 0], "factor": 2},
    "storm": {"type": "sum", "factor": 0.5, "parts": [
      {"type": "uniform", "velocity": [1, 2, 3], "gust": {"amplitude": 0.5, "frequency": 2, "phase": 0.25}},
      {"type": "vortex", "point": [1, 0, 0], "axis": [0, 0, 1], "circulation": 3, "core_radius": 0.5},
      {"type": "vortex", "axis": [0, 1, 0], "circulation": 3, "core_radius": 0.5, "profile": "lamb_oseen"},
      {"type": "radial", "center": [0, 1, 0], "strength": -2, "core_radius": 0.1},
      {"type": "rotation", "point": [0, 0, 1], "angular_velocity": [0, 0, 2]},
      {"type": "shear", "point": [0, 0, 1], "rate": [2, 0, 0], "gradient": [0, 0, 3]},
      {"type": "turbulence", "speed": 0.5, "length": 0.3, "octaves": 4, "gain": 0.8, "rate": 1, "seed": 9},
      {"type": "sphere", "center": [0, 0, 9], "radius": 0.5, "velocity": [1, 0, 0]},
      {"type": "grid", "file": "wind.vti", "array": "velocity", "outside": "zero"}]}},
  "forces": [
    {"type": "gravity", "acceleration": [0, 0, -9.81]},
    {"type": "drag", "coefficient": 0.5, "flow": "breeze"},
    {"type": "drag", "coefficient": 0.25, "flow": {"type": "grid", "file": "wind.vti"}},
    {"type": "quadratic_drag", "coefficient": 0.1, "flow": "storm"},
    {"type": "quadratic_drag", "drag_coefficient": 0.47, "fluid_density": 1.2},
    {"type": "stokes_drag", "viscosity": 0.001},
    {"type": "schiller_naumann_drag", "fluid_density": 1000, "viscosity": 0.001, "flow": "breeze"},
    {"type": "buoyancy", "fluid_density": 1000, "gravity": [0, 0, -9.81]},
    {"type": "point_gravity", "attractors": [{"position": [1, 0, 0], "strength": 3, "softening": 0.1},
                                             {"position": [0, 1, 0], "strength": -1}]},
    {"type": "radial", "center": [0, 0, 1], "strength": 2, "exponent": 1, "softening": 0.1, "reference": 2},
    {"type": "swirl", "point": [1, 0, 0], "axis": [0, 0, 1], "acceleration": 3, "core_radius": 0.5},
    {"type": "field", "flow": {"type": "rotation", "angular_velocity": [0, 0, 1]}, "as": "force"},
    {"type": "lorentz", "charge": 0.5, "electric": [1, 0, 0], "magnetic": [0, 0, 2]},
    {"type": "anchor", "position": [0, 0, 5], "stiffness": 10, "rest_length": 1, "damping": 0.1, "particles": [1]}],
  "particles": [{"position": [0, 0, 1], "radius": 0.1}, {"position": [0, 0, 2], "radius": 0.1}]
}
)";

/// A folder with the scene's grid.
class ForceSceneFolder : public TemporaryFolder {
public:
    ForceSceneFolder() { (void)write("wind.vti", kSampleGrid); }
};

}  // namespace ricochet::test
