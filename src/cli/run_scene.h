/// \file
/// Runs of scenes, for `ricochet run` and other commands that need a run.
#pragma once

#include <string>

#include "cli/arguments.h"

namespace ricochet::cli {

/// Raw arguments of a run on the command line.
struct RunArguments {
    SceneArguments scene;
    std::string output;        ///< output folder
    std::string output_state;  ///< file for the final state; if empty, no state is written
    std::string threads;
    std::string response;
    std::string progress = "auto";  ///< auto, always or never
    bool quiet = false;
    bool resume = false;
    std::string extend;  ///< new end time of the run, in s; empty: from the scene
    bool verify = false;
    bool shared = false;  ///< joins the processes that mpirun started, if any
};

/// Runs the scene, writes its folder and prints a report. Returns the exit code: 0, 1 after violations, 128 + signal.
/// Throws InputError and RunError.
[[nodiscard]] int run_scene(const RunArguments& arguments);

}  // namespace ricochet::cli
