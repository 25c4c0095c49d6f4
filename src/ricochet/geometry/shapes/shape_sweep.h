/// \file
/// First contact of a moving point or ball with a shape in the shape's own frame.
#pragma once

#include <optional>

#include "ricochet/geometry/shapes/local_shape.h"

namespace ricochet {

/// The first contact with a shape, in its frame.
struct LocalContact {
    double time = 0.0;  ///< s
    Vec3 normal;        ///< unit, from the surface to the side the path comes from
    Vec3 point;         ///< on the surface
};

/// See AnalyticShape::first_contact.
[[nodiscard]] std::optional<LocalContact> first_contact(const LocalShape& shape, const LocalPath& path, double radius);

}  // namespace ricochet
