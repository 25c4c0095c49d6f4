/// \file
/// A camera that moves: where it is at a frame of the run, and how the frame's file says so.
#pragma once

#include <optional>

#include "ricochet/core/vec3.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/vtk.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// Where a camera is at a moment, in the world.
struct CameraPlace {
    Vec3 position;  ///< m
    Vec3 target;    ///< m
    Vec3 up{0, 0, 1};
};

/// The camera at the simulation's time. frames: those of the scene; only needed by a camera that stands in one.
[[nodiscard]] CameraPlace camera_place(const CameraDescription& camera, const Vec3& up, const FrameTree* frames,
                                       const Simulation& simulation);

/// Adds it to a frame of particles as the fields camera_position, camera_target and camera_up.
void add_camera(VtkPolyData& frame, const CameraPlace& place);
/// What add_camera() added; nothing where there is none.
[[nodiscard]] std::optional<CameraPlace> camera_of_frame(const VtkPolyData& frame);

}  // namespace ricochet
