/// \file
/// Forces on single particles: the Force interface, sums of forces, and the force laws of callables and scene files.
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

/// State of one particle at one time: the input of a force.
struct ForceInput {
    Vec3 position;         ///< m
    Vec3 velocity;         ///< m/s
    double mass;           ///< kg
    double radius;         ///< m
    double time;           ///< s
    std::uint64_t id = 0;  ///< id of the particle, for forces that act on selected particles only
    /// Action of other particles on this particle, from a bounce to the end of the step; null if it is not coupled.
    const Coupling* coupling = nullptr;
    /// Radius of the whole sphere, in m, if only a core with the radius `radius` collides, else 0. ForceField passes
    /// the whole radius to the forces.
    double whole_radius = 0.0;
    double temperature = 0.0;  ///< attribute `temperature` at the start of the step, in K; 0 without it
};

/// Action of other particles on a particle that has left the plan of a step by a bounce. Implementations are pure, like
/// forces.
class Coupling {
public:
    virtual ~Coupling() = default;
    /// Returns the force divided by the mass, in m/s^2.
    [[nodiscard]] virtual Vec3 acceleration(const ForceInput& input) const = 0;
    /// Returns true if the acceleration depends on position, velocity or time.
    [[nodiscard]] virtual bool varies() const = 0;
    /// Returns true if the coupling already includes all forces. The forces are then not added again.
    [[nodiscard]] virtual bool replaces_forces() const { return false; }
};

/// One force on single particles. Implementations are pure: the same input gives the same bits in any thread. A
/// non-finite acceleration ends the step with a RunError that names the force and the particle.
class Force {
public:
    virtual ~Force() = default;
    /// Returns the force divided by the mass, in m/s^2.
    [[nodiscard]] virtual Vec3 acceleration(const ForceInput& input) const = 0;
    /// Returns the potential energy of the particle by this force, in J. Dissipative forces store no energy and return
    /// 0. Returns nothing if the force has no potential.
    [[nodiscard]] virtual std::optional<double> potential_energy(const ForceInput& input) const = 0;
    /// Returns true if the acceleration depends on neither position, velocity nor time.
    [[nodiscard]] virtual bool is_uniform() const { return false; }
    /// Returns the acceleration, in m/s^2, if it is the same for all particles at all positions and times.
    [[nodiscard]] virtual std::optional<Vec3> common_acceleration() const { return std::nullopt; }
    /// Returns true if the acceleration does not depend on time. A particle at rest then stays at rest and may sleep.
    [[nodiscard]] virtual bool is_steady() const { return is_uniform(); }
    /// Returns true if the force only converts its potential energy to work. Contact phases then conserve the total
    /// energy.
    [[nodiscard]] virtual bool is_conservative() const { return false; }
    /// Returns true if the force reads ForceInput::temperature.
    [[nodiscard]] virtual bool needs_temperature() const { return false; }
};

/// Returns uniform gravity with the given acceleration, in m/s^2.
[[nodiscard]] std::unique_ptr<Force> make_gravity(const Vec3& acceleration);

/// Known properties of a force from a callable. `potential` must be pure, like the force.
struct CallableTraits {
    std::function<double(const ForceInput&)> potential = {};  ///< potential energy, in J; empty: no potential
    bool is_uniform = false;       ///< the acceleration depends on neither position, velocity nor time
    bool is_steady = false;        ///< the acceleration does not depend on time
    bool is_conservative = false;  ///< the force only converts its potential energy to work; requires a potential
};
/// Makes a force from a callable that returns newtons. The callable must be pure.
[[nodiscard]] std::unique_ptr<Force> make_force(std::function<Vec3(const ForceInput&)> force,
                                                CallableTraits traits = {});
/// Makes a force from a callable that returns an acceleration, in m/s^2. The callable must be pure.
[[nodiscard]] std::unique_ptr<Force> make_acceleration(std::function<Vec3(const ForceInput&)> acceleration,
                                                       CallableTraits traits = {});

/// Returns a force that acts only on the particles with the given ids.
[[nodiscard]] std::unique_ptr<Force> make_force_on(std::vector<std::uint64_t> particles, std::unique_ptr<Force> force);

