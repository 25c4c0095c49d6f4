/// \file
/// Flows: velocity of a medium as a function of position and time, for drags, field forces and first-order motion.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Velocity field. Implementations are pure: the same input gives the same bits from any thread.
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

/// Shared flow: several forces may use one.
using FlowPointer = std::shared_ptr<const FlowField>;

/// Returns a flow with the same velocity everywhere, in m/s.
[[nodiscard]] FlowPointer make_wind(const Vec3& velocity);

/// Gusts of a wind: its velocity is multiplied by 1 + amplitude sin(2 pi (frequency t + phase)).
struct Gust {
    double amplitude = 0.0;  ///< fraction of the wind's speed, >= 0; above 1 the wind reverses at times
    double frequency = 1.0;  ///< in Hz, >= 0
    double phase = 0.0;      ///< in turns
};
[[nodiscard]] FlowPointer make_gusty_wind(const Vec3& velocity, const Gust& gust);

/// Speed profile of a vortex at the distance r from its axis, with circulation G and core radius a.
enum class VortexProfile {
    rankine,     ///< rigid rotation inside the core, G r / (2 pi a^2); G / (2 pi r) outside
    lamb_oseen,  ///< G / (2 pi r) (1 - exp(-r^2 / a^2))
};

/// Infinite straight vortex that turns by the right-hand rule about its direction.
/// Source: P. G. Saffman, "Vortex Dynamics", Cambridge 1992, section 13.1.
struct VortexSettings {
    Vec3 point;                ///< in m, on the axis
    Vec3 axis{0, 0, 1};        ///< any nonzero length
    double circulation = 0.0;  ///< in m^2/s; negative: clockwise
    double core_radius = 1.0;  ///< in m, > 0
    VortexProfile profile = VortexProfile::rankine;
};
[[nodiscard]] FlowPointer make_vortex(const VortexSettings& settings);

/// Returns a point source Q / (4 pi) d / (|d|^2 + a^2)^(3/2) with d from the centre. The strength Q, in m^3/s, is the
/// volume that leaves per second far outside the core radius a (in m, > 0); a sink has a negative strength.
[[nodiscard]] FlowPointer make_source(const Vec3& center, double strength, double core_radius);

/// Returns a rigid rotation about an axis through a point: angular velocity (rad/s) x (position - point).
[[nodiscard]] FlowPointer make_rotation(const Vec3& point, const Vec3& angular_velocity);

/// Returns a simple shear: rate * ((position - point) . g), with g the unit vector of `gradient`. `rate` is the
/// velocity gained per metre along g, in 1/s. `gradient` may have any nonzero length.
[[nodiscard]] FlowPointer make_shear(const Vec3& point, const Vec3& rate, const Vec3& gradient);

/// Returns the potential flow of an ideal fluid past a ball at rest, with the given velocity far away (m/s). It is zero
/// inside the ball. v = U (1 + a^3 / (2 r^3)) - 3 a^3 / (2 r^3) (U . n) n. center in m; radius in m, > 0.
/// Source: G. K. Batchelor, "An Introduction to Fluid Dynamics", Cambridge 1967, section 6.8.
[[nodiscard]] FlowPointer make_flow_past_sphere(const Vec3& center, double radius, const Vec3& velocity);

/// Makes a flow from a pure callable of position and time that returns m/s. is_steady: the callable does not depend on
/// time.
[[nodiscard]] FlowPointer make_flow(std::function<Vec3(const Vec3&, double)> velocity, bool is_steady = false);

/// Returns a sum of flows, added in the given order. None may be a null pointer.
[[nodiscard]] FlowPointer make_flow_sum(std::vector<FlowPointer> parts);
/// Returns a flow multiplied by a number.
[[nodiscard]] FlowPointer make_scaled_flow(FlowPointer flow, double factor);

// A vector field sampled on a regular grid.

/// Vectors at the points of an axis-aligned grid. Point (i, j, k) is at origin + (i, j, k) * spacing and has the index
/// i + counts[0] (j + counts[1] k).
struct VectorGrid {
    Vec3 origin;            ///< in m
    Vec3 spacing{1, 1, 1};  ///< in m, each > 0
    std::array<std::uint32_t, 3>
        counts{};              ///< points along each axis, >= 1; with 1 the field is constant along the axis
    std::vector<Vec3> values;  ///< one per point
};

/// Values of a grid at positions outside its box.
enum class OutsideGrid {
    clamp,  ///< the value at the nearest point of the grid's box
    zero,   ///< zero
};

/// Returns a steady flow by trilinear interpolation of the samples (m/s). Linear fields are exact up to rounding.
/// Throws InputError if the counts do not match the values, a spacing is not > 0, or a value is not finite.
[[nodiscard]] FlowPointer make_grid_flow(VectorGrid grid, OutsideGrid outside = OutsideGrid::clamp);

// Divergence-free turbulence: the curl of a noise.

/// Eddies of several sizes. Octave k has eddies of size length / 2^k and speeds times gain^k. It changes (2 gain)^k
/// times as fast as the first octave, like eddies that turn over.
struct TurbulenceSettings {
    std::uint64_t seed = 0;
    double speed = 1.0;         ///< in m/s, root mean square over space and seeds, >= 0
    double length = 1.0;        ///< size of the largest eddies (spacing of the noise's lattice), in m, > 0
    std::uint32_t octaves = 3;  ///< 1 to kMostOctaves
    double gain = 0.5;          ///< speed ratio of successive octaves, > 0 and <= 1; 0.79 is Kolmogorov's
    double rate = 0.0;          ///< replacements of the largest eddies per second, in 1/s; 0: frozen
};
inline constexpr std::uint32_t kMostOctaves = 16;

/// Returns the analytic curl of three gradient noises; its divergence is zero up to rounding. An eddy pattern repeats
/// after 256 lengths of its octave. Over time it blends from one noise to the next. The squares of the weights add up
/// to 1, so the mean speed stays constant.
/// Method: R. Bridson, J. Hourihan, M. Nordenstam, "Curl-noise for procedural fluid flow", ACM TOG 26(3), 2007;
/// gradient noise: K. Perlin, "Improving noise", ACM TOG 21(3), 2002.
[[nodiscard]] FlowPointer make_turbulence(const TurbulenceSettings& settings);

}  // namespace ricochet
