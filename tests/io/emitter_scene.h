/// \file
/// A scene with every key of attributes, colours and sizes, rates and children.
#pragma once

namespace ricochet::test {

inline constexpr const char* kEmitterScene = R"({
  "ricochet": 1,
  "simulation": {"duration": 1, "frame_rate": 25, "max_depth": 2, "most_particles": 5000},
  "attributes": {"temperature": {"components": 1, "default": 300}, "tint": {"components": 3, "default": [1, 2, 3]},
                 "plain": {}},
  "reference_camera": {"position": [0, 0, 9], "target": [0, 0, 0], "field_of_view": 50, "image_height": 600},
  "emitters": [
    {"name": "shell", "type": "cone", "apex": [0, 0, 1], "axis": [0, 0, 2], "angle": 20, "height": 0.5,
     "rate_per_frame": [2, 1], "seed": 12, "lifetime": [2, 0.5], "speed": [3, 1],
     "color": [[0.5, 0.25, 1], [0.1, 0.2, 0]], "opacity": [0.5, 0.5], "particle_size": [0.2, 0.1],
     "attributes": {"temperature": [900, 100], "tint": [[4, 5, 6], [1, 1, 0]], "plain": 7},
     "over_life": {"color": {"keys": [{"time": 0, "value": [1, 1, 1]}, {"time": 1, "value": [0, 0, 0]}]},
                   "opacity": {"keys": [{"time": 0, "value": 1}, {"time": 1, "value": 0}], "interpolation": "spline"},
                   "attributes": {"temperature": {"keys": [{"time": 0, "value": 1}, {"time": 1, "value": 0.5}]}},
                   "vector_attributes": {"tint": {"keys": [{"time": 0, "value": [1, 0, 1]}]}}},
     "over_age": {"size": {"keys": [{"time": 0, "value": 1}, {"time": 3, "value": 2}], "ends": "repeat"}}},
    {"type": "mesh", "file": "rock.obj", "volume": true, "rate_per_area": [0.001, 0.0005]},
    {"name": "shards", "type": "child", "parent": "shell", "on": "impact", "count": [5, 2], "threshold_impulse": 0.5,
     "share": true, "recursive": true, "speed": [1, 0.5]},
    {"type": "child", "parent": "shards", "on": "death", "inherit_velocity": 0.5, "inherit_color": 0.25},
    {"type": "child", "parent": "shell", "rate": [10, 5], "lifetime": 0.5}],
  "particles": [{"position": [0, 0, 1], "color": [1, 0, 0], "opacity": 0.5, "size": 0.3,
                 "attributes": {"temperature": 450, "tint": [7, 8, 9]}}, {"position": [0, 0, 2]}]
}
)";

}  // namespace ricochet::test
