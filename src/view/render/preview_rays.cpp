// Ray tracing of Preview: single rays, and packets of coherent rays.
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "view/render/preview.h"
#include "view/render/preview_impl.h"

namespace ricochet {
namespace {

/// Traces eight rays at once. A ray is traced if its entry of `valid` is -1, and skipped if its entry is 0. `valid`
/// must be aligned to 32 bytes. Processors with AVX trace eight rays in parallel. Other processors trace the rays one
/// by one.
void intersect8(const int* valid, RTCScene scene, embree::QueryContext& context, RTCRayHit8& ray_hits) {
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context.base;
    rtcIntersect8(valid, scene, &ray_hits, &arguments);
#else
    rtcIntersect8(valid, scene, &context.base, &ray_hits);
#endif
}

/// Traces eight shadow rays at once. See occluded1() and intersect8().
void occluded8(const int* valid, RTCScene scene, embree::QueryContext& context, RTCRay8& rays) {
#if RTC_VERSION_MAJOR >= 4
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context.base;
    rtcOccluded8(valid, scene, &rays, &arguments);
#else
    rtcOccluded8(valid, scene, &context.base, &rays);
#endif
}

/// Traces a shadow ray. Afterwards ray.tfar is -infinity if the ray is occluded.
void occluded1(RTCScene scene, embree::QueryContext& context, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context.base;
    rtcOccluded1(scene, &ray, &arguments);
#else
    rtcOccluded1(scene, &context.base, &ray);
#endif
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

RayFind new_find(const PreviewRay& ray, const Vec3& origin) {
    RayFind find;
    find.query = {};
    find.query.ray = embree_ray(ray, origin);
    find.query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return find;
}

// If the last query found a hit, records the scene to which the hit belongs. Resets the hit for the next query.
void note_source(RayFind& find, const MeshGroup* group, bool is_sphere) {
    if (find.query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
    find.geometry = find.query.hit.geomID;
    find.group = group;
    find.is_sphere = is_sphere;
    find.query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
}

// Writes a ray to a lane of Embree's packet. The ray's id is the lane number, because ShapeCopies stores hits by the
// ray's id.
template <class Rays>
void set_lane(Rays& rays, std::size_t lane, const PreviewRay& ray, const Vec3& origin) {
    const RTCRay one = embree_ray(ray, origin);
    rays.org_x[lane] = one.org_x;
    rays.org_y[lane] = one.org_y;
    rays.org_z[lane] = one.org_z;
    rays.dir_x[lane] = one.dir_x;
    rays.dir_y[lane] = one.dir_y;
    rays.dir_z[lane] = one.dir_z;
    rays.tfar[lane] = one.tfar;
    rays.time[lane] = one.time;
    rays.mask[lane] = one.mask;
    rays.id[lane] = static_cast<unsigned>(lane);
}

// Hits of a packet of rays, with the members of RayFind for each lane.
struct PacketFind {
    alignas(32) std::array<int, kPacketRays> valid{};
    RTCRayHit8 query{};
    std::array<unsigned, kPacketRays> geometry{};
    std::array<const MeshGroup*, kPacketRays> group{};
    std::array<bool, kPacketRays> is_sphere{};
    std::array<CopyHit, kPacketRays> copies{};

    PacketFind() {
        geometry.fill(RTC_INVALID_GEOMETRY_ID);
        std::fill(std::begin(query.hit.geomID), std::end(query.hit.geomID), RTC_INVALID_GEOMETRY_ID);
    }

    void meet(RTCScene scene, const MeshGroup* meshes, bool spheres) {
        embree::QueryContext context;
        embree::init_context(context, copies.data());
        intersect8(valid.data(), scene, context, query);
        for (std::size_t lane = 0; lane < kPacketRays; ++lane) {
            if (query.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
            geometry[lane] = query.hit.geomID[lane];
            group[lane] = meshes;
            is_sphere[lane] = spheres;
            query.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        }
    }

    [[nodiscard]] RayFind lane_find(std::size_t lane) const {
        RayFind find;
        find.query.ray.org_x = query.ray.org_x[lane];
        find.query.ray.org_y = query.ray.org_y[lane];
        find.query.ray.org_z = query.ray.org_z[lane];
        find.query.ray.dir_x = query.ray.dir_x[lane];
        find.query.ray.dir_y = query.ray.dir_y[lane];
        find.query.ray.dir_z = query.ray.dir_z[lane];
        find.query.ray.time = query.ray.time[lane];
        find.query.ray.tfar = query.ray.tfar[lane];
        find.query.hit.Ng_x = query.hit.Ng_x[lane];
        find.query.hit.Ng_y = query.hit.Ng_y[lane];
        find.query.hit.Ng_z = query.hit.Ng_z[lane];
        find.query.hit.u = query.hit.u[lane];
        find.query.hit.v = query.hit.v[lane];
        find.query.hit.primID = query.hit.primID[lane];
        find.geometry = geometry[lane];
        find.group = group[lane];
        find.is_sphere = is_sphere[lane];
        find.copy = copies[lane];
        return find;
    }
};

Vec3 face_of(const RTCHit& hit, const PreviewRay& ray) {
    return towards(normalized(Vec3{hit.Ng_x, hit.Ng_y, hit.Ng_z}), ray.direction);
}

PreviewHit mesh_hit(const DrawnMesh& mesh, const RTCRayHit& hit, const PreviewRay& ray) {
    PreviewHit out;
    out.distance = hit.ray.tfar;
    out.point = ray.origin + out.distance * ray.direction;
    out.face = face_of(hit.hit, ray);
    const MeshPoint seen = point_of(mesh, hit.hit.primID, hit.hit.u, hit.hit.v, out.face);
    out.normal = seen.normal;
    out.lift = seen.lift;
    out.roughness = mesh.source.roughness;
    out.time = ray.time;
    out.color = seen.color;
    return out;
}

}  // namespace

bool Preview::Impl::is_traceable(const PreviewRay& ray) const {
    return drawable(ray.origin - origin) && drawable(ray.direction);
}

bool Preview::Impl::traces(SphereRays rays) const { return rays == SphereRays::traced && has_sphere_rays; }

void Preview::Impl::meet(const MeshGroup& group, RayFind& find) {
    if (group.empty()) return;
    embree::QueryContext context;
    embree::init_context(context, nullptr);
    embree::intersect1(group.scene.get(), context, find.query);
    note_source(find, &group, false);
}

void Preview::Impl::meet_spheres(RayFind& find) const {
    if (!has_sphere_rays) return;
    embree::QueryContext context;
    embree::init_context(context, nullptr);
    embree::intersect1(sphere_scene.get(), context, find.query);
    note_source(find, nullptr, true);
}

void Preview::Impl::meet_moving(RayFind& find) const {
    if (!has_moving) return;
    embree::QueryContext context;
    embree::init_context(context, &find.copy);
    embree::intersect1(moving_scene.get(), context, find.query);
    note_source(find, nullptr, false);
}

void Preview::Impl::meet_glow(RayFind& find) const {
    if (glowing_lines.empty()) return;
    embree::QueryContext context;
    embree::init_context(context, nullptr);
    embree::intersect1(glow_scene.get(), context, find.query);
    note_source(find, nullptr, false);
}

PreviewHit Preview::Impl::hit_of(const RayFind& find, const PreviewRay& ray) const {
    const RTCRayHit& hit = find.query;
    if (find.group != nullptr) return mesh_hit(find.group->meshes[find.geometry], hit, ray);
    if (find.is_sphere) return sphere_hit(hit.hit.primID, hit.ray.tfar, face_of(hit.hit, ray), ray);
    return moving_hit(find, ray);
}

PreviewHit Preview::Impl::moving_hit(const RayFind& find, const PreviewRay& ray) const {
    const RTCRayHit& hit = find.query;
    if (find.geometry == kCopies) return copies.hit(hit, find.copy, ray);
    PreviewHit out;
    if (find.geometry == kCloth) {
        out = mesh_hit(cloth, hit, ray);
        out.kind = PreviewHit::Kind::cloth;
        return out;
    }
    out.kind = PreviewHit::Kind::line;
    out.distance = hit.ray.tfar;
    out.point = ray.origin + out.distance * ray.direction;
    out.face = face_of(hit.hit, ray);
    out.normal = out.face;
    out.time = ray.time;
    const LineGroup& lines = find.geometry == kGlowingLines ? bright_lines : dark_lines;
    out.color = lines.colors[hit.hit.primID];
    if (!lines.emissions.empty()) out.emission = lines.emissions[hit.hit.primID];
    return out;
}

PreviewHit Preview::Impl::sphere_hit(std::size_t sphere, double distance, const Vec3& normal,
                                     const PreviewRay& ray) const {
    PreviewHit out;
    out.kind = PreviewHit::Kind::sphere;
    out.distance = distance;
    out.point = ray.origin + distance * ray.direction;
    out.face = towards(normal, ray.direction);
    out.normal = out.face;
    out.time = ray.time;
    out.roughness = kSphereRoughness;
    out.color = spheres.colors[sphere];
    if (!spheres.emissions.empty()) out.emission = spheres.emissions[sphere];
    return out;
}

void Preview::Impl::trace_planes(const PreviewRay& ray, std::optional<PreviewHit>& nearest) const {
    for (const PreviewPlane& plane : planes) {
        const double slope = dot(plane.normal, ray.direction);
        if (slope >= 0.0) continue;
        const double distance = dot(plane.point - ray.origin, plane.normal) / slope;
        if (!(distance > 0.0) || distance > kLargestDrawn) continue;
        if (nearest && nearest->distance <= distance) continue;
        PreviewHit& hit = nearest.emplace();
        hit.kind = PreviewHit::Kind::plane;
        hit.distance = distance;
        hit.point = ray.origin + distance * ray.direction;
        hit.normal = plane.normal;
        hit.face = plane.normal;
        hit.color = plane.color;
        hit.roughness = plane.roughness;
        hit.is_plain = plane.is_plain;
        hit.time = ray.time;
    }
}

std::optional<PreviewHit> Preview::trace(const PreviewRay& ray) const {
    if (!impl_->is_traceable(ray)) return std::nullopt;
    RayFind find = new_find(ray, impl_->origin);
    Impl::meet(impl_->solid, find);
    Impl::meet(impl_->moving_solid, find);
    impl_->meet_spheres(find);
    impl_->meet_moving(find);
    impl_->meet_glow(find);
    std::optional<PreviewHit> nearest;
    if (find.geometry != RTC_INVALID_GEOMETRY_ID) nearest = impl_->hit_of(find, ray);
    impl_->trace_planes(ray, nearest);
    return nearest;
}

void Preview::trace(std::span<const PreviewRay> rays, std::span<std::optional<PreviewHit>> hits, SphereRays spheres,
                    GlowRays glow) const {
    PacketFind find;
    for (std::size_t lane = 0; lane < rays.size(); ++lane) {
        if (!impl_->is_traceable(rays[lane])) continue;
        find.valid[lane] = -1;
        set_lane(find.query.ray, lane, rays[lane], impl_->origin);
    }
    for (const MeshGroup* group : {&impl_->solid, &impl_->moving_solid}) {
        if (!group->empty()) find.meet(group->scene.get(), group, false);
    }
    if (impl_->traces(spheres)) find.meet(impl_->sphere_scene.get(), nullptr, true);
    if (impl_->has_moving) find.meet(impl_->moving_scene.get(), nullptr, false);
    if (glow == GlowRays::traced && !impl_->glowing_lines.empty()) find.meet(impl_->glow_scene.get(), nullptr, false);
    for (std::size_t lane = 0; lane < rays.size(); ++lane) {
        hits[lane].reset();
        if (find.valid[lane] == 0) continue;
        if (find.geometry[lane] != RTC_INVALID_GEOMETRY_ID) {
            hits[lane].emplace(impl_->hit_of(find.lane_find(lane), rays[lane]));
        }
        impl_->trace_planes(rays[lane], hits[lane]);
    }
}

std::optional<PreviewHit> Preview::trace_glass(const PreviewRay& ray) const {
    if (!has_glass() || !impl_->is_traceable(ray)) return std::nullopt;
    RayFind find = new_find(ray, impl_->origin);
    Impl::meet(impl_->glass, find);
    Impl::meet(impl_->moving_glass, find);
    if (find.geometry == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return impl_->hit_of(find, ray);
}

PreviewHit Preview::sphere_hit(std::size_t sphere, double distance, const Vec3& normal, const PreviewRay& ray) const {
    return impl_->sphere_hit(sphere, distance, normal, ray);
}

bool Preview::has_glass() const { return !impl_->glass.empty() || !impl_->moving_glass.empty(); }

bool Preview::occluded(const PreviewRay& ray) const {
    if (!impl_->is_traceable(ray)) return false;
    embree::QueryContext context;
    embree::init_context(context, nullptr);
    RTCRay shadow = embree_ray(ray, impl_->origin);
    for (const MeshGroup* group : {&impl_->solid, &impl_->moving_solid}) {
        if (shadow.tfar >= 0.0F && !group->empty()) occluded1(group->scene.get(), context, shadow);
    }
    if (shadow.tfar >= 0.0F && impl_->traces(SphereRays::traced)) {
        occluded1(impl_->sphere_scene.get(), context, shadow);
    }
    if (shadow.tfar >= 0.0F && impl_->has_moving) occluded1(impl_->moving_scene.get(), context, shadow);
    return shadow.tfar < 0.0F;
}

std::array<bool, kPacketRays> Preview::occluded(std::span<const PreviewRay> rays, SphereRays spheres) const {
    std::array<bool, kPacketRays> dark{};
    if (rays.size() == 1 && spheres == SphereRays::traced) {
        dark[0] = occluded(rays[0]);
        return dark;
    }
    if (rays.empty()) return dark;
    alignas(32) std::array<int, kPacketRays> valid{};
    RTCRay8 shadows{};
    for (std::size_t lane = 0; lane < rays.size(); ++lane) {
        if (!impl_->is_traceable(rays[lane])) continue;
        valid[lane] = -1;
        set_lane(shadows, lane, rays[lane], impl_->origin);
    }
    const auto shoot = [&](RTCScene scene) {
        embree::QueryContext context;
        embree::init_context(context, nullptr);
        occluded8(valid.data(), scene, context, shadows);
        for (std::size_t lane = 0; lane < rays.size(); ++lane) {
            if (valid[lane] == 0 || shadows.tfar[lane] >= 0.0F) continue;
            dark[lane] = true;
            valid[lane] = 0;
        }
    };
    for (const MeshGroup* group : {&impl_->solid, &impl_->moving_solid}) {
        if (!group->empty()) shoot(group->scene.get());
    }
    if (impl_->traces(spheres)) shoot(impl_->sphere_scene.get());
    if (impl_->has_moving) shoot(impl_->moving_scene.get());
    return dark;
}

}  // namespace ricochet
