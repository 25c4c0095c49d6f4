/// \file
/// Camera, camera frame and automatic views.
#pragma once

#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A camera. It is a pinhole camera unless its lens has an opening.
struct Camera {
    Vec3 position;                ///< m
    Vec3 target;                  ///< m, different from position
    Vec3 up{0, 0, 1};             ///< of unit length
    double fov_degrees = 35.0;    ///< vertical field of view, between 1 and 170
    double aperture = 0.0;        ///< diameter of the lens, in m; 0: everything is in focus
    double focus_distance = 0.0;  ///< distance of the plane of focus along the view, in m; 0: the distance of the
                                  ///< target
};

/// Unit vectors of a camera: right, up in the picture, and forward.
struct CameraFrame {
    Vec3 right, up, forward;
};
[[nodiscard]] CameraFrame camera_frame(const Camera& camera);
/// Returns the tangent of half the vertical field of view. This is half the visible height at a distance of 1.
[[nodiscard]] double half_height(const Camera& camera);

/// Points that an automatic view shows.
struct ViewSubject {
    std::vector<Vec3> particles;  ///< outliers are left out of the view
    std::vector<Vec3> colliders;  ///< points of the colliders' surfaces; all are shown
};

/// Returns a three-quarter view from slightly above. The camera is just far enough away to show the subject in a
/// picture with the given ratio of width to height. Points that are not finite are ignored. An empty subject gives a
/// view of the unit ball.
[[nodiscard]] Camera automatic_camera(const ViewSubject& subject, const Vec3& up, double aspect);

}  // namespace ricochet
