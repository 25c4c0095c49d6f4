#include "ricochet/geometry/mesh/stretched_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/error.h"
#include "ricochet/core/keyed_curve.h"
#include "ricochet/core/memory_limit.h"

namespace ricochet {
namespace {

/// Fraction of an interval between keys that is left out at both ends when its bounds are computed. The bounds then
/// exclude the neighbouring intervals. Local: the bounds of the rest are valid for the whole interval.
constexpr double kInside = 1e-9;

[[noreturn]] void refuse(const std::string& what) { throw InputError("scale that changes in time: " + what); }

/// Returns the factor curves of a frame and its ancestors.
std::vector<const KeyedCurve<Vec3>*> factors_of(const FrameTree& frames, std::size_t frame) {
    std::vector<const KeyedCurve<Vec3>*> all;
    for (std::optional<std::size_t> k = frame; k; k = frames.find(frames.description(*k).parent)) {
        const FrameDescription& link = frames.description(*k);
        if (link.is_driven) {
            refuse("the frame '" + link.name +
                   "' is a body, which impulses move, expected a frame with motions of its own");
        }
        for (const FrameMotion& motion : link.motions) {
            if (const auto* scale = std::get_if<KeyedScale>(&motion)) all.push_back(&scale->factors);
        }
    }
    return all;
}

/// Throws InputError if a factor is not above 0, because curves can go below their keys.
void require_size(const std::vector<const KeyedCurve<Vec3>*>& all, double time) {
    for (const KeyedCurve<Vec3>* factors : all) {
        const Vec3 factor = factors->value(time);
        for (int axis = 0; axis < 3; ++axis) {
            if (factor[axis] > 0.0) continue;
            refuse("found the factor " + std::to_string(factor[axis]) + " at " + std::to_string(time) +
                   " s, expected one above 0 at all times");
        }
    }
}

/// Returns the keys, in s, of the motion of a mesh.
std::vector<double> key_times(std::span<const Vec3> vertices, const FrameTree& frames, std::size_t frame, double begin,
                              double end) {
    Box3 box;
    double farthest = 0.0;  // in m, from the frame's origin
    for (const Vec3& v : vertices) {
        box.include(v);
        farthest = std::max(farthest, length(v));
    }
    const double tolerance = kStretchDeviation * box.diagonal();
    // Returns the number of intervals into which the time between two keys of the frames is divided.
    const auto pieces_between = [&](double from, double to) {
        const double inside = kInside * (to - from);
        const MotionBounds bounds = frames.bounds(frame, from + inside, to - inside);
        const double second = bounds.origin[2] + farthest * bounds.rotation[2];
        if (!(second > 0.0)) return 1.0;
        return std::max(1.0, std::ceil((to - from) * std::sqrt(second / (8.0 * tolerance))));
    };
    std::vector<double> times{begin};
    double keys = 1.0;
    for (double from = begin; from < end;) {
        const double to = std::min(end, frames.next_key(frame, from));
        const double pieces = pieces_between(from, to);
        keys += pieces;
        require_memory(keys * static_cast<double>(vertices.size() * sizeof(Vec3)), "scale that changes in time");
        for (double k = 1.0; k < pieces; ++k) times.push_back(from + (to - from) * (k / pieces));
        times.push_back(to);
        from = to;
    }
    return times;
}

}  // namespace

MeshMotion stretched_motion(std::span<const Vec3> vertices, const FrameTree& frames, std::size_t frame, double begin,
                            double end) {
    if (!(begin < end)) refuse("it ends before it begins, expected a later end");
    const std::vector<const KeyedCurve<Vec3>*> factors = factors_of(frames, frame);
    const auto positions_at = [&](double time) {
        require_size(factors, time);
        const AffineMap map = frames.map(frame, time);
        std::vector<Vec3> positions(vertices.begin(), vertices.end());
        for (Vec3& p : positions) p = map.point(p);
        return positions;
    };
    return sampled_motion(positions_at, key_times(vertices, frames, frame, begin, end));
}

}  // namespace ricochet
