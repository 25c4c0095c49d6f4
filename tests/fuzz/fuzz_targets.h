/// \file Fuzz targets, which process bytes from an untrusted source. Each runs under libFuzzer (entry_point.cpp). The
/// ordinary tests run it over its seeds and over all inputs that once failed (replay_test.cpp).
#pragma once

#include <array>
#include <stdexcept>
#include <string_view>

namespace ricochet::fuzz {

/// Violation of an invariant.
class Finding : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

/// Throws Finding unless the claim holds.
inline void require(bool holds, const char* claim) {
    if (!holds) throw Finding(claim);
}

// Each target returns true if it accepts the bytes. It throws a Finding, or passes on an exception of the program, if
// it finds an error.

/// Reads text, or binary data if the bytes begin like it.
[[nodiscard]] bool fuzz_gltf(std::string_view bytes);
[[nodiscard]] bool fuzz_obj(std::string_view bytes);
[[nodiscard]] bool fuzz_off(std::string_view bytes);
[[nodiscard]] bool fuzz_ply(std::string_view bytes);
[[nodiscard]] bool fuzz_stl(std::string_view bytes);
/// Reads a particle table.
[[nodiscard]] bool fuzz_csv(std::string_view bytes);
/// Reads a flow on a grid.
[[nodiscard]] bool fuzz_vti(std::string_view bytes);
/// Reads a frame.
[[nodiscard]] bool fuzz_vtp(std::string_view bytes);
/// Reads a scene file in the folder tests/fuzz/scene_files. Scenes that name files elsewhere or request thousands of
/// particles are skipped.
[[nodiscard]] bool fuzz_scene(std::string_view bytes);
/// Edits a checkpoint (checkpoint_target.cpp) and corrects its checksums.
[[nodiscard]] bool fuzz_checkpoint(std::string_view bytes);
/// Builds a scene from choices (tiny_scene.h) and runs it for some steps.
[[nodiscard]] bool fuzz_run(std::string_view bytes);

/// Target with its name, which is also the name of its folders of seeds and regressions.
struct FuzzTarget {
    const char* name;
    bool (*run)(std::string_view bytes);
};

inline constexpr std::array kFuzzTargets{
    FuzzTarget{"checkpoint", fuzz_checkpoint},
    FuzzTarget{"csv", fuzz_csv},
    FuzzTarget{"gltf", fuzz_gltf},
    FuzzTarget{"obj", fuzz_obj},
    FuzzTarget{"off", fuzz_off},
    FuzzTarget{"ply", fuzz_ply},
    FuzzTarget{"run", fuzz_run},
    FuzzTarget{"scene", fuzz_scene},
    FuzzTarget{"stl", fuzz_stl},
    FuzzTarget{"vti", fuzz_vti},
    FuzzTarget{"vtp", fuzz_vtp},
};

}  // namespace ricochet::fuzz
