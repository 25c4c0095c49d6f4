/// \file
/// Position and orientation of a moving camera at a frame, and the fields of the frame's file that store them.
#pragma once

#include <optional>

#include "ricochet/core/vec3.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/vtk.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// Position and orientation of a camera at one time, in world coordinates.
struct CameraPosition {
    Vec3 position;  ///< m
    Vec3 target;    ///< m
    Vec3 up{0, 0, 1};
};

/// Returns the camera's position and orientation at the simulation's time.
/// frames: reference frames of the scene; may be null if the camera is not attached to a frame.
[[nodiscard]] CameraPosition current_camera_position(const CameraDescription& camera, const Vec3& up,
                                                     const FrameTree* frames, const Simulation& simulation);

/// Adds the camera to a frame of particles as the fields camera_position, camera_target and camera_up.
void add_camera(VtkPolyData& frame, const CameraPosition& camera_position);
/// Reads the fields that add_camera() wrote. Returns nothing if one of them is missing or malformed.
[[nodiscard]] std::optional<CameraPosition> camera_of_frame(const VtkPolyData& frame);

}  // namespace ricochet
