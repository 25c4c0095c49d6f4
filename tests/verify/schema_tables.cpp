#include "verify/schema_tables.h"

#include <span>
#include <string_view>

namespace ricochet::test {
namespace {

template <class Value>
struct Row {
    std::string_view name;  // OWNER(TYPE).KEY, OWNER.KEY or KEY
    Value value;
};

using Unit = Range::Unit;

constexpr Row<Range> kRanges[] = {
    {"resting_speed", {0, 0.1}},
    {"tolerance.position", {-8, -4, Unit::logarithm}},
    {"tolerance.velocity", {-8, -4, Unit::logarithm}},
    {"time_tolerance", {-9, -5, Unit::logarithm}},
    {"offset", {-7, -3, Unit::logarithm}},
    {"penalty.stiffness", {2, 4, Unit::logarithm}},
    {"contact_steps", {10, 30}},
    {"substeps", {1, 12}},
    {"frame_rate", {10, 100}},
    {"max_depth", {0, 3}},
    {"most_particles", {20, 120}},
    {"bounce_budget", {8, 200}},
    {"impact_budget", {1, 100}},
    {"seed", {0, 1000}},
    {"acceleration", {-10, 10}},
    {"gravity", {-10, 10}},
    {"velocity", {-4, 4}},
    {"angular_velocity", {-4, 4}},
    {"spin", {-20, 20}},
    {"emitter.speed", {0, 8}},
    {"fluid_density", {0, 100}},
    {"viscosity", {-5, 0, Unit::logarithm}},
    {"ambient_temperature", {100, 400}},
    {"wall_temperature", {1, 400}},
    {"strength", {-5, 5}},
    {"exponent", {-3, 3}},
    {"softening", {0.05, 0.5}},
    {"core_radius", {0.1, 1}},
    {"magnetic", {-5, 5}},
    {"stiffness", {0, 20}},
    {"depth", {0.01, 0.1}},
    {"diameter", {0.1, 0.3}},
    {"cutoff", {1.5, 4}},
    {"range", {0.01, 0.1}},
    {"octaves", {1, 3}},
    {"gain", {0.2, 1}},
    {"length", {0.3, 2}},
    {"friction", {0, 1.5}},
    {"spinning_friction", {0, 0.02}},
    {"rolling_friction", {0, 0.3}},
    {"absorption", {0, 0.5}},
    {"collider.radius", {0.3, 1.6}},
    {"collider.size", {0.2, 2.5}},
    {"height", {0.2, 2}},
    {"scale", {0.3, 1.5}},
    {"degrees", {-360, 360}},
    {"time", {-0.1, 1.1, Unit::of_duration}},
    {"start", {0, 1, Unit::of_duration}},
    {"stop", {0, 1, Unit::of_duration}},
    {"lifetime", {0.1, 1.2, Unit::of_duration}},
    {"scale_curve_key.value", {0.5, 1.5}},
    {"frame_motion(spin).rate", {-300, 300}},
    {"frame_motion(swing).amplitude", {0, 60}},
    {"frame_motion(oscillation).amplitude", {-0.4, 0.4}},
    {"frequency", {0.1, 8}},
    {"phase", {0, 360}},
    {"mass", {-2, 2, Unit::logarithm}},
    {"density", {-1, 3, Unit::logarithm}},
    {"inertia", {0.3, 0.5}},
    {"inertia_products", {-0.05, 0.05}},
    {"body.center", {-0.2, 0.2}},
    {"spring", {0, 20}},
    {"motor_most", {0, 10}},
    {"burst", {0, 10}},
    {"emitter.rate", {0, 10, Unit::per_duration}},
    {"rate_per_area", {0, 1e-3}},
    {"limit", {0, 12}},
    {"cone", {0, 180}},
    {"particle_radius", {0.01, 0.2}},
    {"particle.radius", {0.01, 0.2}},
    {"particle_size", {0, 0.1}},
    {"count", {0.5, 4}},
    {"angle", {0, 80}},
    {"springs.radius", {0.005, 0.04}},
    {"nodes", {2, 8}},
    {"links", {1, 7}},
    {"link_length", {0.1, 0.5}},
    {"cells_u", {1, 3}},
    {"cells_v", {1, 3}},
    {"pinned", {0, 4}},
    {"breaking_stretch", {0.05, 2}},
    {"specific_heat", {1, 1000}},
    {"prandtl", {0.5, 8}},
    {"coefficient", {0, 2}},
    {"components", {1, 4}},
    {"lower", {-3, -1.5}},
    {"upper", {1.5, 3}},
    {"field_of_view", {20, 100}},
    {"image_height", {10, 1000}},
};

constexpr double kUsual = 0.25;
constexpr Row<double> kProbabilities[] = {
    {"scene.simulation", 1.0},
    {"scene.colliders", 0.9},
    {"scene.emitters", 0.8},
    {"scene.particle_contacts", 0.35},
    {"scene.particles", 0.8},
    {"scene.materials", 1.0},
    {"scene.forces", 0.8},
    {"scene.springs", 0.2},
    {"scene.heat", 0.2},
    {"scene.bounds", 0.1},
    {"scene.frames", 0.4},
    {"scene.attributes", 0.4},
    {"scene.flows", 0.3},
    {"scene.output", 0.3},
    {"scene.particle_forces", 0.12},
    {"particle_contacts.method", 0.6},
    {"restitution", 0.8},
    {"friction", 0.6},
    {"burst", 0.8},
    {"emitter.speed", 0.7},
    {"collider.material", 0.85},
    {"particle_radius", 0.5},
    {"particle.radius", 0.5},
    {"force.particles", 0.05},
    {"emitter.frame", 0.1},
    {"limit", 0.1},
    {"absorption", 0.05},
    {"diffuse", 0.1},
    {"wall_temperature", 0.05},
    {"cloud(cone).parent_ends", 0.9},
    {"cloud(cone).turning", 0.9},
    {"convection.flow", 0.8},
    {"convection.prandtl", 0.8},
    {"surface_motion", 0.12},
    {"rate_per_area", 0.05},
    {"parent", 0.4},
    {"simulation.motion", 0.1},
    {"simulation.flow", 0.1},
    {"particle.pinned", 0.05},
    {"position", 0.8},
    {"motions", 0.7},
    {"body", 0.45},
    {"breaking_stretch", 0.15},
    {"center", 0.7},
    {"scene.reference_camera", 0.1},
    {"collider.up", 0.1},
    {"volume", 0.4},
    {"mass", 0.5},
};

/// Returns the value of the most specific matching row.
template <class Value>
const Value* entry(std::span<const Row<Value>> table, const std::string& owner, const std::string& key) {
    for (const std::string& name : {owner + "." + key, owner.substr(0, owner.find('(')) + "." + key, key}) {
        for (const Row<Value>& row : table) {
            if (row.name == name) return &row.value;
        }
    }
    return nullptr;
}

}  // namespace

std::optional<Range> range_of(const std::string& owner, const std::string& key) {
    const Range* const known = entry<Range>(kRanges, owner, key);
    return known == nullptr ? std::nullopt : std::optional(*known);
}

double probability_of(const std::string& owner, const std::string& key) {
    const double* const known = entry<double>(kProbabilities, owner, key);
    return known == nullptr ? kUsual : *known;
}

}  // namespace ricochet::test
