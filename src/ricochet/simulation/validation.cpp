#include "ricochet/simulation/validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/settings_table.h"
#include "ricochet/simulation/memory_estimate.h"
#include "ricochet/simulation/options_table.h"

namespace ricochet {
namespace {

/// Largest number of births of an emitter. Particles retire, so more can be born than live at the same time with 32-bit
/// indices. Local: a limit of input values.
constexpr double kMostBirths = 1e12;

void validate(const SimulationOptions& options) {
    const Subject subject("options");
    subject.require_settings(options, kTimeTable);
    subject.require_settings(options, kRulesTable);
    if (options.duration / options.time_step > kMostSteps) {
        subject.refuse("duration / time_step", options.duration / options.time_step,
                       fmt::format("at most {:g} steps", kMostSteps));
    }
    const auto kinds = response_kinds();
    if (std::ranges::find(kinds, options.response) == kinds.end()) {
        subject.refuse("response", static_cast<int>(options.response), "one of the responses");
    }
    if (options.walls != WallRule::slide && options.walls != WallRule::stop) {
        subject.refuse("walls", static_cast<int>(options.walls), "slide or stop");
    }
    const auto method = static_cast<std::size_t>(options.integrator.kind);
    subject.require_index(method, integrator_names().size(), "integrator", "methods");
}

void validate(const Material& material, std::size_t number) {
    const Subject subject("material", number, material.name);
    subject.require_settings(material, kMaterialTable);
    subject.require_settings(material, kImpactLawTable<Material>);
    subject.require_settings(material, kSurfaceLawTable);
    if (material.static_friction && !(*material.static_friction >= material.friction && material.friction > 0.0)) {
        subject.refuse("static_friction", *material.static_friction, "at least the friction, which must be above 0");
    }
    for (const ImpactTableRow& row : material.impact_table) {
        subject.require_settings(row, kImpactTableRowTable, "impact_table.");
    }
    if (!material.impact_table.empty() && !is_grid(material.impact_table)) {
        subject.refuse("impact_table", "rows that are no grid", "the same angles at each speed, in ascending order");
    }
    if (!material.impact_table.empty() && material.restitution_speed) {
        subject.refuse("restitution_speed", *material.restitution_speed, "none beside an impact_table");
    }
    subject.require_settings(material.motion, kSurfaceMotionTable, "surface_motion.");
}

void validate(const Placement& placement, const Subject& subject) {
    subject.require(placement.position, kCoordinate, "position", "m");
    subject.require_direction(placement.rotation_axis, "rotation axis");
    if (!std::isfinite(placement.rotation_degrees)) {
        subject.refuse("rotation", placement.rotation_degrees, "a finite number of degrees");
    }
    subject.require(placement.scale, kCoordinate, "scale", "");
}

void validate(const MeshShape& shape, const Subject& subject, std::size_t materials) {
    if (!shape.mesh) subject.refuse("mesh", "a null pointer", "a mesh");
    for (const Triangle& triangle : shape.mesh->triangles) {
        for (const std::uint32_t vertex : triangle) {
            subject.require_index(vertex, shape.mesh->vertices.size(), "corner of a triangle", "vertices");
        }
    }
    validate(shape.placement, subject);
    if (shape.motion && shape.motion->vertex_count() != shape.mesh->vertices.size()) {
        subject.refuse("motion", fmt::format("{} vertices", shape.motion->vertex_count()),
                       fmt::format("the {} of the mesh", shape.mesh->vertices.size()));
    }
    const auto& list = shape.triangle_materials;
    if (!list.empty() && list.size() != shape.mesh->triangles.size()) {
        subject.refuse("triangle_materials", list.size(),
                       fmt::format("none or one for each of the {} triangles", shape.mesh->triangles.size()));
    }
    for (const std::uint32_t material : list) {
        subject.require_index(material, materials, "material of a triangle", "materials");
    }
}

void validate(const ColliderShape& shape, const Subject& subject, std::size_t materials) {
    if (const auto* plane = std::get_if<PlaneShape>(&shape)) {
        subject.require(plane->point, kCoordinate, "point", "m");
        subject.require_direction(plane->normal, "normal");
    } else if (const auto* mesh = std::get_if<MeshShape>(&shape)) {
        validate(*mesh, subject, materials);
    } else if (const auto* ball = std::get_if<BallShape>(&shape)) {
        subject.require(ball->radius, kLength, "radius", "m");
        validate(ball->placement, subject);
    } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
        subject.require(cylinder->radius, kLength, "radius", "m");
        subject.require(cylinder->height, kLength, "height", "m");
        validate(cylinder->placement, subject);
    } else if (const auto* cuboid = std::get_if<CuboidShape>(&shape)) {
        for (int axis = 0; axis < 3; ++axis) subject.require(cuboid->size[axis], kLength, "size", "m");
        validate(cuboid->placement, subject);
    }
}

/// Returns the largest number of births of an emitter without parent, without those per screen area.
double most_births(const EmitterDescription& emitter, const SimulationOptions& options) {
    if (emitter.parent) return 0.0;
    const double rate = emitter.rate.mean + emitter.rate.spread +
                        (emitter.rate_per_frame.mean + emitter.rate_per_frame.spread) * options.frame_rate;
    const double time = std::max(0.0, std::min(options.duration, emitter.stop) - emitter.start);
    const double births = static_cast<double>(emitter.burst) + (time > 0.0 ? rate * time : 0.0) +
                          births_of_curve(emitter.rate_curve, emitter.start, emitter.start + time);
    return std::min(births, static_cast<double>(emitter.limit));
}

void validate_emitters(const SimulationSetup& setup) {
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        const EmitterDescription& emitter = setup.emitters[k];
        const Subject subject("emitter", k, emitter.name);
        if (emitter.burst > std::numeric_limits<std::uint32_t>::max()) {
            subject.refuse("burst", emitter.burst, "a number below 2^32");
        }
        if (emitter.parent) {
            subject.require_index(emitter.parent->emitter, setup.emitters.size(), "parent", "emitters");
        }
        if (emitter.frames) subject.require_index(emitter.frame, emitter.frames->size(), "frame", "frames");
        const double births = most_births(emitter, setup.options);
        if (births > kMostBirths) subject.refuse("births", births, fmt::format("at most {:g}", kMostBirths));
    }
}

