// Meshes for the particles of a page.
#pragma once

#include "run/run_folder.h"
#include "view/page/page_shapes.h"

namespace ricochet::cli {

/// Returns the meshes of the run's picture and of its emitters' drawings, rotated as in `ricochet render`. Throws
/// InputError if a mesh is missing.
[[nodiscard]] PageShapes page_shapes(const RunFolder& folder);

}  // namespace ricochet::cli
