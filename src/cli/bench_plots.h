// Pictures of the benchmark's numbers.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "bench/load.h"
#include "bench/measurement.h"

namespace ricochet::cli {

/// A gnuplot script, with the numbers in it, that draws SUITE.png in the folder it is run in: for `size` the cost over
/// the number of triangles, for `count` rates over the number of particles, for `threads` the speedup, for `radius` and
/// `response` the costs side by side, for the others the ratios. Of the other suites' rows those with the most threads
/// are drawn. At least one row.
[[nodiscard]] std::string plot_script(std::string_view suite, std::span<const bench::Row> rows);

/// The same for files: how fast they are read and built.
[[nodiscard]] std::string plot_script(std::span<const bench::LoadRow> rows);

}  // namespace ricochet::cli
