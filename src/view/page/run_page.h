/// \file
/// A run as one file that a browser shows, without a server and without a network.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ricochet/io/run_folder.h"
#include "view/page/page_shapes.h"
#include "view/render/color_map.h"

namespace ricochet {

struct PageOptions {
    double budget = 30e6;  ///< bytes of the file
    std::string color_by;  ///< attribute that colours the particles at first; empty: their own colours, or speed
    ColorMap map = ColorMap::plasma;
    std::string version;                                   ///< of the program
    PageShapes shapes = {};                                ///< none: particles are spheres
    std::function<void(double)> progress = [](double) {};  ///< told the part that is done, from any thread
};

/// What a page came to be.
struct PageReport {
    std::uint64_t bytes = 0;
    std::size_t frames = 0;          ///< on the page
    std::vector<std::string> notes;  ///< what was left out to fit the budget, and what else is not as in the run
};

/// Writes the page of a run. Throws InputError for folders and names that are not what they should be and for a budget
/// that is too small, RunError when the disk does not take it; an older file stays then.
PageReport write_run_page(const RunFolder& folder, const std::filesystem::path& target, const PageOptions& options);

}  // namespace ricochet
