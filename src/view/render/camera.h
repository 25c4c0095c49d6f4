/// \file
/// Where a picture is taken from.
#pragma once

#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A camera, a pinhole unless its lens has an opening.
struct Camera {
    Vec3 position;                ///< m
    Vec3 target;                  ///< m, different from position
    Vec3 up{0, 0, 1};             ///< of unit length
    double fov_degrees = 35.0;    ///< vertical field of view, between 1 and 170
    double aperture = 0.0;        ///< m, diameter of the lens; 0: everything is sharp
    double focus_distance = 0.0;  ///< m along the view to what is sharp; 0: at the target
};

/// Unit vectors of a camera: right, up in the picture, and forward.
struct CameraFrame {
    Vec3 right, up, forward;
};
[[nodiscard]] CameraFrame camera_frame(const Camera& camera);
/// The tangent of half the vertical field of view: half the height of what is seen at a distance of 1.
[[nodiscard]] double half_height(const Camera& camera);

/// What an automatic view should show.
struct ViewSubject {
    std::vector<Vec3> particles;  ///< strays outside the bulk are left out of the view
    std::vector<Vec3> colliders;  ///< points of the colliders' surfaces, all shown
};

/// A view from three quarters, a little from above, just far enough away to show the subject in a picture of the given
/// width over height. Points that are not finite are ignored; an empty subject gives a view of the unit ball.
[[nodiscard]] Camera automatic_camera(const ViewSubject& subject, const Vec3& up, double aspect);

}  // namespace ricochet
