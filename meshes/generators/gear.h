/// \file
/// Spur gears with involute teeth.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Shape of a gear.
struct GearShape {
    int teeth = 18;             ///< 8 to 400
    double pitch_radius = 0.9;  ///< metres
    double bore_radius = 0.16;  ///< of the hole in the middle, metres
    double width = 0.35;        ///< along the axis, metres
    double web_recess =
        0.25;  ///< depth of the groove between hub and rim on either face, fraction of the width, 0 to 0.45
};

/// Returns a full-depth spur gear with a pressure angle of 20 degrees, axis z, centred on the origin; closed, of
/// genus 1. Throws InputError for parameters out of range and for a bore that leaves no space for hub and rim. Method:
/// involute flanks and proportions (addendum one module, dedendum 1.25) as in ISO 53.
[[nodiscard]] TriangleMesh make_gear(const GearShape& shape, double edge_length);

}  // namespace ricochet::meshes
