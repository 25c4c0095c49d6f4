/// \file
/// A run as a single file that a browser shows without a server or a network.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "run/run_folder.h"
#include "view/page/page_shapes.h"
#include "view/render/color_map.h"

namespace ricochet {

struct PageOptions {
    double budget = 30e6;  ///< size limit of the file, in bytes
    std::string color_by;  ///< attribute that initially colours the particles; empty: the particles' own colours, or
                           ///< their speed if they have none
    ColorMap map = ColorMap::plasma;
    std::string version;                                   ///< version of the program
    PageShapes shapes = {};                                ///< meshes of the particles; empty: particles are spheres
    std::function<void(double)> progress = [](double) {};  ///< receives the finished share of the work, from any thread
};

/// Result of writing a page.
struct PageReport {
    std::uint64_t bytes = 0;
    std::size_t frames = 0;          ///< number of frames on the page
    std::vector<std::string> notes;  ///< data left out to fit the budget, and other differences from the run
};

/// Writes the page of a run. Throws InputError for invalid folders and names and for a budget that is too small. Throws
/// RunError if the disk rejects the file. If an error occurs, an existing file is kept.
PageReport write_run_page(const RunFolder& folder, const std::filesystem::path& target, const PageOptions& options);

}  // namespace ricochet
