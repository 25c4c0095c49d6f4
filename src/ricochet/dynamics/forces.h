/// \file
/// Forces as composable objects: what one is, sums of them, any callable, and the laws that scenes name.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/particles.h"

namespace ricochet {

class Coupling;

/// What a force may depend on: one particle's own state at a time.
struct ForceInput {
    Vec3 position;  ///< m
    Vec3 velocity;  ///< m/s
    double mass;    ///< kg
    double radius;  ///< m
    double time;    ///< s
    /// Which particle it is, for forces that act on some only.
    std::uint64_t id = 0;
    /// What other particles do to it, from a bounce to the end of the step; null where nothing couples.
    const Coupling* coupling = nullptr;
    /// m: of a sphere that collides as a part of itself, whose radius then stands in `radius`; 0 otherwise. ForceField
    /// shows forces the whole.
    double whole_radius = 0.0;
    /// K: the particle's attribute `temperature`, as it is at the begin of the step; 0 where there is none.
    double temperature = 0.0;
};

/// What other particles do to one that has left the plan of a step by a bounce. Pure like a force.
class Coupling {
public:
    virtual ~Coupling() = default;
    /// Force divided by mass, m/s^2.
    [[nodiscard]] virtual Vec3 acceleration(const ForceInput& input) const = 0;
    /// True when it depends on position, velocity or time.
    [[nodiscard]] virtual bool varies() const = 0;
    /// True when it stands for all forces, which are not added.
    [[nodiscard]] virtual bool replaces_forces() const { return false; }
};

/// One force on particles. Implementations are pure: same input, same bits, from any thread. An acceleration that is
/// not finite ends the step with a RunError that names the force and the particle.
class Force {
public:
    virtual ~Force() = default;
    /// Force divided by mass, m/s^2.
    [[nodiscard]] virtual Vec3 acceleration(const ForceInput& input) const = 0;
    /// Potential energy of the particle in this force, J. Dissipative forces store none and return 0; a force without a
    /// potential returns nothing.
    [[nodiscard]] virtual std::optional<double> potential_energy(const ForceInput& input) const = 0;
    /// True when the acceleration depends on neither position, velocity nor time.
    [[nodiscard]] virtual bool is_uniform() const { return false; }
    /// The acceleration where it is the same for all particles, everywhere and always, m/s^2.
    [[nodiscard]] virtual std::optional<Vec3> common_acceleration() const { return std::nullopt; }
    /// True when the acceleration does not depend on time: a particle at rest then stays at rest (it may sleep).
    [[nodiscard]] virtual bool is_steady() const { return is_uniform(); }
    /// True when all its work is what its potential energy falls by: lasting contact keeps the sum then.
    [[nodiscard]] virtual bool is_conservative() const { return false; }
    /// True when it asks for ForceInput::temperature.
    [[nodiscard]] virtual bool needs_temperature() const { return false; }
};

/// Uniform gravity: the given acceleration, m/s^2.
[[nodiscard]] std::unique_ptr<Force> make_gravity(const Vec3& acceleration);

/// What is known of a callable force. Pure like the force itself.
struct CallableTraits {
    std::function<double(const ForceInput&)> potential = {};  ///< J; empty: it has none
    bool is_uniform = false;       ///< its acceleration depends on neither position, velocity nor time
    bool is_steady = false;        ///< its acceleration does not depend on time
    bool is_conservative = false;  ///< all its work is what its potential falls by; only with a potential
};
/// Any callable as a force: returns the force in newton. It must be pure.
[[nodiscard]] std::unique_ptr<Force> make_force(std::function<Vec3(const ForceInput&)> force,
                                                CallableTraits traits = {});
/// Any callable as an acceleration, m/s^2. It must be pure.
[[nodiscard]] std::unique_ptr<Force> make_acceleration(std::function<Vec3(const ForceInput&)> acceleration,
                                                       CallableTraits traits = {});

/// A force on the particles of these ids only; it does nothing to others.
[[nodiscard]] std::unique_ptr<Force> make_force_on(std::vector<std::uint64_t> particles, std::unique_ptr<Force> force);

/// A sum of forces, added in the order given.
class ForceField {
public:
    ForceField() = default;
    /// Throws InputError for a null pointer.
    /// adds_coupling: false where the forces themselves account for ForceInput::coupling.
    explicit ForceField(std::vector<std::unique_ptr<Force>> forces, bool adds_coupling = true);
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const;
    /// Sum of the potentials, J; nothing when one force has none.
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const;
    [[nodiscard]] bool empty() const { return forces_.empty(); }
    /// True when the acceleration depends on neither position, velocity nor time.
    [[nodiscard]] bool is_uniform() const { return uniform_; }
    /// The same for one particle, with what others do to it.
    [[nodiscard]] bool is_uniform_for(const ForceInput& input) const {
        if (input.coupling == nullptr) return uniform_;
        return !input.coupling->varies() && (uniform_ || input.coupling->replaces_forces());
    }
    /// The acceleration where it is the same for all particles, everywhere and always, m/s^2: that of acceleration(),
    /// with the same bits, for particles that nothing couples.
    [[nodiscard]] const std::optional<Vec3>& common_acceleration() const { return common_; }
    /// True when no force depends on time.
    [[nodiscard]] bool is_steady() const { return steady_; }
    /// True when the work on one particle, with what others do to it, is what its potential energy falls by.
    [[nodiscard]] bool is_conservative_for(const ForceInput& input) const {
        return conservative_ && input.coupling == nullptr;
    }
    /// True when one force asks for the particles' temperature.
    [[nodiscard]] bool needs_temperature() const { return needs_temperature_; }

private:
    std::vector<std::unique_ptr<Force>> forces_;
    bool adds_coupling_ = true;
    bool uniform_ = true;
    bool steady_ = true;
    bool conservative_ = true;
    bool needs_temperature_ = false;
    std::optional<Vec3> common_ = Vec3{};
};

// Drag: what a medium does to a particle that moves through it. Laws differ in how the force grows with the velocity w
// relative to the medium; each takes a flow, or leaves it out for a medium at rest. Drags store no energy.

/// F = -coefficient w; coefficient in kg/s, >= 0.
[[nodiscard]] std::unique_ptr<Force> make_linear_drag(double coefficient, FlowPointer flow = nullptr);

/// F = -coefficient |w| w; coefficient in kg/m, >= 0: for particles of any radius, points too.
[[nodiscard]] std::unique_ptr<Force> make_quadratic_drag(double coefficient, FlowPointer flow = nullptr);

/// F = -1/2 fluid_density drag_coefficient pi radius^2 |w| w for the particle's own radius: none for points.
/// drag_coefficient: a pure number >= 0 (0.47 for a ball at medium speeds); fluid_density in kg/m^3, >= 0.
/// Source: G. K. Batchelor, "An Introduction to Fluid Dynamics", Cambridge 1967, section 5.11.
[[nodiscard]] std::unique_ptr<Force> make_sphere_drag(double drag_coefficient, double fluid_density,
                                                      FlowPointer flow = nullptr);

/// Stokes's law F = -6 pi viscosity radius w, for slow spheres (Reynolds numbers below some 0.1); none for points.
/// viscosity: dynamic, Pa s, >= 0. Source: G. G. Stokes, Trans. Cambridge Phil. Soc. 9, 1851.
[[nodiscard]] std::unique_ptr<Force> make_stokes_drag(double viscosity, FlowPointer flow = nullptr);

/// Spheres at any speed below some Re = 2e5: F = -1/2 fluid_density C_d pi radius^2 |w| w with the drag coefficient
/// below; none for points. fluid_density in kg/m^3, >= 0; viscosity: dynamic, Pa s, > 0.
[[nodiscard]] std::unique_ptr<Force> make_schiller_naumann_drag(double fluid_density, double viscosity,
                                                                FlowPointer flow = nullptr);

/// Drag coefficient of a sphere by its Reynolds number (> 0): 24 / Re (1 + 0.15 Re^0.687) below 1000, 0.44 above.
/// Source: L. Schiller, A. Naumann, Z. Ver. Dt. Ing. 77, 1933, as given in R. Clift, J. R. Grace, M. E. Weber,
/// "Bubbles, Drops, and Particles", Academic Press 1978, chapter 5.
[[nodiscard]] double schiller_naumann_coefficient(double reynolds);

// Gravity of point masses.

/// One attracting mass, that stays where it is.
struct Attractor {
    Vec3 position;           ///< m
    double strength = 0.0;   ///< G M, m^3/s^2; negative repels
    double softening = 0.0;  ///< m, >= 0: the mass is spread over about this length
};

/// a = -strength d / (|d|^2 + softening^2)^(3/2), d from the attractor to the particle; summed over the attractors in
/// their order. Exactly at an attractor without softening, where nothing is defined, it does not pull.
/// Source: H. C. Plummer, MNRAS 71, 1911.
[[nodiscard]] std::unique_ptr<Force> make_point_gravity(std::vector<Attractor> attractors);

// A force towards or away from a centre by a power of the distance.

/// F = -strength (s / reference)^(exponent - 1) d / reference with d from the centre and s^2 = |d|^2 + softening^2.
/// Without softening its size is strength (|d| / reference)^exponent: exponent 1 is a spring, 0 a constant pull, -2
/// Coulomb's and Newton's law. Its potential is a power of s, or a logarithm for exponent -1; zero at the centre for
/// exponents above -1, at s = reference for -1, infinitely far away below. At the very centre it does not pull.
struct RadialForceSettings {
    Vec3 center;             ///< m
    double strength = 0.0;   ///< N at the reference distance; negative pushes away
    double exponent = -2.0;  ///< -12 to 12
    double softening = 0.0;  ///< m, >= 0
    double reference = 1.0;  ///< m, > 0
};
[[nodiscard]] std::unique_ptr<Force> make_radial_force(const RadialForceSettings& settings);

/// Largest magnitude of RadialForceSettings::exponent.
inline constexpr double kLargestRadialExponent = 12.0;

// Springs from particles to fixed points.

/// F = -stiffness (|d| - rest_length) d / |d| - damping (v . d) d / |d|^2 with d from the anchor to the particle: the
/// damper acts along the spring alone. At the anchor itself, where a spring has no direction, it does nothing. The
/// potential is that of the spring, stiffness / 2 (|d| - rest_length)^2; damping stores none.
struct AnchorSettings {
    Vec3 position;                           ///< m
    double stiffness = 0.0;                  ///< N/m, >= 0
    double rest_length = 0.0;                ///< m, >= 0
    double damping = 0.0;                    ///< kg/s, >= 0
    std::vector<std::uint64_t> particles{};  ///< ids of those that hang on it; empty: all
};
[[nodiscard]] std::unique_ptr<Force> make_anchor(AnchorSettings settings);

// Charged particles in uniform electric and magnetic fields.

/// The Lorentz force F = q (E + v x B) on particles that all carry the same charge q. The magnetic part does no work;
/// the potential is -q E . x, zero at the world's origin. Source: J. D. Jackson, "Classical Electrodynamics", 3rd ed.,
/// section 12.2 (slow particles).
struct LorentzSettings {
    double charge = 0.0;  ///< C, of every particle
    Vec3 electric;        ///< V/m
    Vec3 magnetic;        ///< T
};
[[nodiscard]] std::unique_ptr<Force> make_lorentz_force(const LorentzSettings& settings);

// Lift of particles in a fluid at rest under gravity.

/// Archimedes's F = -fluid_density (4/3) pi radius^3 gravity for the particle's own radius: none for points. The
/// particle's own weight is a force of its own (make_gravity). fluid_density in kg/m^3, >= 0; gravity in m/s^2.
[[nodiscard]] std::unique_ptr<Force> make_buoyancy(double fluid_density, const Vec3& gravity);

/// Lift of parcels of gas that are hotter or colder than the gas around, which is at rest and of the same kind and
/// pressure: a = -gravity T / ambient_temperature, the parcel's weight being a force of its own (make_gravity), so that
/// both together are gravity (1 - T / ambient_temperature). Particles of the temperature 0 have none: bodies whose
/// density is far above the gas's. gravity in m/s^2; ambient_temperature in K, > 0.
/// Source: J. S. Turner, "Buoyancy Effects in Fluids", Cambridge 1973, section 1.2, with the density of an ideal gas.
[[nodiscard]] std::unique_ptr<Force> make_thermal_buoyancy(double ambient_temperature, const Vec3& gravity);

// Vector fields that act as forces by themselves.

/// What the vectors of a field mean.
enum class FieldMeaning {
    acceleration,  ///< m/s^2, the same for every mass
    force,         ///< N
};

/// A flow's vectors taken as accelerations or forces. It has no potential.
[[nodiscard]] std::unique_ptr<Force> make_field_force(FlowPointer field, FieldMeaning meaning);

/// A force around an axis, by the right-hand rule: tangential acceleration `acceleration` (m/s^2) at the distance
/// core_radius (m, > 0), growing linearly from the axis to there and falling as one over the distance outside. axis: of
/// any length but zero. It has no potential: a particle that goes round gains energy.
[[nodiscard]] std::unique_ptr<Force> make_swirl(const Vec3& point, const Vec3& axis, double acceleration,
                                                double core_radius);

}  // namespace ricochet
