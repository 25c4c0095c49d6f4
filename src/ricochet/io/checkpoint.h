/// \file
/// Checkpoints: an interrupted run as one file, from which it goes on to the same bits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ricochet/io/load_tables.h"
#include "ricochet/io/vtk.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// A file with the particles that one of several processes had, beside the checkpoint that names it.
struct CheckpointPart {
    std::string file;            ///< its name
    std::uint64_t checksum = 0;  ///< of the whole file
};

[[nodiscard]] std::vector<std::string> names_of(const std::vector<CheckpointPart>& parts);

/// What a run's folder holds besides the simulation's state.
struct Checkpoint {
    std::uint64_t scene = 0;              ///< SceneDescription::fingerprint
    double wall_seconds = 0.0;            ///< spent so far
    double output_seconds = 0.0;          ///< of it on output, see RunWriter::output_seconds()
    std::vector<PvdEntry> frames;         ///< written so far
    std::vector<PvdEntry> contacts;       ///< the same of the contact log
    std::vector<PvdEntry> moving;         ///< and of the colliders that move
    LoadRows loads;                       ///< of the tables
    std::vector<CheckpointPart> parts{};  ///< empty: the state has the particles itself
};

/// Writes state and checkpoint; an older file stays until the new one is complete. Throws RunError when the disk does
/// not take it.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, const Simulation& simulation);

/// Writes the particles that the simulation has here; returns the file's checksum. Throws like write_checkpoint().
[[nodiscard]] std::uint64_t write_checkpoint_part(const std::filesystem::path& file, const Simulation& simulation);

/// Puts a simulation, which has not made a step yet, where the checkpoint was made. scene: the fingerprint of the scene
/// that it was made from. Parts are read from the folder of the file, one after the other, by any number of processes,
/// each of which keeps what is to live there. Throws InputError, naming the file and what to do, when there is no such
/// file, when it is damaged, of another version, or of another scene; RunError when the system does not let it be read.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& file, std::uint64_t scene,
                                         Simulation& simulation);

}  // namespace ricochet
