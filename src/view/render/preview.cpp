#include "view/render/preview.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "view/render/preview_impl.h"
#include "view/render/tone.h"

namespace ricochet {

namespace {

constexpr double kCreaseDegrees = 40.0;
constexpr double kClothCreaseDegrees = 180.0;  // no creases, because folds of cloth are round

void store(float* target, const Vec3& p) {
    target[0] = static_cast<float>(p.x);
    target[1] = static_cast<float>(p.y);
    target[2] = static_cast<float>(p.z);
}

embree::Scene new_scene(RTCDevice device) {
    embree::Scene scene(rtcNewScene(device));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    return scene;
}

// Returns true if a line emits visible light. Linear light below 3e-4 is displayed as black.
bool shines(const PreviewLines& lines, std::size_t i) {
    constexpr double kDarkest = 1e-3;
    return !lines.emissions.empty() && luminance(lines.emissions[i]) > kDarkest;
}

// Returns the light of a glowing line. A convex body with surface area A and brightness L has the same mean intensity
// as a sphere with the same area, L A / (4 pi).
GlowingLine glowing_line(const PreviewLines& lines, std::size_t i) {
    const auto [a, b] = lines.ends[i];
    const double radius = lines.radii[i];
    const double size = lines.parts.empty() ? radius * radius + 0.5 * radius * length(lines.points[b] - lines.points[a])
                                            : lines.parts[i] * radius * radius;
    return {lines.points[a], lines.points[b], radius, size * lines.emissions[i]};
}

// Commits a geometry, attaches it to the scene under the given number, and releases it.
void attach(RTCScene scene, RTCGeometry geometry, unsigned id) {
    rtcSetGeometryMask(geometry, 0xffffffffU);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

}  // namespace

void Preview::Impl::add_mesh(MeshGroup& group, PreviewMesh source) const {
    DrawnMesh mesh = drawn_mesh(std::move(source), kCreaseDegrees);
    attach(group.scene.get(), triangles_of(device.get(), mesh.source.mesh, origin),
           static_cast<unsigned>(group.meshes.size()));
    group.meshes.push_back(std::move(mesh));
}

void Preview::Impl::fill(MeshGroup& solid_ones, MeshGroup& glass_ones, std::vector<PreviewMesh> meshes) const {
    for (MeshGroup* group : {&solid_ones, &glass_ones}) {
        group->meshes.clear();
        group->scene = new_scene(device.get());
    }
    for (PreviewMesh& mesh : meshes) add_mesh(mesh.glass ? glass_ones : solid_ones, std::move(mesh));
    rtcCommitScene(solid_ones.scene.get());
    rtcCommitScene(glass_ones.scene.get());
    embree::check_device(device.get(), "building the picture's meshes");
}

Preview::Preview(std::vector<PreviewMesh> meshes, std::vector<PreviewPlane> planes, const Vec3& origin)
    : impl_(std::make_unique<Impl>()) {
    impl_->planes = std::move(planes);
    impl_->origin = origin;
    impl_->fill(impl_->solid, impl_->glass, std::move(meshes));
}

Preview::~Preview() = default;
Preview::Preview(Preview&&) noexcept = default;
Preview& Preview::operator=(Preview&&) noexcept = default;

void Preview::Impl::take_spheres(PreviewSpheres&& source) {
    spheres = {};
    sphere_paths.clear();
    has_sphere_rays = false;
    const bool moves = !source.shutter_paths.empty();
    for (std::size_t i = 0; i < source.centers.size(); ++i) {
        const bool on_the_way =
            !moves || std::all_of(source.shutter_paths[i].begin(), source.shutter_paths[i].end(), drawable);
        const bool has_size = source.radii[i] > 0.0 && source.radii[i] < kLargestDrawn;
        if (!on_the_way || !drawable(source.centers[i]) || !has_size) continue;
        spheres.centers.push_back(moves ? source.shutter_paths[i].back() : source.centers[i]);
        spheres.radii.push_back(source.radii[i]);
        spheres.colors.push_back(source.colors[i]);
        if (!source.emissions.empty()) spheres.emissions.push_back(source.emissions[i]);
        if (moves) sphere_paths.push_back(std::move(source.shutter_paths[i]));
    }
}

void Preview::Impl::build_spheres() {
    has_sphere_rays = !spheres.centers.empty();
    if (!has_sphere_rays) return;
    sphere_scene = new_scene(device.get());
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
    const std::size_t count = spheres.centers.size();
    const std::size_t steps = sphere_paths.empty() ? 1 : sphere_paths[0].size();
    rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(steps));
    for (std::size_t step = 0; step < steps; ++step) {
        auto* buffer =
            static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(step),
                                                        RTC_FORMAT_FLOAT4, 4 * sizeof(float), count));
        embree::check_device(device.get(), "storing the particles for the picture");
        for (std::size_t i = 0; i < count; ++i) {
            store(buffer + 4 * i, (sphere_paths.empty() ? spheres.centers[i] : sphere_paths[i][step]) - origin);
            buffer[4 * i + 3] = static_cast<float>(spheres.radii[i]);
        }
    }
    attach(sphere_scene.get(), geometry, 0);
    rtcCommitScene(sphere_scene.get());
    embree::check_device(device.get(), "building the picture's particles");
}

