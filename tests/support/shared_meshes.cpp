#include "support/shared_meshes.h"

#include <cstdlib>

namespace ricochet::testing {

std::filesystem::path shared_mesh_folder() {
    const char* folder = std::getenv("RICOCHET_SHARED_MESHES");
    if (folder != nullptr && *folder != '\0') return folder;
    return std::filesystem::path(RICOCHET_SOURCE_DIR) / ".." / "shared" / "meshes";
}

std::optional<std::filesystem::path> shared_mesh(const std::string& name) {
    const std::filesystem::path path = shared_mesh_folder() / name;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
    return path;
}

std::string missing_mesh_sentence(const std::string& name) {
    return "The mesh " + name + " is not in " + shared_mesh_folder().lexically_normal().string() +
           "; set RICOCHET_SHARED_MESHES to the folder that holds it.";
}

}  // namespace ricochet::testing
