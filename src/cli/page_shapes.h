// What a page draws the particles of a run as.
#pragma once

#include "ricochet/io/run_folder.h"
#include "view/page/page_shapes.h"

namespace ricochet::cli {

/// The meshes of the run's picture and of its emitters' drawings, turned as `ricochet render` turns them. Throws
/// InputError where one is missing.
[[nodiscard]] PageShapes page_shapes(const RunFolder& folder);

}  // namespace ricochet::cli
