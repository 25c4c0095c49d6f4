/// \file
/// Closed surfaces made by turning a profile about the z axis.
#pragma once

#include <span>
#include <vector>

#include "generators/planar_region.h"

namespace ricochet::meshes {

/// Turns a profile of points (x = distance from the axis, y = height) about z.
/// Wound outward when the solid lies to the left of the profile as it is walked.
/// \param profile  at least three points. Either its first and last points lie on the axis (distance exactly 0) and no
///                 other does, or none does and the profile is a closed loop (last point joined to the first). It must
///                 not cross itself.
/// \param segments  cells around the axis, at least 3
[[nodiscard]] TriangleMesh surface_of_revolution(std::span<const Point2> profile, int segments);

/// The polyline with points added so that pieces are about the edge length; `closed` joins the last point to the first.
[[nodiscard]] std::vector<Point2> refined(std::span<const Point2> polyline, bool closed, double edge_length);

}  // namespace ricochet::meshes
