#include "ricochet/render/preview.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "ricochet/geometry/acceleration/embree.h"
#include "ricochet/render/drawn_mesh.h"
#include "ricochet/render/shape_copies.h"

namespace ricochet {

namespace {

constexpr double kCreaseDegrees = 40.0;
constexpr double kClothCreaseDegrees = 180.0;  // its folds are round

// Geometries of the scene of what moves.
enum MovingGeometry : unsigned { kSpheres, kLines, kCloth, kCopies };

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

// Gives a finished geometry to the scene under the given number.
void attach(RTCScene scene, RTCGeometry geometry, unsigned id) {
    rtcSetGeometryMask(geometry, 0xffffffffU);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

RTCRay embree_ray(const PreviewRay& ray, const Vec3& origin) {
    const Vec3 from = ray.origin - origin;
    RTCRay out{};
    out.org_x = static_cast<float>(from.x);
    out.org_y = static_cast<float>(from.y);
    out.org_z = static_cast<float>(from.z);
    out.dir_x = static_cast<float>(ray.direction.x);
    out.dir_y = static_cast<float>(ray.direction.y);
    out.dir_z = static_cast<float>(ray.direction.z);
    out.tfar = static_cast<float>(ray.reach);
    out.time = static_cast<float>(ray.time);
    out.mask = 0xffffffffU;
    return out;
}

RTCRayHit embree_query(const PreviewRay& ray, const Vec3& origin) {
    RTCRayHit query{};
    query.ray = embree_ray(ray, origin);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return query;
}

// Meshes that are traced together; geometry k of the scene is mesh k.
struct MeshGroup {
    embree::Scene scene;
    std::vector<DrawnMesh> meshes;

    [[nodiscard]] bool empty() const { return meshes.empty(); }
};

}  // namespace

struct Preview::Impl {
    embree::Device device = embree::make_device();
    MeshGroup solid, glass;
    MeshGroup moving_solid, moving_glass;
    embree::Scene moving_scene;
    std::vector<PreviewPlane> planes;
    std::vector<Vec3> sphere_colors;     // in the order of the drawn spheres
    std::vector<Vec3> sphere_emissions;  // the same, or empty
    std::vector<Vec3> line_colors;       // in the order of the drawn lines
    std::vector<Vec3> line_emissions;    // the same, or empty
    DrawnMesh cloth;
    ShapeCopies copies;
    bool has_moving = false;
    Vec3 origin;

    void add_spheres(const PreviewSpheres& spheres);
    void add_lines(const PreviewLines& lines);
    void add_cloth(PreviewMesh source);
    void add_copies(const PreviewCopies& source);

