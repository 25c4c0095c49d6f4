/// \file
/// Files of a scene's pictures: what particles are drawn with. A run keeps copies of them beside its run.json, so that
/// its folder can be drawn wherever it is taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "ricochet/io/scene.h"

namespace ricochet {

inline constexpr const char* kParticleSpriteFile = "particle_sprite.png";  ///< what sprites show
inline constexpr const char* kParticleMeshFile = "particle_mesh.obj";      ///< what particles are copies of

/// The column that says by which of the scene's drawings a particle is drawn, from 1 on; 0: as all others.
inline constexpr std::string_view kDrawingAttribute = "drawing";

/// Largest PNG file that sprites may have, bytes.
inline constexpr std::uint64_t kLargestSpriteFile = std::uint64_t{64} << 20;

/// What keeps a file from being a PNG image by its first bytes; nothing when it is one.
/// Source: W3C, "Portable Network Graphics (PNG) Specification", 5.2 and 11.2.2.
[[nodiscard]] std::optional<std::string> png_problem(const std::filesystem::path& path);

/// Returns true for the names that keep_picture_files() gives the copies of one kind. file: kParticleSpriteFile or
/// kParticleMeshFile.
[[nodiscard]] bool is_picture_file(std::string_view name, const std::filesystem::path& file);

/// Copies the files that the picture names into a run's folder, and names the copies instead. Meshes become OBJ files.
/// Throws InputError where one cannot be read, RunError where the disk does not take it.
/// number: of one of the scene's drawings, from 1 on, which is put into the names; 0: of the picture itself.
void keep_picture_files(const std::filesystem::path& folder, ParticleDrawingDescription& drawing,
                        std::size_t number = 0);

}  // namespace ricochet