// Glowing lines have their own scene, so that rays for the light on surfaces can leave them out.
void Preview::Impl::add_lines(const PreviewLines& lines) {
    std::vector<std::size_t> dark, bright;
    glowing_lines.clear();
    for (std::size_t i = 0; i < lines.ends.size(); ++i) {
        const auto [a, b] = lines.ends[i];
        if (!drawable(lines.points[a]) || !drawable(lines.points[b]) || !(lines.radii[i] > 0.0) ||
            lines.radii[i] >= kLargestDrawn) {
            continue;
        }
        const bool glows = shines(lines, i);
        (glows ? bright : dark).push_back(i);
        if (glows) glowing_lines.push_back(glowing_line(lines, i));
    }
    dark_lines = bright_lines = {};
    if (!dark.empty()) {
        dark_lines = attach_lines(lines, dark, moving_scene.get(), kLines);
        has_moving = true;
    }
    if (bright.empty()) {
        glow_scene = {};
        return;
    }
    glow_scene = new_scene(device.get());
    bright_lines = attach_lines(lines, bright, glow_scene.get(), kGlowingLines);
    rtcCommitScene(glow_scene.get());
}

// The geometry stores two points per line, because lines that share a point can differ in radius.
LineGroup Preview::Impl::attach_lines(const PreviewLines& lines, const std::vector<std::size_t>& drawn, RTCScene scene,
                                      MovingGeometry id) const {
    LineGroup group;
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                                               4 * sizeof(float), 2 * drawn.size()));
    auto* firsts = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(std::uint32_t), drawn.size()));
    embree::check_device(device.get(), "storing the springs for the picture");
    for (std::size_t k = 0; k < drawn.size(); ++k) {
        for (std::size_t end = 0; end < 2; ++end) {
            float* point = points + 4 * (2 * k + end);
            store(point, lines.points[lines.ends[drawn[k]][end]] - origin);
            point[3] = static_cast<float>(lines.radii[drawn[k]]);
        }
        firsts[k] = static_cast<std::uint32_t>(2 * k);
        group.colors.push_back(lines.colors[drawn[k]]);
        if (!lines.emissions.empty()) group.emissions.push_back(lines.emissions[drawn[k]]);
    }
    attach(scene, geometry, id);
    return group;
}

void Preview::Impl::add_cloth(PreviewMesh source) {
    cloth = {};
    if (source.mesh.triangles.empty()) return;
    cloth = drawn_mesh(std::move(source), kClothCreaseDegrees);
    attach(moving_scene.get(), triangles_of(device.get(), cloth.source.mesh, origin), kCloth);
    has_moving = true;
}

void Preview::Impl::add_copies(const PreviewCopies& source) {
    RTCGeometry geometry = copies.make_geometry(device.get(), source, origin);
    if (geometry == nullptr) return;
    attach(moving_scene.get(), geometry, kCopies);
    has_moving = true;
}

void Preview::set_shapes(std::vector<TriangleMesh> shapes) {
    impl_->copies.set_shapes(impl_->device.get(), std::move(shapes));
}

void Preview::set_spheres(const PreviewSpheres& spheres) { set_moving({spheres, {}, {}}); }

void Preview::set_moving(PreviewMoving moving, SphereRays spheres) {
    impl_->moving_scene = new_scene(impl_->device.get());
    impl_->has_moving = false;
    impl_->take_spheres(std::move(moving.spheres));
    if (spheres == SphereRays::traced) impl_->build_spheres();
    impl_->add_lines(moving.lines);
    impl_->add_cloth(std::move(moving.cloth));
    impl_->add_copies(moving.copies);
    impl_->fill(impl_->moving_solid, impl_->moving_glass, std::move(moving.meshes));
    if (impl_->has_moving) rtcCommitScene(impl_->moving_scene.get());
    embree::check_device(impl_->device.get(), "building the picture's particles");
}

const Vec3& Preview::origin() const { return impl_->origin; }

void Preview::prepare_sphere_rays() const {
    if (!impl_->has_sphere_rays) impl_->build_spheres();
}

const DrawnSpheres& Preview::spheres() const { return impl_->spheres; }

const std::vector<GlowingLine>& Preview::glowing_lines() const { return impl_->glowing_lines; }

bool Preview::spheres_move() const { return !impl_->sphere_paths.empty(); }

}  // namespace ricochet
