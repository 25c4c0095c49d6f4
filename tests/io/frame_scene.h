/// \file
/// A scene with every key of frames and curves. Tests modify it to provoke errors.
#pragma once

namespace ricochet::test {

inline constexpr const char* kFrameScene = R"({
  "ricochet": 1,
  "frames": {
    "hand": {"parent": "arm", "translation": [1, 0, 0], "motions": [
      {"type": "translation", "way": {"keys": [{"time": 0, "value": [0, 0, 0]}, {"time": 1, "value": [0, 1, 0]}]}}]},
    "arm": {"rotation": {"axis": [0, 0, 1], "degrees": 90}, "motions": [
      {"type": "rotation", "axis": [0, 1, 0], "angle": {"interpolation": "spline", "ends": "repeat",
       "keys": [{"time": 0, "value": 0}, {"time": 0.5, "value": 90}, {"time": 2, "value": 360}]}}]}
  },
  "emitters": [{"type": "point", "center": [0.5, 0, 0], "burst": 1, "frame": "hand"}]
}
)";

}  // namespace ricochet::test
