/// \file
/// Meshes that replace spheres on a page, and the rotations of the particles.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/vtk.h"
#include "view/render/turning.h"

namespace ricochet {

/// Meshes that represent particles on a page instead of spheres.
struct PageShapes {
    std::vector<int> of;  ///< index of the mesh by number of the drawing (0: the picture's own drawing); -1: no mesh
    std::vector<TriangleMesh> meshes;  ///< the vertices of each mesh are at most 1 from its origin
    /// Returns the rotations of the particles of a frame. Frames must be passed in order of time.
    std::function<std::vector<Turn>(const VtkPolyData& frame)> turns;
    std::vector<std::string> notes;  ///< messages about shapes that the page cannot draw
};

}  // namespace ricochet