void validate_springs(const SimulationSetup& setup) {
    if (setup.options.flow != nullptr && !setup.springs.empty()) {
        Subject("springs").refuse("number", setup.springs.size(), "none: a flow carries the particles");
    }
    for (std::size_t k = 0; k < setup.springs.size(); ++k) {
        for (const std::uint64_t end : {setup.springs[k].first, setup.springs[k].second}) {
            Subject("spring", k).require_index(end, setup.particles.size(), "end", "particles");
        }
    }
    for (std::size_t k = 0; k < setup.spring_faces.size(); ++k) {
        const Subject subject("spring face", k);
        for (const std::uint64_t corner : setup.spring_faces[k].corners) {
            subject.require_index(corner, setup.particles.size(), "corner", "particles");
        }
        for (const std::uint32_t spring : setup.spring_faces[k].springs) {
            subject.require_index(spring, setup.springs.size(), "edge", "springs");
        }
    }
}

void validate(const Box3& bounds) {
    const Subject subject("bounds");
    for (int axis = 0; axis < 3; ++axis) {
        if (bounds.lower[axis] < bounds.upper[axis]) continue;
        subject.refuse(fmt::format("{}", "xyz"[axis]), fmt::format("{} to {}", bounds.lower[axis], bounds.upper[axis]),
                       "a lower end below the upper one");
    }
}

void validate(const ReferenceCamera& camera) {
    const Subject subject("reference camera");
    subject.require(camera.position, kCoordinate, "position", "m");
    subject.require(camera.target, kCoordinate, "target", "m");
    subject.require_direction(camera.target - camera.position, "direction to the target");
    subject.require_in(camera.field_of_view_degrees, 1.0, 170.0, "field_of_view", "1 to 170 degrees");
    subject.require(camera.image_height, kPositive, "image_height", "pixels");
}

/// Refuses equal names. Several empty names are allowed.
template <class Named>
void validate_names(const std::vector<Named>& all, std::string_view kind) {
    std::set<std::string_view> taken;
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (all[k].name.empty() || taken.insert(all[k].name).second) continue;
        Subject(kind, k, all[k].name).refuse("name", all[k].name, "a name that no other has");
    }
}

}  // namespace

