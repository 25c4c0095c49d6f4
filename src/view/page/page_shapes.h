/// \file
/// Meshes that a page draws particles as, and how these are turned.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/vtk.h"
#include "view/render/turning.h"

namespace ricochet {

/// What a page draws particles as instead of spheres.
struct PageShapes {
    std::vector<int> of;               ///< by the number of a drawing (0: the picture's): which mesh, -1: none
    std::vector<TriangleMesh> meshes;  ///< all of each is at most 1 away from its origin
    /// How the particles of a frame are turned; asked for frames in the order of time.
    std::function<std::vector<Turn>(const VtkPolyData& frame)> turns;
    std::vector<std::string> notes;  ///< what is not drawn so
};

}  // namespace ricochet
