/// \file
/// The commands of the program. Each function adds its command, whose action sets exit_code and throws InputError and
/// RunError; runs and measurements that a signal interrupts set it to kSignalled + signal (cli/interrupts.h).
#pragma once

#include "cli/command_line.h"

namespace ricochet {

/// `bench`: what collisions cost, beside what Embree does by itself on the same segments.
void add_bench_command(cli::Command program, int& exit_code);

/// `check SCENE [--set PATH=VALUE ...]`: all that is wrong with a scene, without running it.
void add_check_command(cli::Command program, int& exit_code);

/// `compare SCENE --output DIR`: one scene with several responses at several time steps, what each costs and gets
/// wrong. docs/compare.md describes what it writes.
void add_compare_command(cli::Command program, int& exit_code);

/// `export DIR --format ply|pc2|gltf --output PATH`: a run as files for other programs.
void add_export_command(cli::Command program, int& exit_code);

/// `info MESH [--json]`: what a mesh file holds and what its defects mean.
void add_info_command(cli::Command program, int& exit_code);

/// `new MESH --output SCENE.json [--template NAME]`: a scene fitted to a mesh.
void add_new_command(cli::Command program, int& exit_code);

/// `render DIR --output FILE.png|.mp4`: pictures and films of a run.
void add_render_command(cli::Command program, int& exit_code);

/// `run SCENE --output DIR`: simulates a scene and writes frames and a summary.
void add_run_command(cli::Command program, int& exit_code);

/// `schema [--markdown]`: the scene format for editors and for people.
void add_schema_command(cli::Command program, int& exit_code);

/// `view DIR|SCENE [--output FILE.html]`: one file that shows a run in a browser; runs a scene first.
void add_view_command(cli::Command program, int& exit_code);

}  // namespace ricochet
