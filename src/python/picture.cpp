// ricochet._core.Simulation.render: a picture of the current state of a simulation, as an array.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "python/arrays.h"
#include "python/ctrl_c.h"
#include "python/made_objects.h"
#include "python/simulation_handle.h"
#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "view/render/color_map.h"
#include "view/render/picture.h"

namespace ricochet::python {
namespace {

constexpr Vec3 kColliderColor{0.21, 0.20, 0.19};
constexpr Vec3 kPlaneColor{0.30, 0.30, 0.29};
constexpr double kParticleAlbedo = 0.8;  // factor on colours of the colour map, so that sunlit colours are not
                                         // overexposed
/// Drawn radius of particles without a radius, as a fraction of the scene's diagonal.
constexpr double kPointSize = 0.004;

/// Returns the value. Throws InputError if the value is out of range.
int within(int value, int lowest, int highest, const char* name) {
    if (value >= lowest && value <= highest) return value;
    throw InputError(fmt::format("{}: found {}, expected {} to {}", name, value, lowest, highest));
}

/// Visible content of a simulation.
struct Shown {
    std::vector<PreviewMesh> meshes;
    std::vector<PreviewPlane> planes;
    PreviewSpheres spheres;
    ViewSubject subject;
};

void add_colliders(const Simulation& simulation, Shown& shown) {
    for (std::size_t i = 0; i < simulation.colliders().size(); ++i) {
        const MovingPose pose = simulation.collider_pose(i, simulation.time());
        if (const auto* plane = std::get_if<PlaneShape>(&simulation.colliders()[i].shape)) {
            const Vec3 foot = pose.point(plane->point);
            shown.planes.push_back(
                {foot, normalized(pose.point(plane->point + normalized(plane->normal)) - foot), kPlaneColor});
            continue;
        }
        std::optional<TriangleMesh> mesh = simulation.collider_mesh(i);
        if (!mesh) continue;
        for (Vec3& vertex : mesh->vertices) vertex = pose.point(vertex);
        shown.subject.colliders.insert(shown.subject.colliders.end(), mesh->vertices.begin(), mesh->vertices.end());
        shown.meshes.push_back({std::move(*mesh), kColliderColor, {}, false});
    }
}

void draw_particles(const Simulation& simulation, Shown& shown) {
    const Particles& particles = simulation.particles();
    Box3 box;
    std::vector<double> speeds;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (is_finite(particles.position[i])) box.include(particles.position[i]);
        speeds.push_back(length(particles.velocity[i]));
    }
    for (const Vec3& vertex : shown.subject.colliders) box.include(vertex);
    const double point_radius = std::max(kPointSize * box.diagonal(), 1e-6);
    const double fastest = std::max(robust_range(speeds).high, std::numeric_limits<double>::min());
    shown.subject.particles = particles.position;
    shown.spheres.centers = particles.position;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        shown.spheres.radii.push_back(particles.radius[i] > 0.0 ? particles.radius[i] : point_radius);
        shown.spheres.colors.push_back(kParticleAlbedo * map_color(ColorMap::plasma, speeds[i] / fastest));
    }
}

Vec3 vector_of(const py::handle& object, const char* name) {
    const Doubles list = numbers(object, name, 0);
    require_same_length(static_cast<std::size_t>(list.size()), 3, name);
    const Vec3 v{list.data()[0], list.data()[1], list.data()[2]};
    if (is_finite(v)) return v;
    throw InputError(fmt::format("{}: found [{}, {}, {}], expected finite numbers", name, v.x, v.y, v.z));
}

/// Returns the camera. The caller's values have the highest priority. The scene's camera comes next, then a camera that
/// shows everything.
Camera camera_of(const SimulationHandle& handle, const ViewSubject& subject, double aspect, const py::object& position,
                 const py::object& target, double field_of_view) {
    Camera camera = automatic_camera(subject, handle.up(), aspect);
    if (const auto& own = handle.scene().camera) {
        camera = {own->position, own->target, own->up ? normalized(*own->up) : handle.up(), own->field_of_view_degrees};
    }
    if (!position.is_none()) camera.position = vector_of(position, "position");
    if (!target.is_none()) camera.target = vector_of(target, "target");
    if (field_of_view != 0.0) camera.fov_degrees = field_of_view;
    if (!(camera.fov_degrees >= 1.0 && camera.fov_degrees <= 170.0)) {
        throw InputError(fmt::format("field_of_view: found {}, expected 1 to 170 degrees", camera.fov_degrees));
    }
    if (camera.position == camera.target) throw InputError("position: found the target, expected another place");
    return camera;
}

py::array render(const SimulationHandle& handle, int width, int height, int samples, const py::object& position,
                 const py::object& target, double field_of_view) {
    PictureOptions options;
    options.width = within(width, 1, 16384, "width");
    options.height = within(height, 1, 16384, "height");
    options.samples = within(samples, 1, 4096, "samples");
    require_memory(picture_bytes(width, height, false), fmt::format("render: a picture of {} x {}", width, height));
    Image image = handle.read([&](const Simulation& simulation) {
        Shown shown;
        add_colliders(simulation, shown);
        draw_particles(simulation, shown);
        const Camera camera =
            camera_of(handle, shown.subject, static_cast<double>(width) / height, position, target, field_of_view);
        return CtrlC().run(false, [&] {
            Preview preview(std::move(shown.meshes), std::move(shown.planes), camera.target);
            preview.set_spheres(shown.spheres);
            return render_picture(preview, camera, options);
        });
    });
    return given(std::move(image.rgb)).attr("reshape")(height, width, 3);
}

}  // namespace

void bind_picture(py::class_<SimulationHandle>& type) {
    using py::arg;
    type.def(
        "render", &render, arg("width") = 960, arg("height") = 540, arg("samples") = 16, arg("position") = py::none(),
        arg("target") = py::none(), arg("field_of_view") = 0.0,
        "Returns a picture of the current particles, coloured by their speed, and colliders: red, green and blue from "
        "0 to 255, of shape (height, width, 3). The camera is the scene's, or one that shows everything. position, "
        "target and field_of_view (degrees) override it.");
}

}  // namespace ricochet::python
