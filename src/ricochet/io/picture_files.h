/// \file
/// Files of a scene's pictures: what particles are drawn with. A run keeps copies of them beside its run.json, so that
/// its folder can be drawn wherever it is taken.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "ricochet/io/scene.h"

namespace ricochet {

inline constexpr const char* kParticleSpriteFile = "particle_sprite.png";  ///< what sprites show
inline constexpr const char* kParticleMeshFile = "particle_mesh.obj";      ///< what particles are copies of

/// Largest PNG file that sprites may have, bytes.
inline constexpr std::uint64_t kLargestSpriteFile = std::uint64_t{64} << 20;

/// What keeps a file from being a PNG image by its first bytes; nothing when it is one.
/// Source: W3C, "Portable Network Graphics (PNG) Specification", 5.2 and 11.2.2.
[[nodiscard]] std::optional<std::string> png_problem(const std::filesystem::path& path);

/// Copies the files that the picture names into a run's folder, and names the copies instead. Meshes become OBJ files.
/// Throws InputError where one cannot be read, RunError where the disk does not take it.
void keep_picture_files(const std::filesystem::path& folder, PictureDescription& picture);

}  // namespace ricochet