    void add_mesh(MeshGroup& group, PreviewMesh mesh) const;
    void fill(MeshGroup& solid_ones, MeshGroup& glass_ones, std::vector<PreviewMesh> meshes) const;
    [[nodiscard]] std::optional<PreviewHit> trace(const MeshGroup& group, const PreviewRay& ray, RTCRayHit& hit) const;
    [[nodiscard]] static PreviewHit mesh_hit(const DrawnMesh& mesh, const RTCRayHit& hit, const PreviewRay& ray);
    [[nodiscard]] PreviewHit moving_hit(const RTCRayHit& hit, const CopyHit& copy_hit, const PreviewRay& ray) const;
    void trace_planes(const PreviewRay& ray, std::optional<PreviewHit>& nearest) const;
};

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

std::optional<PreviewHit> Preview::Impl::trace(const MeshGroup& group, const PreviewRay& ray, RTCRayHit& hit) const {
    if (group.empty()) return std::nullopt;
    embree::QueryContext context;
    embree::init_context(context, nullptr);
    embree::intersect1(group.scene.get(), context, hit);
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return mesh_hit(group.meshes[hit.hit.geomID], hit, ray);
}

PreviewHit Preview::Impl::mesh_hit(const DrawnMesh& mesh, const RTCRayHit& hit, const PreviewRay& ray) {
    PreviewHit out;
    out.distance = hit.ray.tfar;
    out.point = ray.origin + out.distance * ray.direction;
    out.face = towards(normalized(Vec3{hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z}), ray.direction);
    const MeshPoint seen = point_of(mesh, hit.hit.primID, hit.hit.u, hit.hit.v, out.face);
    out.normal = seen.normal;
    out.lift = seen.lift;
    out.roughness = mesh.source.roughness;
    out.time = ray.time;
    out.color = seen.color;
    return out;
}

PreviewHit Preview::Impl::moving_hit(const RTCRayHit& hit, const CopyHit& copy_hit, const PreviewRay& ray) const {
    if (hit.hit.geomID == kCopies) return copies.hit(hit, copy_hit, ray);
    PreviewHit out;
    if (hit.hit.geomID == kCloth) {
        out = mesh_hit(cloth, hit, ray);
        out.kind = PreviewHit::Kind::cloth;
        return out;
    }
    const bool is_line = hit.hit.geomID == kLines;
    out.kind = is_line ? PreviewHit::Kind::line : PreviewHit::Kind::sphere;
    out.distance = hit.ray.tfar;
    out.point = ray.origin + out.distance * ray.direction;
    out.face = towards(normalized(Vec3{hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z}), ray.direction);
    out.normal = out.face;
    out.time = ray.time;
    out.roughness = is_line ? 1.0 : kSphereRoughness;
    out.color = is_line ? line_colors[hit.hit.primID] : sphere_colors[hit.hit.primID];
    const std::vector<Vec3>& emissions = is_line ? line_emissions : sphere_emissions;
    if (!emissions.empty()) out.emission = emissions[hit.hit.primID];
    return out;
}

void Preview::Impl::trace_planes(const PreviewRay& ray, std::optional<PreviewHit>& nearest) const {
    for (const PreviewPlane& plane : planes) {
        const double slope = dot(plane.normal, ray.direction);
        const double distance = dot(plane.point - ray.origin, plane.normal) / slope;
        if (slope >= 0.0 || !(distance > 0.0) || distance > kLargestDrawn) continue;
        if (nearest && nearest->distance <= distance) continue;
        nearest = PreviewHit{distance,     ray.origin + distance * ray.direction,
                             plane.normal, plane.normal,
                             plane.color,  PreviewHit::Kind::plane};
        nearest->roughness = plane.roughness;
        nearest->time = ray.time;
    }
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

void Preview::Impl::add_spheres(const PreviewSpheres& spheres) {
    std::vector<std::size_t> drawn;
    for (std::size_t i = 0; i < spheres.centers.size(); ++i) {
        const bool on_the_way =
            spheres.ways.empty() || std::all_of(spheres.ways[i].begin(), spheres.ways[i].end(), drawable);
        if (on_the_way && drawable(spheres.centers[i]) && spheres.radii[i] > 0.0 && spheres.radii[i] < kLargestDrawn)
            drawn.push_back(i);
    }
    sphere_colors.clear();
    sphere_emissions.clear();
    if (drawn.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
    const std::size_t steps = spheres.ways.empty() ? 1 : spheres.ways[drawn[0]].size();
    rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(steps));
    for (std::size_t step = 0; step < steps; ++step) {
        auto* buffer =
            static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(step),
                                                        RTC_FORMAT_FLOAT4, 4 * sizeof(float), drawn.size()));
        embree::check_device(device.get(), "storing the particles for the picture");
        for (std::size_t k = 0; k < drawn.size(); ++k) {
            const std::size_t i = drawn[k];
            store(buffer + 4 * k, (spheres.ways.empty() ? spheres.centers[i] : spheres.ways[i][step]) - origin);
            buffer[4 * k + 3] = static_cast<float>(spheres.radii[i]);
        }
    }
    for (const std::size_t i : drawn) {
        sphere_colors.push_back(spheres.colors[i]);
        if (!spheres.emissions.empty()) sphere_emissions.push_back(spheres.emissions[i]);
    }
    attach(moving_scene.get(), geometry, kSpheres);
    has_moving = true;
}

// Every line has two points of its own, since lines that share one may differ in radius.
void Preview::Impl::add_lines(const PreviewLines& lines) {
    std::vector<std::size_t> drawn;
    for (std::size_t i = 0; i < lines.ends.size(); ++i) {
        const auto [a, b] = lines.ends[i];
        if (drawable(lines.points[a]) && drawable(lines.points[b]) && lines.radii[i] > 0.0 &&
            lines.radii[i] < kLargestDrawn)
            drawn.push_back(i);
    }
    line_colors.clear();
    line_emissions.clear();
    if (drawn.empty()) return;
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
        line_colors.push_back(lines.colors[drawn[k]]);
        if (!lines.emissions.empty()) line_emissions.push_back(lines.emissions[drawn[k]]);
    }
    attach(moving_scene.get(), geometry, kLines);
    has_moving = true;
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

void Preview::set_moving(PreviewMoving moving) {
    impl_->moving_scene = new_scene(impl_->device.get());
    impl_->has_moving = false;
    impl_->add_spheres(moving.spheres);
    impl_->add_lines(moving.lines);
    impl_->add_cloth(std::move(moving.cloth));
    impl_->add_copies(moving.copies);
    impl_->fill(impl_->moving_solid, impl_->moving_glass, std::move(moving.meshes));
    if (!impl_->has_moving) return;
    rtcCommitScene(impl_->moving_scene.get());
    embree::check_device(impl_->device.get(), "building the picture's particles");
}

std::optional<PreviewHit> Preview::trace(const PreviewRay& ray) const {
    if (!drawable(ray.origin - impl_->origin) || !drawable(ray.direction)) return std::nullopt;
    RTCRayHit hit = embree_query(ray, impl_->origin);
    std::optional<PreviewHit> nearest = impl_->trace(impl_->solid, ray, hit);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    if (const auto nearer = impl_->trace(impl_->moving_solid, ray, hit)) nearest = nearer;
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    CopyHit copy_hit;
    if (impl_->has_moving) {
        embree::QueryContext context;
        embree::init_context(context, &copy_hit);
        embree::intersect1(impl_->moving_scene.get(), context, hit);
    }
    if (hit.hit.geomID != RTC_INVALID_GEOMETRY_ID) nearest = impl_->moving_hit(hit, copy_hit, ray);
    impl_->trace_planes(ray, nearest);
    return nearest;
}

std::optional<PreviewHit> Preview::trace_glass(const PreviewRay& ray) const {
    if (!drawable(ray.origin - impl_->origin) || !drawable(ray.direction)) return std::nullopt;
    RTCRayHit hit = embree_query(ray, impl_->origin);
    const std::optional<PreviewHit> nearest = impl_->trace(impl_->glass, ray, hit);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    const std::optional<PreviewHit> nearer = impl_->trace(impl_->moving_glass, ray, hit);
    return nearer ? nearer : nearest;
}

bool Preview::occluded(const PreviewRay& ray) const {
    if (!drawable(ray.origin - impl_->origin) || !drawable(ray.direction)) return false;
    embree::QueryContext context;
    embree::init_context(context, nullptr);
    RTCRay shadow = embree_ray(ray, impl_->origin);
    if (!impl_->solid.empty()) embree::occluded1(impl_->solid.scene.get(), context, shadow);
    if (shadow.tfar >= 0.0F && !impl_->moving_solid.empty()) {
        embree::occluded1(impl_->moving_solid.scene.get(), context, shadow);
    }
    if (shadow.tfar >= 0.0F && impl_->has_moving) embree::occluded1(impl_->moving_scene.get(), context, shadow);
    return shadow.tfar < 0.0F;
}

const Vec3& Preview::origin() const { return impl_->origin; }

}  // namespace ricochet
