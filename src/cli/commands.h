/// \file
/// Commands of the program. Each function adds its command. The action sets exit_code and throws InputError and
/// RunError. A run or measurement interrupted by a signal sets it to kSignalled + signal (cli/interrupts.h).
#pragma once

#include "cli/command_line.h"

namespace ricochet {

/// `bench`: the cost of collisions, compared with plain Embree on the same segments.
void add_bench_command(cli::Command program, int& exit_code);

/// `check SCENE [--set PATH=VALUE ...]`: all errors of a scene, without running it.
void add_check_command(cli::Command program, int& exit_code);

/// `compare SCENE --output DIR`: one scene with several responses at several time steps, with the cost and errors of
/// each. docs/compare.md describes the output.
void add_compare_command(cli::Command program, int& exit_code);

/// `export DIR --format ply|pc2|gltf|csv --output PATH`: a run as files for other programs.
void add_export_command(cli::Command program, int& exit_code);

/// `info MESH [--json]`: contents and defects of a mesh file.
void add_info_command(cli::Command program, int& exit_code);

/// `new MESH --output SCENE.json [--template NAME]`: a scene fitted to a mesh.
void add_new_command(cli::Command program, int& exit_code);

/// `render DIR --output FILE.png|.mp4`: pictures and films of a run.
void add_render_command(cli::Command program, int& exit_code);

/// `run SCENE --output DIR`: simulates a scene and writes frames and a summary.
void add_run_command(cli::Command program, int& exit_code);

/// `schema [--markdown]`: the scene format for editors and for readers.
void add_schema_command(cli::Command program, int& exit_code);

/// `view DIR|SCENE [--output FILE.html]`: one file that shows a run in a browser. A scene is simulated first.
void add_view_command(cli::Command program, int& exit_code);

}  // namespace ricochet