void validate(const Particle& particle, std::size_t number, std::size_t columns) {
    const Subject subject("particle", number);
    subject.require(particle.position, kCoordinate, "position", "m");
    subject.require(particle.velocity, kCoordinate, "velocity", "m/s");
    subject.require(particle.spin, kCoordinate, "spin", "rad/s");
    if (!(particle.mass >= kSmallestMass && std::isfinite(particle.mass))) {
        subject.refuse("mass", particle.mass, fmt::format("a finite number of at least {:g} (kg)", kSmallestMass));
    }
    subject.require_in(particle.radius, 0.0, kLargestCoordinate, "radius", "0 to 1e75 (m)");
    if (!std::isfinite(particle.birth_time)) subject.refuse("birth_time", particle.birth_time, "a time (s)");
    if (!(particle.lifetime >= 0.0)) subject.refuse("lifetime", particle.lifetime, "at least 0 (s)");
    if (particle.attributes.size() > columns) {
        subject.refuse("attributes", particle.attributes.size(), fmt::format("at most {}, one a column", columns));
    }
}

void validate(const ColliderDescription& collider, std::size_t number, std::size_t materials) {
    const Subject subject("collider", number, collider.name);
    subject.require_index(collider.material, materials, "material", "materials");
    validate(collider.shape, subject, materials);
}

const SimulationSetup& validated(const SimulationSetup& setup) {
    validate(setup.options);
    for (std::size_t k = 0; k < setup.materials.size(); ++k) validate(setup.materials[k], k);
    for (std::size_t k = 0; k < setup.colliders.size(); ++k) validate(setup.colliders[k], k, setup.materials.size());
    for (std::size_t k = 0; k < setup.particles.size(); ++k) validate(setup.particles[k], k, setup.attributes.size());
    if (setup.particles.size() > setup.options.most_particles) {
        Subject("options").refuse("most_particles", setup.options.most_particles,
                                  fmt::format("at least the {} particles that are there", setup.particles.size()));
    }
    validate_together(setup);
    validate_names(setup.colliders, "collider");
    validate_names(setup.emitters, "emitter");
    validate_counters(setup.counters);
    validate_names(setup.counters, "counter");
    validate_emitters(setup);
    validate_springs(setup);
    validate_heat(setup);
    validate_thermal_forces(setup);
    if (setup.bounds) validate(*setup.bounds);
    if (setup.reference_camera) validate(*setup.reference_camera);
    require_memory(setup);
    return setup;
}

Subject::Subject(std::string_view kind, std::size_t number, std::string_view name)
    : name_(name.empty() ? fmt::format("{} {}", kind, number) : fmt::format("{} \"{}\"", kind, name)) {}

std::string Subject::text(double value) { return fmt::format("{}", value); }

void Subject::refuse(std::string_view what, std::string_view found, std::string_view expected) const {
    throw InputError(fmt::format("{}: {}: found {}, expected {}", name_, what, found, expected));
}

void Subject::require(const SettingValue& value, const Range& range, std::string_view what,
                      std::string_view unit) const {
    const std::string refused = refusal(value, range, unit);
    if (!refused.empty()) throw InputError(fmt::format("{}: {}: {}", name_, what, refused));
}

void Subject::require_in(double value, double least, double most, std::string_view what,
                         std::string_view expected) const {
    if (!(value >= least && value <= most)) refuse(what, value, expected);
}

void Subject::require_direction(const Vec3& value, std::string_view what) const {
    if (is_finite(value) && length(value) > 0.0 && std::isfinite(length(value))) return;
    refuse(what, fmt::format("[{}, {}, {}]", value.x, value.y, value.z), "a direction of finite length above 0");
}

void Subject::require_index(std::size_t index, std::size_t count, std::string_view what, std::string_view of) const {
    if (index < count) return;
    if (count == 0) refuse(what, index, fmt::format("none: there are no {}; add one first", of));
    refuse(what, index, fmt::format("a number below {}, the number of {}", count, of));
}

}  // namespace ricochet
