/// \file
/// A run of a scene, as `ricochet run` makes it and other commands that need one.
#pragma once

#include <string>

#include "cli/arguments.h"

namespace ricochet::cli {

/// The arguments of a run as they stand on the command line.
struct RunArguments {
    SceneArguments scene;
    std::string output;        ///< folder
    std::string output_state;  ///< file; empty: none
    std::string threads;
    std::string response;
    std::string progress = "auto";  ///< auto, always or never
    bool quiet = false;
    bool resume = false;
    std::string extend;  ///< s, the time to which a run goes on; empty: as the scene says
    bool verify = false;
    bool shared = false;  ///< with the processes that mpirun has started beside this one, if it has
};

/// Runs the scene, writes its folder and reports. Returns the exit code: 0, 1 after violations, 128 + signal. Throws
/// InputError and RunError.
[[nodiscard]] int run_scene(const RunArguments& arguments);

}  // namespace ricochet::cli
