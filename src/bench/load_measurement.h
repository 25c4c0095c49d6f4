/// \file
/// Measures how long it takes from a mesh file to a world that particles can collide with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/load_cases.h"
#include "bench/measurement.h"

namespace ricochet::bench {

/// A file with a number of threads, measured. Times are the median of the repeats.
struct LoadRow {
    std::string name;
    std::string format;
    std::size_t triangles = 0;
    int threads = 0;  ///< of the build; reading takes one
    std::uint64_t file_bytes = 0;
    double read_seconds = 0.0;   ///< from the file to the checked index list
    double build_seconds = 0.0;  ///< from there to the collision world as a simulation has it
};

/// Writes the case's file into a folder of its own that goes away again, and times reading and building, separately.
/// The file has just been written, so that the system has it in memory. Nothing when the hook has ended it. Throws
/// RunError when the file cannot be written or does not bring back as many triangles.
[[nodiscard]] std::optional<std::vector<LoadRow>> measure_load(const LoadCase& c, const MeasurementPlan& plan,
                                                               const Hook& hook = {});

}  // namespace ricochet::bench
