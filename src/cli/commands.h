/// \file
/// Commands of the program. Each function adds one command. The command's action sets exit_code, and can throw
/// InputError or RunError. If a signal interrupts a run or a measurement, exit_code becomes kSignalled + signal
/// (cli/interrupts.h).
#pragma once

#include "cli/command_line.h"

namespace ricochet {

/// `bench`: measures the cost of collisions, compared with plain Embree on the same segments.
void add_bench_command(cli::Command program, int& exit_code);

/// `check SCENE [--set PATH=VALUE ...]`: prints all errors of a scene without running it.
void add_check_command(cli::Command program, int& exit_code);

/// `compare SCENE --output DIR`: runs one scene with several responses and time steps, and compares their costs and
/// errors. docs/compare.md describes the output.
void add_compare_command(cli::Command program, int& exit_code);

/// `export DIR --format ply|pc2|gltf|csv --output PATH`: writes a run as files for other programs.
void add_export_command(cli::Command program, int& exit_code);

/// `info MESH [--json]`: prints contents and defects of a mesh file.
void add_info_command(cli::Command program, int& exit_code);

/// `new MESH --output SCENE.json [--template NAME]`: writes a scene fitted to a mesh.
void add_new_command(cli::Command program, int& exit_code);

/// `render DIR --output FILE.png|.mp4`: makes pictures and films of a run.
void add_render_command(cli::Command program, int& exit_code);

/// `run SCENE --output DIR`: simulates a scene and writes frames and a summary.
void add_run_command(cli::Command program, int& exit_code);

/// `schema [--markdown]`: prints the scene format as JSON Schema for editors, or as Markdown for readers.
void add_schema_command(cli::Command program, int& exit_code);

/// `study FILE --output DIR`: runs one scene with many values of some keys. docs/studies.md describes it.
void add_study_command(cli::Command program, int& exit_code);

/// `view DIR|SCENE [--output FILE.html]`: writes one file that shows a run in a browser. A scene is simulated first.
void add_view_command(cli::Command program, int& exit_code);

}  // namespace ricochet
