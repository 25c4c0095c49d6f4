/// \file
/// Flows: the velocity of a medium as a function of position and time.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Velocity field. Implementations are pure: the same input gives the same bits in any thread.
class FlowField {
public:
    virtual ~FlowField() = default;
    /// Returns the velocity, in m/s, at a position, in m, and a time, in s.
    [[nodiscard]] virtual Vec3 velocity(const Vec3& position, double time) const = 0;
    /// Returns true if the velocity does not depend on time.
    [[nodiscard]] virtual bool is_steady() const = 0;
    /// Returns true if the velocity is the same everywhere.
    [[nodiscard]] virtual bool is_uniform() const { return false; }
};

/// Shared pointer to a flow, because several forces may use the same flow.
using FlowPointer = std::shared_ptr<const FlowField>;

/// Returns a flow with the same velocity everywhere, in m/s.
[[nodiscard]] FlowPointer make_wind(const Vec3& velocity);

/// Gusts of a wind. The wind's velocity is multiplied by 1 + amplitude sin(2 pi (frequency t + phase)).
struct Gust {
    double amplitude = 0.0;  ///< fraction of the wind's speed, >= 0; above 1 the wind reverses its direction at times
    double frequency = 1.0;  ///< in Hz, >= 0
    double phase = 0.0;      ///< in turns
};
[[nodiscard]] FlowPointer make_gusty_wind(const Vec3& velocity, const Gust& gust);

/// Speed profile of a vortex at the distance r from its axis, with circulation G and core radius a.
enum class VortexProfile {
    rankine,     ///< rigid rotation inside the core, G r / (2 pi a^2); G / (2 pi r) outside
    lamb_oseen,  ///< G / (2 pi r) (1 - exp(-r^2 / a^2))
};

/// Infinite straight vortex that turns about its axis by the right-hand rule. Source: P. G. Saffman, "Vortex Dynamics",
/// Cambridge 1992, section 13.1.
struct VortexSettings {
    Vec3 point;                ///< a point on the axis, in m
    Vec3 axis{0, 0, 1};        ///< direction of the axis, of any nonzero length
    double circulation = 0.0;  ///< in m^2/s; negative: clockwise
    double core_radius = 1.0;  ///< in m, > 0
    VortexProfile profile = VortexProfile::rankine;
};
[[nodiscard]] FlowPointer make_vortex(const VortexSettings& settings);

/// Returns a point source with the velocity Q / (4 pi) d / (|d|^2 + a^2)^(3/2), where d is the position minus the
/// centre. The core radius a is in m, > 0. The strength Q, in m^3/s, is the volume per second that flows out far from
/// the core. A sink has a negative strength.
[[nodiscard]] FlowPointer make_source(const Vec3& center, double strength, double core_radius);

/// Returns a rigid rotation about an axis through a point: the velocity is angular_velocity x (position - point).
/// angular_velocity is in rad/s.
[[nodiscard]] FlowPointer make_rotation(const Vec3& point, const Vec3& angular_velocity);

/// Returns a simple shear with the velocity rate * ((position - point) . g), where g is the unit vector along
/// `gradient`. rate: velocity change per metre along g, in 1/s. gradient: any nonzero length.
[[nodiscard]] FlowPointer make_shear(const Vec3& point, const Vec3& rate, const Vec3& gradient);

/// Returns the potential flow of an ideal fluid past a ball at rest. With the velocity U far away, in m/s, and the
/// ball's radius a, v = U (1 + a^3 / (2 r^3)) - 3 a^3 / (2 r^3) (U . n) n. r and n are the distance and direction from
/// the centre. The velocity is zero inside the ball. center in m; radius in m, > 0. Source: G. K. Batchelor, "An
/// Introduction to Fluid Dynamics", Cambridge 1967, section 6.8.
[[nodiscard]] FlowPointer make_flow_past_sphere(const Vec3& center, double radius, const Vec3& velocity);

/// Makes a flow from a callable of position and time that returns the velocity, in m/s. The callable must be pure.
/// is_steady: true if the callable does not depend on time.
[[nodiscard]] FlowPointer make_flow(std::function<Vec3(const Vec3&, double)> velocity, bool is_steady = false);

/// Returns the sum of flows, added in the given order. Throws InputError for a null pointer.
[[nodiscard]] FlowPointer make_flow_sum(std::vector<FlowPointer> parts);
/// Returns a flow multiplied by a number.
[[nodiscard]] FlowPointer make_scaled_flow(FlowPointer flow, double factor);

// A vector field sampled on a regular grid.

/// Vectors at the points of an axis-aligned grid. Point (i, j, k) is at origin + (i, j, k) * spacing. Its index is i +
/// counts[0] (j + counts[1] k).
struct VectorGrid {
    Vec3 origin;            ///< in m
    Vec3 spacing{1, 1, 1};  ///< in m, each > 0
    /// Number of points along each axis, >= 1; if 1, the field is constant along the axis.
    std::array<std::uint32_t, 3> counts{};
    std::vector<Vec3> values;  ///< one per point
};

/// Values of a grid at positions outside its box.
enum class OutsideGrid {
    clamp,  ///< the value at the nearest point of the grid's box
    zero,   ///< zero
};

/// Returns a steady flow by trilinear interpolation of the samples (m/s). Linear fields are interpolated exactly, up to
/// rounding. Throws InputError if the counts do not match the values, a spacing is not > 0, or a value is not finite.
[[nodiscard]] FlowPointer make_grid_flow(VectorGrid grid, OutsideGrid outside = OutsideGrid::clamp);

// Divergence-free turbulence: the curl of a noise.

/// Turbulence with eddies of several sizes. Octave k has eddies of size length / 2^k with gain^k times the speed of the
/// first octave. It changes (2 gain)^k times as fast, in proportion to the turnover rate of its eddies.
struct TurbulenceSettings {
    std::uint64_t seed = 0;
    double speed = 1.0;         ///< root mean square speed over space and seeds, in m/s, >= 0
    double length = 1.0;        ///< size of the largest eddies (spacing of the noise's lattice), in m, > 0
    std::uint32_t octaves = 3;  ///< 1 to kMostOctaves
    double gain = 0.5;          ///< speed ratio of successive octaves, > 0 and <= 1; Kolmogorov's spectrum has 0.79
    double rate = 0.0;          ///< rate at which the largest eddies are replaced, in 1/s; 0: the eddies never change
};
inline constexpr std::uint32_t kMostOctaves = 16;

/// Returns the analytic curl of three gradient noises. Its divergence is zero up to rounding. The pattern of an octave
/// repeats in space after 256 eddy sizes. Over time each octave blends from one noise to the next at a constant mean
/// speed. Method: R. Bridson, J. Hourihan, M. Nordenstam, "Curl-noise for procedural fluid flow", ACM TOG 26(3), 2007;
/// gradient noise: K. Perlin, "Improving noise", ACM TOG 21(3), 2002.
[[nodiscard]] FlowPointer make_turbulence(const TurbulenceSettings& settings);

}  // namespace ricochet
