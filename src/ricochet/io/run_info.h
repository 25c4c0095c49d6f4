/// \file
/// run.json: what a run is about, written before its first step so that pictures can be made of an unfinished run too.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/io/scene.h"

namespace ricochet {

/// Where a picture is taken from.
struct CameraInfo {
    Vec3 position;              ///< m
    Vec3 target;                ///< m
    double fov_degrees = 35.0;  ///< vertical field of view
};

/// One collider of the run.
struct ColliderInfo {
    std::string name;
    std::string type;            ///< see type_name()
    std::string file;            ///< its file in the run's folder
    std::uint32_t material = 0;  ///< index of its material
};

/// Everything that run.json says.
struct RunInfo {
    std::string version;  ///< of ricochet
    std::string scene;    ///< the scene file as it was named
    Vec3 up{0, 0, 1};     ///< against gravity, along the nearest axis
    std::optional<CameraInfo> camera;
    std::vector<ColliderInfo> colliders;
};

/// What a scene says about its own picture: camera and the upward axis. Version and colliders are left empty.
[[nodiscard]] RunInfo run_info_of(const SceneDescription& scene);
[[nodiscard]] std::string run_info_text(const RunInfo& info);
/// Reads run.json. Throws InputError when it is not one.
[[nodiscard]] RunInfo read_run_info(const std::filesystem::path& path);

}  // namespace ricochet
