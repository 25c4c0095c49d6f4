#include "ricochet/simulation/collision_scene.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "ricochet/core/hash.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet {
namespace {

/// Returns true if no collider intersects the segment. Moving colliders are tested in their poses at a time, in s.
bool is_clear_at(const MovingColliders& bodies, double time, const Vec3& from, const Vec3& to) {
    ContactScratch scratch;
    if (!is_clear(bodies.world(kWorldBody), scratch, from, to)) return false;
    Box3 box;
    box.include(from);
    box.include(to);
    std::vector<BodyId> near;
    bodies.near_at(box, time, near);
    for (const BodyId body : near) {
        ContactScratch own;
        if (!is_clear(bodies.world(body), own, bodies.local_position(body, from, time),
                      bodies.local_position(body, to, time))) {
            return false;
        }
    }
    return true;
}

}  // namespace

bool is_in_range(const Vec3& position) { return is_finite(position) && max_abs(position) <= kLargestCoordinate; }

CollisionScene::CollisionScene(std::vector<ColliderDescription> colliders, std::vector<Material> materials,
                               const std::shared_ptr<const FrameTree>& frames, double chord_margin)
    : materials_(std::move(materials)),
      list_(std::make_shared<ColliderList>(std::move(colliders))),
      world_(std::make_shared<CollisionWorld>(list_, std::string_view(), chord_margin)),
      frames_(frames ? std::make_shared<FrameTree>(*frames) : nullptr),
      moving_(*world_, frames_) {}

bool CollisionScene::has_loads() const {
    return !moving_.empty() || std::ranges::any_of(materials_, [](const Material& m) { return m.drives(); });
}

void CollisionScene::set_culling(bool culls) {
    world_->set_culling(culls);
    moving_.set_culling(culls);
}

void CollisionScene::begin_step(const TimeSpan& step) { moving_.begin_step(step.begin, step.end); }

void CollisionScene::prepare_radius(double radius) {
    world_->prepare_radius(radius);
    moving_.prepare_radius(radius);
}

std::optional<Overlap> CollisionScene::overlap_of(const Particle& particle) const {
    const Vec3 position = flush_tiny(particle.position);
    if (!is_in_range(position)) return std::nullopt;
    return deepest_overlap(moving_, position, particle.radius, particle.birth_time);
}

bool CollisionScene::has_room_beside(const Particle& parent, const Particle& child) const {
    const Vec3 position = flush_tiny(child.position);
    return is_clear_at(moving_, child.birth_time, parent.position, position) && !overlap_of(child);
}

const CollisionWorld& CollisionScene::world_of(std::size_t collider) const {
    return is_deforming(collider) ? *world_ : moving_.world(moving_.body_of_collider(collider));
}

std::optional<TriangleMesh> CollisionScene::mesh_of(std::size_t collider, double time) const {
    const ColliderShape& shape = world_->colliders()[collider].shape;
    if (const auto* ball = std::get_if<BallShape>(&shape)) return ball_mesh(ball->radius, ball->placement);
    if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
        return cylinder_mesh(cylinder->radius, cylinder->height, cylinder->placement);
    }
    if (is_deforming(collider)) return moving_.deforming().mesh(collider).mesh_at(time);
    return world_of(collider).mesh_of(collider);
}

MovingPose CollisionScene::pose_of(std::size_t collider, double time) const {
    return moving_.pose(moving_.body_of_collider(collider), time);
}

SurfacePosition CollisionScene::closest_point(SurfaceId surface, const Vec3& position, double time) const {
    const std::uint32_t collider = world_->name_of(surface).collider;
    if (is_deforming(collider)) {
        const auto [a, b, c] = moving_.deforming().triangle_at(surface, time);
        const ClosestPointOnTriangle closest = closest_point_on_triangle(position, a, b, c);
        return {closest.point, barycentric_coordinates(closest, a, b, c)};
    }
    const CollisionWorld& own = world_of(collider);
    if (&own == world_.get()) return own.closest_point_on(surface, position);
    const MovingPose pose = pose_of(collider, time);
    SurfacePosition closest = own.closest_point_on(surface, pose.local_position(position));
    closest.point = pose.point(closest.point);
    return closest;
}

template <class Visit>
void CollisionScene::visit_worlds(const Visit& visit) const {
    visit(*world_);
    for (BodyId body = 0; body < moving_.size(); ++body) visit(moving_.world(body));
}

std::size_t CollisionScene::triangle_count() const {
    std::size_t count = 0;
    visit_worlds([&](const CollisionWorld& of) { count += of.triangles().size(); });
    for (const DeformingMesh& mesh : moving_.deforming().all()) count += mesh.triangles().size();
    return count;
}

std::size_t CollisionScene::degenerate_triangles() const {
    std::size_t count = 0;
    visit_worlds([&](const CollisionWorld& of) { count += of.degenerate_triangles(); });
    return count;
}

std::uint64_t CollisionScene::hash() const {
    if (!hash_) hash_ = computed_hash();
    return *hash_;
}

// Includes the vertices and triangles, because a changed mesh file is a changed setup.
std::uint64_t CollisionScene::computed_hash() const {
    StateHash hash;
    const auto add_triangles = [&](const auto& triangles) {
        for (const Triangle& triangle : triangles) {
            for (const std::uint32_t corner : triangle) hash.add(static_cast<std::uint64_t>(corner));
        }
    };
    const auto add = [&](const CollisionWorld& of) {
        for (const Vec3& vertex : of.vertices()) hash.add(vertex);
        add_triangles(of.triangles());
    };
    add(*world_);
    for (BodyId body = 0; body < moving_.size(); ++body) {
        add(moving_.world(body));
        hash.add(moving_.frames()->hash(moving_.frame_of(body)));
    }
    for (std::size_t k = 0; !moving_.empty() && k < list_->all().size(); ++k) {
        hash.add(static_cast<std::uint64_t>(moving_.body_of_collider(k)));
    }
    for (const DeformingMesh& mesh : moving_.deforming().all()) {
        const MeshMotion& motion = *mesh.motion();
        hash.add(static_cast<double>(motion.ends() == MeshEnds::repeat));
        add_triangles(mesh.triangles());
        for (std::size_t key = 0; key < motion.key_count(); ++key) {
            hash.add(motion.times()[key]);
            for (const Vec3& vertex : motion.positions(key)) hash.add(vertex);
        }
    }
    hash.add(static_cast<std::uint64_t>(world_->surface_count()));
    return hash.value();
}

void CollisionScene::share_meshes(Ranks& ranks) {
    std::vector<std::span<const std::byte>> pages;
    visit_worlds([&](const CollisionWorld& of) { of.add_pages_to(pages); });
    shared_bytes_ = ranks.have_in_common(pages);
}

bool is_clear(const CollisionWorld& world, ContactScratch& scratch, const Vec3& from, const Vec3& to) {
    const SurfaceGeometry geometry(world, scratch.plane_cache);
    const Path path = line_path(from, to - from, 1.0);
    const ContactQueryResult found = find_first_contact(geometry, {path, 0.0}, scratch);
    return !found.contact && found.near.is_free(from, to);
}

}  // namespace ricochet
