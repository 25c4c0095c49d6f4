/// \file
/// Camera, its frame of unit vectors, and automatic choice of a view.
#pragma once

#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Camera: a pinhole camera, or a camera with a lens if `aperture` is above 0.
struct Camera {
    Vec3 position;              ///< m
    Vec3 target;                ///< m, different from position
    Vec3 up{0, 0, 1};           ///< of unit length
    double fov_degrees = 35.0;  ///< vertical field of view, between 1 and 170
    double aperture = 0.0;      ///< diameter of the lens opening, in m; 0: pinhole, everything is in focus
    /// Distance from the camera to the plane of focus, in m; 0: the plane through the target.
    double focus_distance = 0.0;
};

/// Unit vectors to the right and to the top of the picture, and in the direction of view.
struct CameraFrame {
    Vec3 right, up, forward;
};
[[nodiscard]] CameraFrame camera_frame(const Camera& camera);
/// Returns the tangent of half the vertical field of view. This is half the visible height at a distance of 1.
[[nodiscard]] double half_height(const Camera& camera);

/// Points that an automatic view shows.
struct ViewSubject {
    std::vector<Vec3> particles;  ///< outliers can be outside the view
    std::vector<Vec3> colliders;  ///< points of the colliders' surfaces; all are inside the view
};

/// Returns a view of the subject from the front right and slightly above. The camera has the smallest distance at which
/// the subject fits into a picture with the given ratio of width to height. Points that are not finite are ignored. If
/// the subject is empty, the view shows the points (-1, -1, -1) and (1, 1, 1).
[[nodiscard]] Camera automatic_camera(const ViewSubject& subject, const Vec3& up, double aspect);

}  // namespace ricochet
