/// \file
/// A scene with every force between particles of the format.
#pragma once

namespace ricochet::test {

inline constexpr const char* kParticleForcesScene = R"({
  "ricochet": 1,
  "simulation": {"time_step": 0.001, "duration": 1, "integrator": "velocity_verlet"},
  "attributes": {"charge": {"default": 1e-6}},
  "particle_forces": [
    {"type": "gravity", "constant": 0.5, "softening": 0.1, "method": "tree", "opening": 0.4},
    {"type": "charge", "attribute": "charge", "constant": 9e9, "softening": 0.1, "method": "direct", "particles": [0, 1]},
    {"type": "lennard_jones", "depth": 2, "diameter": 0.9, "cutoff": 3},
    {"type": "cohesion", "stiffness": 10, "range": 0.5, "damping": 0.1, "emitter": "tap"}],
  "emitters": [{"name": "tap", "type": "point", "center": [0, 0, 9], "rate": 1}],
  "particles": [{"position": [0, 0, 1], "radius": 0.4}, {"position": [0, 0, 2], "radius": 0.4},
                {"position": [0, 1, 2], "radius": 0.4}]
}
)";

}  // namespace ricochet::test
