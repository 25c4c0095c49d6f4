#include "ricochet/io/detail/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/placed_mesh.h"
#include "ricochet/io/detail/object_view.h"
#include "ricochet/io/detail/particle_table.h"
#include "ricochet/io/detail/scene_files.h"
#include "ricochet/io/detail/suggestion.h"

namespace ricochet::detail {
namespace {

constexpr double kMostSteps = 1e12;
constexpr double kMostParticles = 4294967295.0;  // 32-bit places

bool is_finite_mesh(const TriangleMesh& mesh) {
    return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                       [](const Vec3& v) { return is_finite(v) && max_abs(v) <= kLargestCoordinate; });
}

class SceneBuilder {
public:
    SceneBuilder(const JsonNode& root, std::filesystem::path folder, Diagnostics& diagnostics)
        : root_(root, scene_spec(), ""), folder_(std::move(folder)), diagnostics_(diagnostics) {}

    SceneDescription build() {
        build_simulation();
        build_forces();
        build_materials();
        build_bounds();
        build_colliders();
        build_emitters();
        build_particles();
        build_output();
        build_camera();
        warn_about_idle_parts();
        return std::move(scene_);
    }

private:
    // Calls body(view) for every object of a list, with its place in the list.
    template <typename Body>
    void for_each(std::string_view list, Body body) {
        const JsonNode::Array* items = root_.node(list).array();
        if (items == nullptr) return;
        const ObjectSpec& spec = *find_key(scene_spec(), nullptr, list)->content;
        for (std::size_t i = 0; i < items->size(); ++i) {
            body(ObjectView((*items)[i], spec, path_of_item(std::string(list), i)), i);
        }
    }

    void error(const ObjectView& view, std::string_view key, const std::string& what) {
        diagnostics_.error(view.place_of(key), view.path_of(key), what);
    }
    void warn(const ObjectView& view, std::string_view key, const std::string& what) {
        diagnostics_.warning(view.place_of(key), view.path_of(key), what);
    }

    void build_simulation() {
        const ObjectView view = root_.object("simulation");
        SimulationOptions& options = scene_.setup.options;
        options.time_step = view.number("time_step");
        options.duration = view.number("duration");
        options.integrator = integrator_from_name(view.text("integrator")).value_or(IntegratorKind::ballistic);
        options.seed = view.whole_number("seed");
        options.resting_speed = view.number("resting_speed");
        options.bounce_budget = static_cast<std::uint32_t>(view.whole_number("bounce_budget"));
        const double steps = options.duration / options.time_step;
        if (steps > kMostSteps) {
            error(view, "time_step",
                  fmt::format("{} s in {} s is {:.3g} steps, expected at most {}", options.time_step, options.duration,
                              steps, kMostSteps));
        }
    }

    void build_forces() {
        for_each("forces", [this](const ObjectView& view, std::size_t) {
            if (view.type() == "gravity") {
                scene_.setup.forces.push_back(make_gravity(view.vector("acceleration")));
            } else if (view.type() == "drag") {
                scene_.setup.forces.push_back(make_linear_drag(view.number("coefficient")));
            }
        });
    }

    void build_materials() {
        const JsonNode::Object* members = root_.node("materials").object();
        if (members == nullptr) return;
        const ObjectSpec& spec = *find_key(scene_spec(), nullptr, "materials")->content;
        for (const JsonMember& member : *members) {
            const ObjectView view(member.value, spec, path_of_key("materials", member.key));
            Material material;
            material.name = member.key;
            material.restitution = view.number("restitution");
            material.restitution_threshold = view.number("restitution_threshold");
            material.friction = view.number("friction");
            material.rolling_friction = view.number("rolling_friction");
            material.diffuse = view.number("diffuse");
            if (view.has("wall_temperature")) material.wall_temperature = view.number("wall_temperature");
            material.absorption = view.number("absorption");
            scene_.setup.materials.push_back(std::move(material));
        }
        material_used_.resize(members->size(), false);
    }

