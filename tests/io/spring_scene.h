/// \file
/// A scene with every kind of spring of the format. Tests modify it to provoke errors.
#pragma once

#include "support/temporary_folder.h"

namespace ricochet::test {

inline constexpr const char* kSpringScene = R"({
  "ricochet": 1,
  "forces": [{"type": "gravity", "acceleration": [0, -9.81, 0]}],
  "particles": [{"position": [0, 0, 1], "pinned": true}, {"position": [0, 0, 3], "mass": 2}],
  "springs": [
    {"type": "list", "springs": [
      {"first": 0, "second": 1, "stiffness": 30},
      {"first": 1, "second": 2, "rest_length": 0.5, "stiffness": 40, "damping": 0.25, "breaking_stretch": 2}]},
    {"type": "rope", "from": [0, 0, 1], "to": [4, 0, 1], "nodes": 5, "length": 6, "mass": 8, "radius": 0.1,
     "stiffness": 100, "damping": 0.5, "breaking_stretch": 0.5, "pinned": "both"},
    {"type": "chain", "from": [0, 5, 1], "to": [3, 5, 1], "links": 3, "link_length": 1, "mass": 3,
     "axial_stiffness": 50, "sag": [0, 0, 1], "pinned": "from"},
    {"type": "cloth", "file": "flag.obj", "position": [0, 0, 9], "rotation": {"axis": [1, 0, 0], "degrees": 90},
     "scale": 2, "mass": 6, "radius": 0.01, "stiffness": 70, "bending_stiffness": 7, "damping": 0.125,
     "breaking_stretch": 1, "pinned": [0, 3], "pin_boxes": [{"lower": [1.5, -1, 8], "upper": [3, 1, 10]}]},
    {"type": "sheet", "corner": [9, 0, 0], "side_u": [2, 0, 0], "side_v": [0, 1, 0], "cells_u": 2, "cells_v": 1,
     "mass_per_area": 3, "stiffness": 90}]
}
)";

/// A square of two triangles.
inline constexpr const char* kFlag = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

/// A folder with the scene's cloth.
class SpringSceneFolder : public TemporaryFolder {
public:
    SpringSceneFolder() { (void)write("flag.obj", kFlag); }
};

}  // namespace ricochet::test
