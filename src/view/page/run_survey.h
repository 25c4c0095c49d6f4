/// \file
/// Survey of a run's frames before its page is made: extent, counts and ranges of attributes.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/io/vtk.h"
#include "run/run_folder.h"
#include "view/render/color_map.h"

namespace ricochet {

/// A numeric attribute of the particles that the page can use for colours. Vectors are replaced by their length. The
/// velocity is named `speed`.
struct PageAttribute {
    std::string array;      ///< name of the array in the frames
    std::string name;       ///< name on the page
    double low = 0.0;       ///< least stored value; lower values are clamped to this value
    double high = 0.0;      ///< largest stored value; equal to `low` if all values are equal
    ValueRange shown;       ///< default range of the colour scale
    bool is_whole = false;  ///< all values are integers
    bool is_cut = false;    ///< some values are outside low..high
    bool has_gaps = false;  ///< some values are not finite
};

struct RunSurvey {
    Box3 box;     ///< bounding box of the shown particles, in m
    Vec3 origin;  ///< origin of the page's coordinates, in m; near the particles, so that 32-bit coordinates have small
                  ///< rounding errors
    std::vector<PageAttribute> attributes;
    bool has_colors = false;            ///< particles have their own colours
    bool has_springs = false;           ///< some frames have lines or triangles between particles
    std::vector<double> times;          ///< times of the frames, in s
    std::vector<std::uint64_t> counts;  ///< number of particles per frame
    std::int64_t largest_id = 0;
    std::vector<std::int64_t> spring_ids;  ///< ids of the particles with springs, ascending
    std::vector<Vec3> sample;              ///< positions of some particles in some frames
    /// Rotations of the particles by step, or empty if particles are spheres. Each entry is the vector part of a unit
    /// quaternion with a non-negative scalar part.
    std::map<std::uint64_t, std::vector<std::array<float, 3>>> turns;

    /// Returns the number of particles, summed over all frames.
    [[nodiscard]] std::uint64_t total() const;
};

/// Reads every frame. `colliders` is the bounding box of the colliders; particles near this box are never left out as
/// too far away. `progress` receives the finished share. Throws InputError if frames have different arrays or ids are
/// not ascending.
[[nodiscard]] RunSurvey survey_run(const std::vector<FrameFile>& frames, const Box3& colliders,
                                   const std::function<void(double)>& progress);

/// Returns the ids of a frame. Throws InputError with the file name if there are none or they are not ascending.
[[nodiscard]] const std::vector<std::int64_t>& frame_ids(const VtkPolyData& frame, const FrameFile& file);
/// Returns the values of an attribute in a frame. Throws InputError if the frame lacks the array.
[[nodiscard]] std::vector<double> attribute_values(const VtkPolyData& frame, const PageAttribute& attribute,
                                                   const FrameFile& file);

}  // namespace ricochet
