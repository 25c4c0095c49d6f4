/// \file
/// Files that a scene's pictures need: sprites and meshes of particles. A run keeps copies beside its run.json, so
/// that the folder can be drawn on any machine.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "ricochet/io/scene.h"

namespace ricochet {

inline constexpr const char* kParticleSpriteFile = "particle_sprite.png";  ///< image of a sprite
inline constexpr const char* kParticleMeshFile = "particle_mesh.obj";      ///< mesh of a particle

/// Returns true for the names that keep_picture_files() gives to the copies of one kind.
/// file: kParticleSpriteFile or kParticleMeshFile.
[[nodiscard]] bool is_picture_file(std::string_view name, const std::filesystem::path& file);

/// Copies the files of a drawing into a run's folder and makes the drawing refer to the copies. Meshes become OBJ
/// files.
/// number: part of the names of the copies. It is 0 for the picture itself, and k for the k-th drawing of the scene,
/// counted from 1.
/// Throws InputError if a file cannot be read, RunError if writing fails.
void keep_picture_files(const std::filesystem::path& folder, ParticleDrawingDescription& drawing,
                        std::size_t number = 0);

}  // namespace ricochet
