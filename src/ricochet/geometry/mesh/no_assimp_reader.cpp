// Replaces assimp_reader.cpp if the library is built without Assimp.
#include <fmt/format.h>

#include "ricochet/geometry/mesh/mesh_source.h"

namespace ricochet {

ImportedMesh read_foreign(const MeshSource& source, const std::string& extension) {
    source.fail(
        fmt::format("{} files are read by the Assimp library, which this program was built without: export as "
                    "glTF (.glb) or OBJ, or install libassimp-dev and build again",
                    extension));
}

bool reads_foreign() { return false; }

}  // namespace ricochet
