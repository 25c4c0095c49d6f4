/// \file
/// Checkpoints: one file from which an interrupted run continues with bit-identical results.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ricochet/io/vtk.h"
#include "ricochet/simulation.h"
#include "run/counter_tables.h"
#include "run/load_tables.h"

namespace ricochet {

/// File with the particles of one process, stored beside the checkpoint that refers to it.
struct CheckpointPart {
    std::string file;            ///< file name, without a folder
    std::uint64_t checksum = 0;  ///< checksum of the whole file
};

[[nodiscard]] std::vector<std::string> names_of(const std::vector<CheckpointPart>& parts);

/// State of a run's output folder, stored together with the simulation's state.
struct Checkpoint {
    std::uint64_t scene = 0;              ///< SceneDescription::fingerprint
    double wall_seconds = 0.0;            ///< wall-clock time spent so far
    double output_seconds = 0.0;          ///< part of wall_seconds spent on output; see RunWriter::output_seconds()
    std::vector<PvdEntry> frames;         ///< particle frames written so far
    std::vector<PvdEntry> contacts;       ///< contact files written so far
    std::vector<PvdEntry> moving;         ///< files of moving colliders written so far
    LoadRows loads;                       ///< rows of the load tables
    std::vector<CheckpointPart> parts{};  ///< empty if the checkpoint itself contains the particles
    CounterRows counters{};               ///< rows of the table of counters
};

/// Writes the checkpoint and the simulation's state. An older checkpoint stays until the new file is complete. Throws
/// RunError if writing fails.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, const Simulation& simulation);

/// Writes the particles of this process and returns the file's checksum. Throws like write_checkpoint().
[[nodiscard]] std::uint64_t write_checkpoint_part(const std::filesystem::path& file, const Simulation& simulation);

/// Restores the state of the checkpoint into a simulation that has not made a step.
/// scene: fingerprint of the scene that the simulation was built from.
/// The parts are in the checkpoint's folder. Any number of processes may read them, because each process reads all
/// parts and keeps only its own particles.
/// Throws InputError if the file is missing or damaged, or if another version or another scene wrote it. The message
/// names the file and a remedy. Throws RunError if the operating system refuses to read the file.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& file, std::uint64_t scene,
                                         Simulation& simulation);

}  // namespace ricochet
