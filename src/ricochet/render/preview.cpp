#include "ricochet/render/preview.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "ricochet/geometry/acceleration/embree.h"

namespace ricochet {

namespace {

// Debian builds Embree with assertions: rays beyond 1.8e18 or not finite end the process.
constexpr double kLargestCoordinate = 1e15;
constexpr double kCreaseDegrees = 40.0;
constexpr double kClothCreaseDegrees = 180.0;  // its folds are round

// Geometries of the scene of what moves.
enum MovingGeometry : unsigned { kSpheres, kLines, kCloth };

bool drawable(const Vec3& p) { return is_finite(p) && max_abs(p) <= kLargestCoordinate; }

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

Vec3 towards(const Vec3& normal, const Vec3& direction) { return dot(normal, direction) > 0.0 ? -normal : normal; }

// A mesh and what its shading needs.
struct DrawnMesh {
    PreviewMesh source;
    std::vector<std::array<Vec3, 3>> normals;
};

void make_drawable(TriangleMesh& mesh) {
    std::vector<bool> bad(mesh.vertices.size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) bad[v] = !drawable(mesh.vertices[v]);
    for (Triangle& triangle : mesh.triangles) {
        // A triangle with a hopeless corner shrinks to nothing; its number stays taken.
        if (bad[triangle[0]] || bad[triangle[1]] || bad[triangle[2]]) triangle = {0, 0, 0};
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (bad[v]) mesh.vertices[v] = {};
    }
}

// From a point of a triangle to the smooth surface that its corners' normals stand for, along which shadows fall: rays
// that begin on the flat triangle would draw the edge of its own shadow. Zero where the surface is hollow.
// Method: J. Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021, chapter 4.
Vec3 lift_to_smooth(const DrawnMesh& mesh, unsigned triangle, const std::array<double, 3>& weights,
                    const Vec3& seen_normal) {
    const auto& normals = mesh.normals[triangle];
    const Triangle& corners = mesh.source.mesh.triangles[triangle];
    if (normals[0] == normals[1] && normals[1] == normals[2]) return {};
    Vec3 point;
    for (std::size_t k = 0; k < 3; ++k) point += weights[k] * mesh.source.mesh.vertices[corners[k]];
    Vec3 lift;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 normal = towards(normals[k], -seen_normal);
        const double below = dot(point - mesh.source.mesh.vertices[corners[k]], normal);
        if (below < 0.0) lift -= weights[k] * below * normal;
    }
    return lift;
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
    DrawnMesh cloth;
    bool has_moving = false;
    Vec3 origin;

    [[nodiscard]] RTCGeometry triangles_of(const TriangleMesh& mesh) const;
    void add_spheres(const PreviewSpheres& spheres);
    void add_lines(const PreviewLines& lines);
    void add_cloth(PreviewMesh source);

    void add_mesh(MeshGroup& group, PreviewMesh mesh) const;
    void fill(MeshGroup& solid_ones, MeshGroup& glass_ones, std::vector<PreviewMesh> meshes) const;
    [[nodiscard]] std::optional<PreviewHit> trace(const MeshGroup& group, const PreviewRay& ray, RTCRayHit& hit) const;
    [[nodiscard]] static PreviewHit mesh_hit(const DrawnMesh& mesh, const RTCRayHit& hit, const PreviewRay& ray);
    [[nodiscard]] PreviewHit moving_hit(const RTCRayHit& hit, const PreviewRay& ray) const;
    void trace_planes(const PreviewRay& ray, std::optional<PreviewHit>& nearest) const;
};

RTCGeometry Preview::Impl::triangles_of(const TriangleMesh& mesh) const {
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.vertices.size()));
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), mesh.triangles.size()));
    embree::check_device(device.get(), "storing a mesh for the picture");
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) store(vertices + 3 * v, mesh.vertices[v] - origin);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::copy(mesh.triangles[t].begin(), mesh.triangles[t].end(), corners + 3 * t);
    }
    return geometry;
}

void Preview::Impl::add_mesh(MeshGroup& group, PreviewMesh source) const {
    make_drawable(source.mesh);
    attach(group.scene.get(), triangles_of(source.mesh), static_cast<unsigned>(group.meshes.size()));
    auto normals = corner_normals(source.mesh, kCreaseDegrees);
    group.meshes.push_back({std::move(source), std::move(normals)});
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
    const auto& corner = mesh.normals[hit.hit.primID];
    const double u = hit.hit.u;
    const double v = hit.hit.v;
    PreviewHit out;
    out.distance = hit.ray.tfar;
    out.point = ray.origin + out.distance * ray.direction;
    out.face = towards(normalized(Vec3{hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z}), ray.direction);
    const Vec3 smooth = (1.0 - u - v) * corner[0] + u * corner[1] + v * corner[2];
    out.normal = length(smooth) > 1e-6 ? normalized(smooth) : out.face;
    if (dot(out.normal, out.face) < 0.0) out.normal = -out.normal;
    out.lift = lift_to_smooth(mesh, hit.hit.primID, {1.0 - u - v, u, v}, out.normal);
    out.roughness = mesh.source.roughness;
    out.time = ray.time;
    out.color = mesh.source.triangle_colors.empty() ? mesh.source.color : mesh.source.triangle_colors[hit.hit.primID];
    return out;
}

PreviewHit Preview::Impl::moving_hit(const RTCRayHit& hit, const PreviewRay& ray) const {
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
    if (!is_line && !sphere_emissions.empty()) out.emission = sphere_emissions[hit.hit.primID];
    return out;
}

void Preview::Impl::trace_planes(const PreviewRay& ray, std::optional<PreviewHit>& nearest) const {
    for (const PreviewPlane& plane : planes) {
        const double slope = dot(plane.normal, ray.direction);
        const double distance = dot(plane.point - ray.origin, plane.normal) / slope;
        if (slope >= 0.0 || !(distance > 0.0) || distance > kLargestCoordinate) continue;
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
        if (on_the_way && drawable(spheres.centers[i]) && spheres.radii[i] > 0.0 &&
            spheres.radii[i] < kLargestCoordinate)
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
            lines.radii[i] < kLargestCoordinate)
            drawn.push_back(i);
    }
    line_colors.clear();
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
    }
    attach(moving_scene.get(), geometry, kLines);
    has_moving = true;
}

void Preview::Impl::add_cloth(PreviewMesh source) {
    cloth = {};
    if (source.mesh.triangles.empty()) return;
    make_drawable(source.mesh);
    attach(moving_scene.get(), triangles_of(source.mesh), kCloth);
    auto normals = corner_normals(source.mesh, kClothCreaseDegrees);
    cloth = {std::move(source), std::move(normals)};
    has_moving = true;
}

void Preview::set_spheres(const PreviewSpheres& spheres) { set_moving({spheres, {}, {}}); }

void Preview::set_moving(PreviewMoving moving) {
    impl_->moving_scene = new_scene(impl_->device.get());
    impl_->has_moving = false;
    impl_->add_spheres(moving.spheres);
    impl_->add_lines(moving.lines);
    impl_->add_cloth(std::move(moving.cloth));
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
    if (impl_->has_moving) {
        embree::QueryContext context;
        embree::init_context(context, nullptr);
        embree::intersect1(impl_->moving_scene.get(), context, hit);
    }
    if (hit.hit.geomID != RTC_INVALID_GEOMETRY_ID) nearest = impl_->moving_hit(hit, ray);
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
