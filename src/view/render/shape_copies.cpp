#include "view/render/shape_copies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ricochet {
namespace {

constexpr double kShapeCopiesCreaseDegrees = 40.0;
// Least determinant of a drawable copy's map, relative to the cube of the map's longest row.
constexpr double kFlattest = 1e-9;

// Returns the inverse of the map's linear part.
AffineMap inverse_of(const AffineMap& map) {
    const double scale = 1.0 / map.determinant();
    const Vec3 a = scale * cross(map.row_y, map.row_z);
    const Vec3 b = scale * cross(map.row_z, map.row_x);
    const Vec3 c = scale * cross(map.row_x, map.row_y);
    return {{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}, {}};
}

bool is_drawable(const AffineMap& map) {
    const double most = std::max({length(map.row_x), length(map.row_y), length(map.row_z)});
    return drawable(map.translation) && most > 0.0 && most < kLargestDrawn &&
           std::fabs(map.determinant()) > kFlattest * most * most * most;
}

}  // namespace

void ShapeCopies::set_shapes(RTCDevice device, std::vector<TriangleMesh> shapes) {
    shapes_.clear();
    for (TriangleMesh& mesh : shapes) {
        PreviewMesh source;
        source.mesh = std::move(mesh);
        Shape& shape = shapes_.emplace_back();
        shape.mesh = drawn_mesh(std::move(source), kShapeCopiesCreaseDegrees);
        shape.scene = embree::Scene(rtcNewScene(device));
        rtcSetSceneFlags(shape.scene.get(), RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = triangles_of(device, shape.mesh.source.mesh, {});
        rtcSetGeometryMask(geometry, 0xffffffffU);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(shape.scene.get(), geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(shape.scene.get());
    }
    embree::check_device(device, "building the shapes of the particles");
}

RTCGeometry ShapeCopies::make_geometry(RTCDevice device, const PreviewCopies& copies, const Vec3& origin) {
    copies_.clear();
    shutter_paths_.clear();
    const std::uint32_t common = shapes_.empty() ? 0 : 1;
    for (std::size_t i = 0; i < copies.placements.size(); ++i) {
        const AffineMap& map = copies.placements[i];
        const bool on_the_way = copies.shutter_paths.empty() ||
                                std::all_of(copies.shutter_paths[i].begin(), copies.shutter_paths[i].end(), drawable);
        if (!on_the_way || !is_drawable(map)) continue;
        copies_.push_back({inverse_of(map),
                           map.translation - origin,
                           {length(map.row_x), length(map.row_y), length(map.row_z)},
                           copies.colors[i],
                           copies.emissions.empty() ? Vec3{} : copies.emissions[i],
                           copies.shapes.empty() ? common : copies.shapes[i]});
        if (copies.shutter_paths.empty()) continue;
        shutter_paths_.push_back(copies.shutter_paths[i]);
        for (Vec3& point : shutter_paths_.back()) point -= origin;
    }
    if (copies_.empty()) return nullptr;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(copies_.size()));
    rtcSetGeometryTimeStepCount(geometry,
                                shutter_paths_.empty() ? 1U : static_cast<unsigned>(shutter_paths_[0].size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, &write_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, &intersect);
    rtcSetGeometryOccludedFunction(geometry, &occlude);
    return geometry;
}

Vec3 ShapeCopies::center_at(std::size_t copy, double time) const {
    if (shutter_paths_.empty()) return copies_[copy].center;
    const std::vector<Vec3>& shutter_path = shutter_paths_[copy];
    const double at = std::clamp(time, 0.0, 1.0) * static_cast<double>(shutter_path.size() - 1);
    const std::size_t before = std::min(static_cast<std::size_t>(at), shutter_path.size() - 2);
    const double part = at - static_cast<double>(before);
    return (1.0 - part) * shutter_path[before] + part * shutter_path[before + 1];
}

void ShapeCopies::write_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& self = *static_cast<const ShapeCopies*>(args->geometryUserPtr);
    const Copy& copy = self.copies_[args->primID];
    const Vec3 center = self.shutter_paths_.empty() ? copy.center : self.shutter_paths_[args->primID][args->timeStep];
    // The box is widened by the rounding errors of single precision.
    constexpr double kWider = 1.0 + 1e-5;
    const double rounding = 1e-6 * max_abs(center);
    const Vec3 half = kWider * copy.half_size + Vec3{rounding, rounding, rounding};
    RTCBounds& box = *args->bounds_o;
    box.lower_x = static_cast<float>(center.x - half.x);
    box.lower_y = static_cast<float>(center.y - half.y);
    box.lower_z = static_cast<float>(center.z - half.z);
    box.upper_x = static_cast<float>(center.x + half.x);
    box.upper_y = static_cast<float>(center.y + half.y);
    box.upper_z = static_cast<float>(center.z + half.z);
}

ShapeCopies::LocalRay ShapeCopies::local_ray(const RTCRay& ray, std::size_t copy) const {
    const Vec3 from = Vec3{ray.org_x, ray.org_y, ray.org_z} - center_at(copy, ray.time);
    const AffineMap& map = copies_[copy].shape_from_world;
    return {map.direction(from), map.direction({ray.dir_x, ray.dir_y, ray.dir_z})};
}

bool ShapeCopies::meet_ball(const LocalRay& local, const RTCRay& ray, float& distance) const {
    const double square = dot(local.direction, local.direction);
    const double middle = -dot(local.origin, local.direction) / square;
    const Vec3 nearest = local.origin + middle * local.direction;
    const double room = 1.0 - dot(nearest, nearest);
    if (!(room >= 0.0)) return false;
    const double half = std::sqrt(room / square);
    for (const double at : {middle - half, middle + half}) {
        distance = static_cast<float>(at);
        if (distance > ray.tnear) return distance < ray.tfar;
    }
    return false;
}

bool ShapeCopies::meet_mesh(const Shape& shape, const LocalRay& local, const RTCRay& ray, float& distance,
                            CopyHit& what) {
    RTCRayHit query{};
    query.ray = ray;
    query.ray.org_x = static_cast<float>(local.origin.x);
    query.ray.org_y = static_cast<float>(local.origin.y);
    query.ray.org_z = static_cast<float>(local.origin.z);
    query.ray.dir_x = static_cast<float>(local.direction.x);
    query.ray.dir_y = static_cast<float>(local.direction.y);
    query.ray.dir_z = static_cast<float>(local.direction.z);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree::QueryContext context;
    embree::init_context(context, nullptr);
    embree::intersect1(shape.scene.get(), context, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    distance = query.ray.tfar;
    what = {query.hit.primID, query.hit.u, query.hit.v};
    return true;
}

bool ShapeCopies::meet(const RTCRay& ray, std::size_t copy, float& distance, CopyHit& what) const {
    const LocalRay local = local_ray(ray, copy);
    const std::uint32_t shape = copies_[copy].shape;
    return shape == 0 ? meet_ball(local, ray, distance) : meet_mesh(shapes_[shape - 1], local, ray, distance, what);
}

void ShapeCopies::intersect(const RTCIntersectFunctionNArguments* args) {
    const auto& self = *static_cast<const ShapeCopies*>(args->geometryUserPtr);
    RTCRayN* const rays = RTCRayHitN_RayN(args->rayhit, args->N);
    RTCHitN* const hits = RTCRayHitN_HitN(args->rayhit, args->N);
    for (unsigned lane = 0; lane < args->N; ++lane) {
        if (args->valid[lane] == 0) continue;
        const RTCRay ray = rtcGetRayFromRayN(rays, args->N, lane);
        float distance = 0.0F;
        CopyHit what;
        if (!self.meet(ray, args->primID, distance, what)) continue;
        RTCRayN_tfar(rays, args->N, lane) = distance;
        RTCHitN_primID(hits, args->N, lane) = args->primID;
        RTCHitN_geomID(hits, args->N, lane) = args->geomID;
        RTCHitN_instID(hits, args->N, lane, 0) = args->context->instID[0];
        static_cast<CopyHit*>(embree::user_of(args))[ray.id] = what;
    }
}

void ShapeCopies::occlude(const RTCOccludedFunctionNArguments* args) {
    const auto& self = *static_cast<const ShapeCopies*>(args->geometryUserPtr);
    for (unsigned lane = 0; lane < args->N; ++lane) {
        if (args->valid[lane] == 0) continue;
        float distance = 0.0F;
        CopyHit what;
        if (self.meet(rtcGetRayFromRayN(args->ray, args->N, lane), args->primID, distance, what)) {
            RTCRayN_tfar(args->ray, args->N, lane) = -std::numeric_limits<float>::infinity();
        }
    }
}

// Transforms a normal to world coordinates by the transposed inverse of the copy's map.
Vec3 ShapeCopies::world_normal(std::size_t copy, const Vec3& shape_normal) const {
    return normalized(copies_[copy].shape_from_world.direction_back(shape_normal));
}

PreviewHit ShapeCopies::hit(const RTCRayHit& hit, const CopyHit& copy_hit, const PreviewRay& ray) const {
    const std::size_t index = hit.hit.primID;
    const LocalRay local = local_ray(hit.ray, index);
    PreviewHit out;
    out.kind = PreviewHit::Kind::copy;
    out.distance = hit.ray.tfar;
    out.point = ray.origin + out.distance * ray.direction;
    out.time = ray.time;
    out.color = copies_[index].color;
    out.emission = copies_[index].emission;
    out.roughness = kSphereRoughness;
    if (copies_[index].shape == 0) {
        out.face = towards(world_normal(index, local.origin + out.distance * local.direction), ray.direction);
        out.normal = out.face;
        return out;
    }
    const DrawnMesh& drawn = shapes_[copies_[index].shape - 1].mesh;
    const TriangleMesh& mesh = drawn.source.mesh;
    const auto [a, b, c] = mesh.triangles[copy_hit.triangle];
    const Vec3 across = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    const Vec3 face = towards(normalized(across), local.direction);
    const MeshPoint seen = point_of(drawn, copy_hit.triangle, copy_hit.u, copy_hit.v, face);
    out.face = world_normal(index, face);
    out.normal = world_normal(index, seen.normal);
    out.lift = inverse_of(copies_[index].shape_from_world).direction(seen.lift);
    return out;
}

}  // namespace ricochet
