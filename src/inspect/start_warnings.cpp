#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "inspect/scene_warnings.h"
#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Smallest plausible radius, in units in the last place of the coordinates. For comparison, the contact offset is 16
/// such units. Local, because it decides only about a warning.
constexpr double kLeastRadiusUlps = 1e3;

/// Largest plausible distance between start positions and colliders, in diagonals of the colliders' box. Even a
/// landscape with rain on a single house stays far below this limit. Local, because it decides only about a warning.
constexpr double kFarStarts = 100.0;

/// Largest distance, in m, of a point from a box along a coordinate axis, and this axis.
struct Beyond {
    int axis = 0;
    double distance = 0.0;
};

Beyond beyond(const Box3& box, const Vec3& p) {
    Beyond farthest;
    for (int axis = 0; axis < 3; ++axis) {
        const double distance = std::max(box.lower[axis] - p[axis], p[axis] - box.upper[axis]);
        if (distance > farthest.distance) farthest = {axis, distance};
    }
    return farthest;
}

/// Counts the start positions outside the bounds and finds the farthest one.
class OutsideStarts {
public:
    explicit OutsideStarts(const Box3& bounds) : bounds_(bounds) {}

    void add(const Particle& particle) {
        ++all_;
        if (bounds_.contains(particle.position)) return;
        ++outside_;
        const Beyond by = beyond(bounds_, particle.position);
        if (by.distance > farthest_.distance) farthest_ = by;
    }

    /// Returns the warning text, or nothing if all start positions are inside.
    [[nodiscard]] std::optional<std::string> warning(const std::string& where) const {
        if (outside_ == 0) return std::nullopt;
        return fmt::format(
            "{}: {} of {} positions that were tried lie outside `bounds`, the farthest by {:.3g} m along {}: particles "
            "outside are removed at the end of a step; make `bounds` larger or move the emitter inside",
            where, outside_, all_, farthest_.distance, "xyz"[farthest_.axis]);
    }

private:
    const Box3& bounds_;
    std::size_t all_ = 0;
    std::size_t outside_ = 0;
    Beyond farthest_;
};

/// Returns true if the emitter's shape is certainly inside the box. Returns false for shapes in a reference frame,
/// which must be sampled instead.
bool is_surely_inside(const EmitterDescription& emitter, const Box3& box) {
    if (emitter.frames) return false;
    const Box3 shape = bounds(emitter.shape);
    return box.contains(shape.lower) && box.contains(shape.upper);
}

}  // namespace

std::string name_in_list(std::string_view list, std::size_t index, const std::string& name) {
    const std::string path = fmt::format("{}[{}]", list, index);
    return name.empty() ? path : fmt::format("{} '{}'", path, name);
}

std::vector<Particle> drawn_starts(const EmitterDescription& emitter, std::size_t index, std::size_t count) {
    std::vector<Particle> starts(count);
    const ShapeSampler sampler(emitter.shape);
    const Quantile radius = quantile_of(emitter.radius);
    RandomSequence random(0, 0, index);
    for (Particle& particle : starts) {
        particle.radius = radius(random.uniform());
        particle.position = sampler.draw(particle.radius, random).position;
        particle.birth_time = emitter.start;
        if (emitter.frames) particle = launched_from(*emitter.frames, emitter.frame, particle);
    }
    return starts;
}

std::optional<std::string> small_radius_warning(const std::string& where, std::span<const Particle> starts) {
    for (const Particle& particle : starts) {
        const double largest = max_abs(particle.position);
        if (!(particle.radius > 0.0) || !std::isfinite(largest)) continue;
        if (particle.radius >= kLeastRadiusUlps * ulp(largest)) continue;
        return fmt::format(
            "{}: a radius of {:.3g} m at coordinates of {:.3g} m is less than {:g} units in their last "
            "place: move the scene to the origin, or use points",
            where, particle.radius, largest, kLeastRadiusUlps);
    }
    return std::nullopt;
}

std::optional<std::string> far_starts_warning(const std::string& where, std::span<const Particle> starts,
                                              const Box3& surfaces, double path) {
    if (!(surfaces.diagonal() > 0.0)) return std::nullopt;
    double farthest = 0.0;
    for (const Particle& particle : starts) {
        if (is_finite(particle.position)) farthest = std::max(farthest, beyond(surfaces, particle.position).distance);
    }
    if (farthest <= kFarStarts * surfaces.diagonal() || farthest <= path) return std::nullopt;
    return fmt::format(
        "{}: particles begin up to {:.3g} m away from the colliders, which measure {:.3g} m together: lengths are in "
        "metres; "
        "scale the mesh or the emitter if one of them is in another unit",
        where, farthest, surfaces.diagonal());
}

std::vector<std::string> bounds_warnings(const SimulationSetup& setup) {
    std::vector<std::string> lines;
    if (!setup.bounds) return lines;
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        const EmitterDescription& emitter = setup.emitters[k];
        if (emitter.parent || is_surely_inside(emitter, *setup.bounds)) continue;
        OutsideStarts drawn(*setup.bounds);
        for (const Particle& particle : drawn_starts(emitter, k, kDrawnStarts)) drawn.add(particle);
        auto line = drawn.warning(name_in_list("emitters", k, emitter.name));
        if (line) lines.push_back(std::move(*line));
    }
    return lines;
}

}  // namespace ricochet
