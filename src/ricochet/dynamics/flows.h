/// \file
/// Flows: the velocity of a medium as a function of position and time, for drags, field forces and first-order motion.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A velocity field. Implementations are pure: same input, same bits, from any thread.
class FlowField {
public:
    virtual ~FlowField() = default;
    /// Velocity at a position (m) and time (s), m/s.
    [[nodiscard]] virtual Vec3 velocity(const Vec3& position, double time) const = 0;
    /// True when the velocity does not depend on time.
    [[nodiscard]] virtual bool is_steady() const = 0;
    /// True when the velocity is the same everywhere.
    [[nodiscard]] virtual bool is_uniform() const { return false; }
};

/// Flows are shared: several forces may lean on one.
using FlowPointer = std::shared_ptr<const FlowField>;

/// The same velocity everywhere, m/s.
[[nodiscard]] FlowPointer make_wind(const Vec3& velocity);

/// Rise and fall of a wind: its velocity times 1 + amplitude sin(2 pi (frequency t + phase)).
struct Gust {
    double amplitude = 0.0;  ///< part of the wind's speed, >= 0; above 1 the wind turns round at times
    double frequency = 1.0;  ///< Hz, >= 0
    double phase = 0.0;      ///< turns
};
[[nodiscard]] FlowPointer make_gusty_wind(const Vec3& velocity, const Gust& gust);

/// How a vortex turns about its axis at the distance r, with circulation G and core radius a.
enum class VortexProfile {
    rankine,     ///< like a rigid body inside the core, G r / (2 pi a^2); G / (2 pi r) outside
    lamb_oseen,  ///< G / (2 pi r) (1 - exp(-r^2 / a^2))
};

/// A straight vortex without end, turning by the right-hand rule about its direction.
/// Source: P. G. Saffman, "Vortex Dynamics", Cambridge 1992, section 13.1.
struct VortexSettings {
    Vec3 point;                ///< m, on the axis
    Vec3 axis{0, 0, 1};        ///< of any length but zero
    double circulation = 0.0;  ///< m^2/s; negative: clockwise
    double core_radius = 1.0;  ///< m, > 0
    VortexProfile profile = VortexProfile::rankine;
};
[[nodiscard]] FlowPointer make_vortex(const VortexSettings& settings);

/// A point source Q / (4 pi) d / (|d|^2 + a^2)^(3/2) with d from the centre: the strength Q in m^3/s is the volume that
/// leaves in a second far outside the core radius a (m, > 0); negative for a sink.
[[nodiscard]] FlowPointer make_source(const Vec3& center, double strength, double core_radius);

/// Rigid rotation about an axis through a point: angular velocity (rad/s) x (position - point).
[[nodiscard]] FlowPointer make_rotation(const Vec3& point, const Vec3& angular_velocity);

/// Simple shear: velocity * ((position - point) . gradient) with the velocity in m/s gained per metre along the unit
/// vector of `gradient` (of any length but zero): `rate` in 1/s.
[[nodiscard]] FlowPointer make_shear(const Vec3& point, const Vec3& rate, const Vec3& gradient);

/// Potential flow of an ideal fluid past a ball at rest, with the given velocity far away (m/s); zero inside the ball.
/// v = U (1 + a^3 / (2 r^3)) - 3 a^3 / (2 r^3) (U . n) n. Source: G. K. Batchelor, "An Introduction to Fluid Dynamics",
/// Cambridge 1967, section 6.8. center in m; radius in m, > 0.
[[nodiscard]] FlowPointer make_flow_past_sphere(const Vec3& center, double radius, const Vec3& velocity);

/// Any callable of position and time, m/s. It must be pure. is_steady: it does not depend on time.
[[nodiscard]] FlowPointer make_flow(std::function<Vec3(const Vec3&, double)> velocity, bool is_steady = false);

/// A sum of flows, added in the order given; none may be a null pointer.
[[nodiscard]] FlowPointer make_flow_sum(std::vector<FlowPointer> parts);
/// A flow times a number.
[[nodiscard]] FlowPointer make_scaled_flow(FlowPointer flow, double factor);

// A vector field sampled on a regular grid.

/// Vectors at the points of a grid along the axes. Point (i, j, k) stands at origin + (i, j, k) * spacing and has the
/// number i + counts[0] (j + counts[1] k).
struct VectorGrid {
    Vec3 origin;                            ///< m
    Vec3 spacing{1, 1, 1};                  ///< m, each > 0
    std::array<std::uint32_t, 3> counts{};  ///< points along each axis, >= 1; 1: the same all along that axis
    std::vector<Vec3> values;               ///< one a point
};

/// What a grid says about positions beyond its points.
enum class OutsideGrid {
    clamp,  ///< the value at the nearest point of the grid's box
    zero,   ///< nothing
};

/// Trilinear interpolation of the samples (m/s); linear fields come out exactly but for rounding. Steady.
/// Throws InputError when the counts do not fit the values, a spacing is not > 0, or a value is not finite.
[[nodiscard]] FlowPointer make_grid_flow(VectorGrid grid, OutsideGrid outside = OutsideGrid::clamp);

// Turbulence without divergence: the curl of a noise.

/// Eddies of several sizes. Octave k has eddies of size length / 2^k, speeds times gain^k, and changes (2 gain)^k times
/// as fast as the first, as eddies that turn over do.
struct TurbulenceSettings {
    std::uint64_t seed = 0;
    double speed = 1.0;         ///< m/s, root mean square over space and seeds, >= 0
    double length = 1.0;        ///< m, size of the largest eddies (distance of the noise's lattice points), > 0
    std::uint32_t octaves = 3;  ///< 1 to kMostOctaves
    double gain = 0.5;          ///< speed of an octave over that of the one before, > 0 and <= 1; 0.79: Kolmogorov's
    double rate = 0.0;          ///< 1/s: how often the largest eddies are replaced by new ones; 0: frozen
};
inline constexpr std::uint32_t kMostOctaves = 16;

/// The curl of three gradient noises, taken analytically: its divergence is zero but for rounding. An eddy pattern
/// repeats after 256 lengths of its octave. In time it goes from one noise to the next with weights whose squares add
/// up to 1, so that the mean speed stays.
/// Method: R. Bridson, J. Hourihan, M. Nordenstam, "Curl-noise for procedural fluid flow", ACM TOG 26(3), 2007;
/// gradient noise: K. Perlin, "Improving noise", ACM TOG 21(3), 2002.
[[nodiscard]] FlowPointer make_turbulence(const TurbulenceSettings& settings);

}  // namespace ricochet
