/// \file
/// The fuzz targets: what is done with bytes that a stranger may have written. Each runs under libFuzzer
/// (entry_point.cpp), and in the ordinary tests over its seeds and all inputs that it ever failed on (replay_test.cpp).
#pragma once

#include <array>
#include <stdexcept>
#include <string_view>

namespace ricochet::fuzz {

/// What must never happen has happened.
class Finding : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

/// Throws Finding unless it holds.
inline void require(bool holds, const char* claim) {
    if (!holds) throw Finding(claim);
}

// Each returns whether the bytes were accepted, and throws a Finding, or whatever else the program let out, where
// something is wrong.

/// As text, or binary where it begins so.
[[nodiscard]] bool fuzz_gltf(std::string_view bytes);
[[nodiscard]] bool fuzz_obj(std::string_view bytes);
[[nodiscard]] bool fuzz_off(std::string_view bytes);
[[nodiscard]] bool fuzz_ply(std::string_view bytes);
[[nodiscard]] bool fuzz_stl(std::string_view bytes);
/// A particle table.
[[nodiscard]] bool fuzz_csv(std::string_view bytes);
/// A flow on a grid.
[[nodiscard]] bool fuzz_vti(std::string_view bytes);
/// A frame.
[[nodiscard]] bool fuzz_vtp(std::string_view bytes);
/// A scene file beside the files of tests/fuzz/scene_files; one that names files elsewhere, or asks for
/// thousands of particles, is not read.
[[nodiscard]] bool fuzz_scene(std::string_view bytes);
/// Edits of a checkpoint (checkpoint_target.cpp), whose checksums are made right again.
[[nodiscard]] bool fuzz_checkpoint(std::string_view bytes);
/// Choices of which a scene is made (tiny_scene.h), that is run for some steps.
[[nodiscard]] bool fuzz_run(std::string_view bytes);

/// A target by its name, which is also that of its folders of seeds and regressions.
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
