/// \file
/// What a run's frames hold, found out before a page is made of them: where, how many, which numbers in which ranges.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/io/run_folder.h"
#include "ricochet/io/vtk.h"
#include "view/render/color_map.h"

namespace ricochet {

/// A number of the particles that the page can colour by. Vectors are told by their length, velocity as `speed`.
struct PageAttribute {
    std::string array;      ///< in the frames
    std::string name;       ///< on the page
    double low = 0.0;       ///< least value that the page tells apart; lower ones are told as this
    double high = 0.0;      ///< the largest one; equal to low where all are the same
    ValueRange shown;       ///< of the colours, unless asked otherwise
    bool is_whole = false;  ///< whole numbers
    bool is_cut = false;    ///< some values lie outside low..high
    bool has_gaps = false;  ///< some values are not finite
};

struct RunSurvey {
    Box3 box;     ///< of the particles that are shown, m
    Vec3 origin;  ///< of the page's coordinates, m: small numbers keep their digits in 32 bits
    std::vector<PageAttribute> attributes;
    bool has_colors = false;            ///< particles have their own color
    bool has_springs = false;           ///< some frame has lines or triangles between particles
    std::vector<double> times;          ///< of the frames, s
    std::vector<std::uint64_t> counts;  ///< particles of the frames
    std::int64_t largest_id = 0;
    std::vector<std::int64_t> spring_ids;  ///< particles at the ends of springs, ascending
    std::vector<Vec3> sample;              ///< some of the particles over the run
    /// Where particles are copies of meshes, by the step of a frame: the vector part of each particle's turn, whose
    /// scalar part is not negative. Else empty.
    std::map<std::uint64_t, std::vector<std::array<float, 3>>> turns;

    /// Particles over all frames.
    [[nodiscard]] std::uint64_t total() const;
};

/// Reads every frame. colliders: the box of those at rest, so that particles near them are never too far away.
/// `progress` is called with the part that is done. Throws InputError for frames that do not belong together or whose
/// ids are not ascending.
[[nodiscard]] RunSurvey survey_run(const std::vector<FrameFile>& frames, const Box3& colliders,
                                   const std::function<void(double)>& progress);

/// The ids of a frame. Throws InputError, naming the file, where it has none or they are not ascending.
[[nodiscard]] const std::vector<std::int64_t>& frame_ids(const VtkPolyData& frame, const FrameFile& file);
/// The values of a frame for an attribute. Throws InputError where the frame lacks the array.
[[nodiscard]] std::vector<double> attribute_values(const VtkPolyData& frame, const PageAttribute& attribute,
                                                   const FrameFile& file);

}  // namespace ricochet