    // Index of a collider's material; colliders without one share a perfect one.
    std::uint32_t material_of(const ObjectView& view) {
        std::vector<Material>& materials = scene_.setup.materials;
        const bool by_name = view.has("material");
        const std::string name = view.text("material");
        for (std::size_t i = 0; i < (by_name ? material_used_.size() : 0); ++i) {
            if (materials[i].name != name) continue;
            material_used_[i] = true;
            return static_cast<std::uint32_t>(i);
        }
        if (by_name) {
            std::vector<std::string_view> names;
            for (std::size_t i = 0; i < material_used_.size(); ++i) names.push_back(materials[i].name);
            error(view, "material", unknown_name(name, "material", names));
            return 0;
        }
        if (materials.size() == material_used_.size()) materials.emplace_back();
        return static_cast<std::uint32_t>(materials.size() - 1);
    }

    static std::string unknown_name(const std::string& name, std::string_view kind,
                                    const std::vector<std::string_view>& known) {
        const std::string help = did_you_mean(nearest_names(name, known));
        if (!help.empty()) return fmt::format("there is no {} \"{}\"; {}", kind, printable(name, 60), help);
        return fmt::format("there is no {} \"{}\", {}", kind, printable(name, 60),
                           known.empty() ? "the scene has none" : "known: " + quoted_list(known));
    }

    // The name given, or one made from the type and the place in the list.
    std::string name_of(const ObjectView& view, std::size_t index, std::set<std::string>& taken,
                        std::string_view kind) {
        std::string name = view.text("name");
        if (name.empty()) name = fmt::format("{}{}", view.type().empty() ? kind : view.type(), index);
        if (!taken.insert(name).second) {
            error(view, "name",
                  fmt::format("the name \"{}\" is taken by another {}, expected one of its own", printable(name, 60),
                              kind));
        }
        return name;
    }

    void build_colliders() {
        std::set<std::string> taken;
        for_each("colliders", [&](const ObjectView& view, std::size_t index) {
            ColliderDescription collider;
            collider.name = name_of(view, index, taken, "collider");
            collider.material = material_of(view);
            collider.shape = shape_of_collider(view);
            scene_.setup.colliders.push_back(std::move(collider));
        });
    }

    decltype(ColliderDescription::shape) shape_of_collider(const ObjectView& view) {
        if (view.type() == "plane") return PlaneShape{view.vector("point"), view.vector("normal")};
        if (view.type() == "sphere") return BallShape{view.number("radius"), placement_of(view)};
        if (view.type() == "cylinder") {
            return CylinderShape{view.number("radius"), view.number("height"), placement_of(view)};
        }
        if (view.type() == "box") return CuboidShape{view.vector("size"), placement_of(view)};
        const std::string file = view.has("file") ? resolved(view, "file").string() : "";
        return MeshShape{load_mesh(view), placement_of(view), file, {}};
    }

    [[nodiscard]] std::filesystem::path resolved(const ObjectView& view, std::string_view key) const {
        return (folder_ / view.text(key)).lexically_normal();
    }

    // Null pointer after reporting.
    std::shared_ptr<const TriangleMesh> load_mesh(const ObjectView& view) {
        if (!view.has("file")) return nullptr;
        try {
            return meshes_.load(resolved(view, "file"));
        } catch (const InputError& problem) {
            error(view, "file", problem.what());
            return nullptr;
        }
    }

    static Placement placement_of(const ObjectView& view) {
        Placement placement;
        placement.position = view.vector("position");
        placement.scale = view.scale("scale");
        if (view.has("rotation")) {
            const ObjectView rotation = view.object("rotation");
            if (rotation.has("axis")) placement.rotation_axis = rotation.vector("axis");
            placement.rotation_degrees = rotation.number("degrees");
        }
        return placement;
    }

    void build_emitters() {
        std::set<std::string> taken;
        double births = 0.0;
        for_each("emitters", [&](const ObjectView& view, std::size_t index) {
            EmitterDescription emitter = schedule_of(view);
            emitter.name = name_of(view, index, taken, "emitter");
            emitter.shape = shape_of(view);
            emitter.direction = view.vector("direction");
            emitter.cone_degrees = view.number("cone");
            emitter.speed = view.pair("speed");
            emitter.velocity = view.vector("velocity");
            emitter.mass = view.pair("mass");
            emitter.radius = view.pair("particle_radius");
            if (view.has("lifetime")) emitter.lifetime = view.pair("lifetime");
            births += check_schedule(view, emitter);
            if (births > kMostParticles) {
                diagnostics_.error(view.place(), view.path(),
                                   fmt::format("with this emitter the scene gives birth to {:.3g} particles, expected "
                                               "at most {}",
                                               births, kMostParticles));
            }
            scene_.setup.emitters.push_back(std::move(emitter));
        });
    }

