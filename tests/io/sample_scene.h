/// \file
/// A scene with every key of the format. Tests modify it to provoke errors.
#pragma once

#include <string>

#include "support/temporary_folder.h"

namespace ricochet::test {

inline constexpr const char* kSampleMesh =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nusemtl stone\nf 3 1 4\n";

inline constexpr const char* kSampleScene = R"({
  "ricochet": 1,
  "$schema": "../docs/scene.schema.json",
  "simulation": {"time_step": 0.01, "duration": 2, "integrator": "symplectic_euler", "response": "exact",
                 "seed": 7, "resting_speed": 0.002, "bounce_budget": 50},
  "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}, {"type": "drag", "coefficient": 0.05}],
  "materials": {"rubber": {"restitution": 0.8, "friction": 0.3}, "old ice": {"restitution": 0.5}},
  "colliders": [
    {"name": "floor", "type": "plane", "point": [0, 0, -1], "normal": [0, 0, 2], "material": "old ice"},
    {"name": "rock", "type": "mesh", "file": "rock.obj", "position": [1, 2, 3],
     "rotation": {"axis": [0, 0, 1], "degrees": 90}, "scale": [1, 1.5, -1], "material": "rubber",
     "group_materials": {"stone": "old ice"}}],
  "emitters": [
    {"name": "tap", "type": "point", "center": [0, 0, 3], "burst": 5, "rate": [20, 2], "start": 0.5, "stop": 1.5,
     "limit": 30, "direction": [0, 0, -1], "cone": 20, "speed": [3, 0.5], "velocity": [1, 0, 0], "mass": [2, 0.5],
     "lifetime": [4, 1], "particle_radius": 0},
    {"type": "disk", "center": [0, 0, 3], "normal": [0, 0, -1], "radius": 0.5, "rate": 10},
    {"type": "box", "center": [0, 0, 3], "size": [1, 2, 0], "rate": 10},
    {"type": "sphere", "center": [0, 0, 3], "radius": 0.5, "surface": true, "rate": 10},
    {"type": "mesh", "collider": "rock", "rate": 10},
    {"type": "mesh", "file": "rock.obj", "position": [5, 0, 0], "rotation": {"axis": [1, 0, 0], "degrees": 30},
     "scale": 2, "rate": 10}],
  "particles": [{"position": [0, 0, 1], "velocity": [1, 0, 0], "mass": 0.5, "radius": 0}, {"position": [0, 0, 2]}],
  "bounds": {"lower": [-10, -10, -10], "upper": [10, 10, 10]},
  "output": {"format": "vtp", "every": 2, "contacts": true},
  "camera": {"position": [0, -10, 3], "target": [0, 0, 0], "up": [0, 0, 1], "field_of_view": 40}
}
)";

/// A folder with the sample's mesh and a folder "sub".
class SampleFolder : public TemporaryFolder {
public:
    SampleFolder() {
        (void)write("rock.obj", kSampleMesh);
        std::filesystem::create_directory(path("sub"));
    }
};

}  // namespace ricochet::test