/// Sum of forces, added in the given order.
class ForceField {
public:
    ForceField() = default;
    /// Throws InputError for a null pointer. adds_coupling: false if the forces themselves include
    /// ForceInput::coupling.
    explicit ForceField(std::vector<std::unique_ptr<Force>> forces, bool adds_coupling = true);
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const;
    /// Returns the sum of the potentials, in J; nothing if any force has no potential.
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const;
    [[nodiscard]] bool empty() const { return forces_.empty(); }
    /// Returns true if the acceleration depends on neither position, velocity nor time.
    [[nodiscard]] bool is_uniform() const { return uniform_; }
    /// Returns is_uniform() for this particle, including its coupling.
    [[nodiscard]] bool is_uniform_for(const ForceInput& input) const {
        if (input.coupling == nullptr) return uniform_;
        return !input.coupling->varies() && (uniform_ || input.coupling->replaces_forces());
    }
    /// Returns the acceleration, in m/s^2, if it is the same for all particles at all positions and times. It has the
    /// same bits as acceleration() of uncoupled particles.
    [[nodiscard]] const std::optional<Vec3>& common_acceleration() const { return common_; }
    /// Returns true if no force depends on time.
    [[nodiscard]] bool is_steady() const { return steady_; }
    /// Returns true if all work on this particle is converted potential energy. Returns false for a coupled particle.
    [[nodiscard]] bool is_conservative_for(const ForceInput& input) const {
        return conservative_ && input.coupling == nullptr;
    }
    /// Returns true if any force reads the particles' temperature.
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

// Drag: the resistance of a medium to a particle that moves through it. w is the particle's velocity relative to the
// medium. Each law takes the flow of the medium. If the flow is null, the medium is at rest. Drags store no energy.

/// Returns F = -coefficient w; coefficient in kg/s, >= 0.
[[nodiscard]] std::unique_ptr<Force> make_linear_drag(double coefficient, FlowPointer flow = nullptr);

/// Returns F = -coefficient |w| w; coefficient in kg/m, >= 0. It acts on particles of any radius, points included.
[[nodiscard]] std::unique_ptr<Force> make_quadratic_drag(double coefficient, FlowPointer flow = nullptr);

/// Returns F = -1/2 fluid_density drag_coefficient pi radius^2 |w| w with the radius of the particle. The force is zero
/// for points. drag_coefficient: dimensionless, >= 0 (0.47 for a ball at medium speeds). fluid_density in kg/m^3, >= 0.
/// Source: G. K. Batchelor, "An Introduction to Fluid Dynamics", Cambridge 1967, section 5.11.
[[nodiscard]] std::unique_ptr<Force> make_sphere_drag(double drag_coefficient, double fluid_density,
                                                      FlowPointer flow = nullptr);

/// Returns Stokes's law F = -6 pi viscosity radius w for slow spheres (Reynolds numbers below about 0.1). The force is
/// zero for points. viscosity: dynamic viscosity, in Pa s, >= 0. Source: G. G. Stokes, Trans. Cambridge Phil. Soc. 9,
/// 1851.
[[nodiscard]] std::unique_ptr<Force> make_stokes_drag(double viscosity, FlowPointer flow = nullptr);

/// Returns the drag of spheres for Reynolds numbers below about 2e5: F = -1/2 fluid_density C_d pi radius^2 |w| w. C_d
/// is schiller_naumann_coefficient(). The force is zero for points. fluid_density in kg/m^3, >= 0. viscosity: dynamic
/// viscosity, in Pa s, > 0.
[[nodiscard]] std::unique_ptr<Force> make_schiller_naumann_drag(double fluid_density, double viscosity,
                                                                FlowPointer flow = nullptr);

/// Returns the drag coefficient of a sphere at a Reynolds number Re > 0: 24 / Re (1 + 0.15 Re^0.687) if Re < 1000,
/// otherwise 0.44. Source: L. Schiller, A. Naumann, Z. Ver. Dt. Ing. 77, 1933, as given in R. Clift, J. R. Grace, M. E.
/// Weber, "Bubbles, Drops, and Particles", Academic Press 1978, chapter 5.
[[nodiscard]] double schiller_naumann_coefficient(double reynolds);

// Gravity of point masses.

/// One attracting mass at a fixed position.
struct Attractor {
    Vec3 position;           ///< in m
    double strength = 0.0;   ///< G M, in m^3/s^2; negative values repel
    double softening = 0.0;  ///< softening length, in m, >= 0; the mass is spread over about this length
};

/// Returns the sum of the attractors' accelerations a = -strength d / (|d|^2 + softening^2)^(3/2), in the given order.
/// d points from the attractor to the particle. At the position of an attractor without softening its acceleration is
/// zero. Source: H. C. Plummer, MNRAS 71, 1911.
[[nodiscard]] std::unique_ptr<Force> make_point_gravity(std::vector<Attractor> attractors);

// A central force proportional to a power of the distance.

/// Settings of the force F = -strength (s / reference)^(exponent - 1) d / reference. d points from the centre to the
/// particle, and s^2 = |d|^2 + softening^2. The exponent 1 gives a spring, 0 a constant attraction, and -2 the law of
/// Coulomb and Newton. The force is zero at the centre. The potential is zero at the centre for exponents above -1, at
/// s = reference for -1, and at infinity for exponents below -1.
struct RadialForceSettings {
    Vec3 center;             ///< in m
    double strength = 0.0;   ///< force at the reference distance, in N; negative values repel
    double exponent = -2.0;  ///< -12 to 12
    double softening = 0.0;  ///< in m, >= 0
    double reference = 1.0;  ///< in m, > 0
};
[[nodiscard]] std::unique_ptr<Force> make_radial_force(const RadialForceSettings& settings);

/// Largest magnitude of RadialForceSettings::exponent. Local: a limit of input values.
inline constexpr double kLargestRadialExponent = 12.0;

// Springs from particles to fixed points.

/// Settings of the force F = -stiffness (|d| - rest_length) d / |d| - damping (v . d) d / |d|^2. d points from the
/// anchor to the particle. The force is zero at the anchor, where the spring has no direction. The potential is
/// stiffness / 2 (|d| - rest_length)^2. Damping stores no energy.
struct AnchorSettings {
    Vec3 position;                           ///< in m
    double stiffness = 0.0;                  ///< in N/m, >= 0
    double rest_length = 0.0;                ///< in m, >= 0
    double damping = 0.0;                    ///< in kg/s, >= 0
    std::vector<std::uint64_t> particles{};  ///< ids of the attached particles; if empty, all particles are attached
};
[[nodiscard]] std::unique_ptr<Force> make_anchor(AnchorSettings settings);

// Charged particles in uniform electric and magnetic fields.

/// Settings of the Lorentz force F = q (E + v x B) on particles that all have the same charge q. The magnetic part does
/// no work. The potential is -q E . x. It is zero at the world's origin. Source: J. D. Jackson, "Classical
/// Electrodynamics", 3rd ed., section 12.2 (slow particles).
struct LorentzSettings {
    double charge = 0.0;  ///< charge of every particle, in C
    Vec3 electric;        ///< electric field, in V/m
    Vec3 magnetic;        ///< magnetic field, in T
};
[[nodiscard]] std::unique_ptr<Force> make_lorentz_force(const LorentzSettings& settings);

// Buoyancy of particles in a fluid at rest under gravity.

/// Returns Archimedes's force F = -fluid_density (4/3) pi radius^3 gravity with the radius of the particle. The force
/// is zero for points. The weight of the particle is a separate force (make_gravity). fluid_density in kg/m^3, >= 0;
/// gravity in m/s^2.
[[nodiscard]] std::unique_ptr<Force> make_buoyancy(double fluid_density, const Vec3& gravity);

/// Returns the buoyancy of gas parcels that are hotter or colder than the ambient gas: a = -gravity T /
/// ambient_temperature. Both gases are of the same kind and have the same pressure. The ambient gas is at rest. The
/// weight of the parcel is a separate force (make_gravity). Buoyancy does not act on particles with the temperature 0,
/// which stand for far denser bodies. gravity in m/s^2; ambient_temperature in K, > 0. Source: J. S. Turner, "Buoyancy
/// Effects in Fluids", Cambridge 1973, section 1.2, with the density of an ideal gas.
[[nodiscard]] std::unique_ptr<Force> make_thermal_buoyancy(double ambient_temperature, const Vec3& gravity);

// Vector fields used directly as forces.

/// Meaning of the vectors of a field.
enum class FieldMeaning {
    acceleration,  ///< acceleration in m/s^2, the same for every mass
    force,         ///< in N
};

/// Makes a force from a flow whose vectors are accelerations or forces. The force has no potential.
[[nodiscard]] std::unique_ptr<Force> make_field_force(FlowPointer field, FieldMeaning meaning);

/// Returns a force that acts tangentially around an axis, by the right-hand rule. Its acceleration grows linearly from
/// the axis to `acceleration` (m/s^2) at the distance core_radius (m, > 0), and falls as 1 / distance outside. axis:
/// any nonzero length. The force has no potential, because a particle that circles the axis gains energy.
[[nodiscard]] std::unique_ptr<Force> make_swirl(const Vec3& point, const Vec3& axis, double acceleration,
                                                double core_radius);

}  // namespace ricochet
