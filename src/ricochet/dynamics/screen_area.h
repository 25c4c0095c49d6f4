/// \file
/// How large an emitter is on the screen of a reference camera: the second way of W. T. Reeves to say how many
/// particles a frame gives birth to ("Particle Systems", ACM TOG 2(2), 1983, section 2.1: so many a unit of screen
/// area, so that what is far away costs little). The camera belongs to the scene and never depends on how pictures are
/// made.
#pragma once

#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/emitter_shape.h"

namespace ricochet {

/// A pinhole camera with square pixels.
struct ReferenceCamera {
    Vec3 position;                        ///< m
    Vec3 target{0, 0, -1};                ///< m, different from position
    double field_of_view_degrees = 35.0;  ///< from the lower to the upper edge, 1..170
    double image_height = 720.0;          ///< pixels from the lower to the upper edge, > 0
};

/// Area of the convex hull of the shape's picture, in pixels; what lies beside the picture counts too. With s the
/// distance of the picture's plane, in pixels, s = image_height / (2 tan(field_of_view / 2)), a point at depth d and
/// distance r from the view's axis is seen at s r / d. Round shapes are taken as polygons of 256 corners. Throws
/// InputError when a part of the shape is not in front of the camera.
[[nodiscard]] double screen_area(const EmitterShape& shape, const ReferenceCamera& camera);

}  // namespace ricochet