    static EmitterDescription schedule_of(const ObjectView& view) {
        EmitterDescription emitter;
        emitter.burst = view.whole_number("burst");
        emitter.rate = view.pair("rate");
        emitter.start = view.number("start");
        if (view.has("stop")) emitter.stop = view.number("stop");
        if (view.has("limit")) emitter.limit = view.whole_number("limit");
        return emitter;
    }

    // Reports contradictions; returns the most births there can be.
    double check_schedule(const ObjectView& view, const EmitterDescription& emitter) {
        const double duration = scene_.setup.options.duration;
        if (emitter.stop < emitter.start) {
            error(view, "stop",
                  fmt::format("found {} s, expected a time after start ({} s)", emitter.stop, emitter.start));
        }
        const double most_rate = emitter.rate.mean + emitter.rate.spread;
        const double time = std::max(0.0, std::min(duration, emitter.stop) - emitter.start);
        const double births = static_cast<double>(emitter.burst) + most_rate * time;
        const bool has_no_schedule = emitter.burst == 0 && most_rate == 0.0;
        if (has_no_schedule || emitter.limit == 0) {
            diagnostics_.warning(view.place(), view.path(), "emits nothing: it has neither a burst nor a rate");
        } else if (emitter.start >= duration) {
            warn(view, "start",
                 fmt::format("emits nothing: it begins at {} s, the scene ends at {} s", emitter.start, duration));
        }
        return std::min(births, static_cast<double>(emitter.limit));
    }

    EmitterShape shape_of(const ObjectView& view) {
        if (view.type() == "disk")
            return DiskShape{view.vector("center"), view.vector("normal"), view.number("radius")};
        if (view.type() == "box") return BoxShape{view.vector("center"), view.vector("size")};
        if (view.type() == "sphere") {
            return SphereShape{view.vector("center"), view.number("radius"), view.boolean("surface")};
        }
        if (view.type() == "mesh") return MeshSurfaceShape{surface_of(view)};
        return PointShape{view.type() == "point" ? view.vector("center") : Vec3{}};
    }

    // The mesh that an emitter stands on, in world coordinates. Null pointer after reporting.
    std::shared_ptr<const TriangleMesh> surface_of(const ObjectView& view) {
        if (view.has("collider") && view.has("file")) return nullptr;  // reported already
        const std::string_view key = view.has("collider") ? "collider" : "file";
        std::shared_ptr<const TriangleMesh> mesh;
        Placement placement;
        if (key == "file") {
            mesh = load_mesh(view);
            placement = placement_of(view);
        } else if (const MeshShape* collider = mesh_collider(view)) {
            mesh = collider->mesh;
            placement = collider->placement;
        }
        if (!mesh) return nullptr;
        auto world = std::make_shared<const TriangleMesh>(placed(*mesh, placement));
        if (!is_finite_mesh(*world)) {
            error(view, key, fmt::format("a placed vertex is not finite or beyond {} m", kLargestCoordinate));
        } else if (!(surface_area(*world) > 0.0)) {
            error(view, key, "the mesh has no area to emit from");
        }
        return world;
    }

    const MeshShape* mesh_collider(const ObjectView& view) {
        const std::string name = view.text("collider");
        std::vector<std::string_view> names;
        for (const ColliderDescription& collider : scene_.setup.colliders) {
            const auto* mesh = std::get_if<MeshShape>(&collider.shape);
            if (mesh != nullptr && collider.name == name) return mesh;
            if (mesh != nullptr) names.push_back(collider.name);
        }
        error(view, "collider", unknown_name(name, "mesh collider", names));
        return nullptr;
    }

    void build_particles() {
        if (root_.node("particles").object() != nullptr) {
            build_particle_table();
        } else {
            for_each("particles", [this](const ObjectView& view, std::size_t) {
                Particle particle;
                particle.position = view.vector("position");
                particle.velocity = view.vector("velocity");
                particle.mass = view.number("mass");
                particle.radius = view.number("radius");
                particle.spin = view.vector("spin");
                scene_.setup.particles.push_back(particle);
            });
        }
        warn_about_particles_outside();
    }

    void build_particle_table() {
        const ObjectView view(root_.node("particles"), particle_file_spec(), "particles");
        if (!view.has("file")) return;
        try {
            ParticleTable table = read_particle_table(resolved(view, "file"));
            for (const std::string& problem : table.errors) error(view, "file", problem);
            if (!table.unused_columns.empty()) {
                const std::vector<std::string_view> names(table.unused_columns.begin(), table.unused_columns.end());
                warn(view, "file",
                     fmt::format("the columns {} are not used: particles start with new ids and without a history",
                                 quoted_list(names)));
            }
            scene_.setup.particles = std::move(table.particles);
        } catch (const InputError& problem) {
            error(view, "file", problem.what());
        }
    }

    void build_bounds() {
        if (!root_.has("bounds")) return;
        const ObjectView view = root_.object("bounds");
        if (!view.has("lower") || !view.has("upper")) return;
        Box3 box;
        box.lower = view.vector("lower");
        box.upper = view.vector("upper");
        for (int axis = 0; axis < 3; ++axis) {
            if (box.lower[axis] < box.upper[axis]) continue;
            error(view, "upper",
                  fmt::format("found {} = {}, expected more than lower's {}", "xyz"[axis], box.upper[axis],
                              box.lower[axis]));
        }
        scene_.setup.bounds = box;
    }

    void warn_about_particles_outside() {
        if (!scene_.setup.bounds) return;
        const auto& particles = scene_.setup.particles;
        const auto outside = std::count_if(particles.begin(), particles.end(), [this](const Particle& p) {
            return !scene_.setup.bounds->contains(p.position);
        });
        if (outside == 0) return;
        warn(root_, "particles",
             fmt::format("{} of {} start outside the bounds and are retired at once", outside, particles.size()));
    }

    void build_output() {
        const ObjectView view = root_.object("output");
        scene_.output.format = view.text("format");
        scene_.output.every = view.whole_number("every");
        scene_.setup.options.record_contacts = view.boolean("contacts");
    }

    void build_camera() {
        if (!root_.has("camera")) return;
        const ObjectView view = root_.object("camera");
        CameraDescription camera;
        camera.position = view.vector("position");
        camera.target = view.vector("target");
        if (view.has("up")) camera.up = view.vector("up");
        camera.field_of_view_degrees = view.number("field_of_view");
        if (view.has("position") && view.has("target") && camera.position == camera.target) {
            error(view, "target", "the camera stands on its target, expected another point");
        } else if (camera.up &&
                   length(cross(normalized(*camera.up), normalized(camera.target - camera.position))) < 1e-6) {
            error(view, "up", "the camera looks along its up direction, expected another one");
        }
        scene_.camera = camera;
    }

    void warn_about_idle_parts() {
        const JsonNode::Object* members = root_.node("materials").object();
        for (std::size_t i = 0; i < material_used_.size(); ++i) {
            if (material_used_[i]) continue;
            diagnostics_.warning((*members)[i].key_place, path_of_key("materials", (*members)[i].key),
                                 "no collider uses this material");
        }
        if (scene_.setup.particles.empty() && scene_.setup.emitters.empty()) {
            diagnostics_.warning({}, "", "the scene has neither emitters nor particles, nothing will move");
        }
    }

    ObjectView root_;
    std::filesystem::path folder_;
    Diagnostics& diagnostics_;
    SceneDescription scene_;
    std::vector<bool> material_used_;
    MeshLibrary meshes_;
};

}  // namespace

SceneDescription build_scene(const JsonNode& root, const std::filesystem::path& folder, Diagnostics& diagnostics) {
    return SceneBuilder(root, folder, diagnostics).build();
}

}  // namespace ricochet::detail
