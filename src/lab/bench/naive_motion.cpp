#include "lab/bench/naive_motion.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>
#include <variant>

#include "lab/bench/native_ray.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/transform.h"

namespace ricochet::bench {
namespace {

// Particles per unit of parallel work.
constexpr std::size_t kNaiveMotionBlock = 1024;

}  // namespace

struct NaiveMotion::Impl {
    /// Collider. Its index in `parts` is the number of its Embree geometry.
    struct Part {
        std::vector<Vec3> vertices;  ///< in the coordinates of its frame
        std::shared_ptr<const TriangleMesh> mesh;
        std::optional<std::size_t> frame;
        RTCGeometry geometry = nullptr;  ///< owned by the scene
        MovingPose pose;
        std::shared_ptr<const MeshMotion> motion;  ///< motion of the vertices of a deforming mesh
        MeshMoment moment;
        std::vector<Vec3> placed;  ///< vertices in world coordinates

        [[nodiscard]] bool moves() const { return frame || motion; }
    };

    std::shared_ptr<const FrameTree> frames;
    std::vector<Part> parts;
    embree::Device device = embree::make_device();
    embree::Scene scene;

    Impl(const std::vector<ColliderDescription>& colliders, std::shared_ptr<const FrameTree> tree);
    void set_pose(Part& part, double time);
    void move_to(double time);
    [[nodiscard]] bool step(Flight& flight, double time_step, double restitution) const;
};

NaiveMotion::Impl::Impl(const std::vector<ColliderDescription>& colliders, std::shared_ptr<const FrameTree> tree)
    : frames(std::move(tree)) {
    scene = embree::Scene(rtcNewScene(device.get()));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
    for (const ColliderDescription& collider : colliders) {
        const auto& shape = std::get<MeshShape>(collider.shape);
        Part part;
        part.mesh = shape.mesh;
        if (!collider.frame.empty()) part.frame = frames->find(collider.frame);
        const AffineMap map = world_from_local(shape.placement);
        for (const Vec3& vertex : shape.mesh->vertices) part.vertices.push_back(map.point(vertex));
        part.geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetNewGeometryBuffer(part.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                part.vertices.size());
        auto* const indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            part.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), part.mesh->triangles.size()));
        embree::check_device(device.get(), "making the benchmark's reference");
        for (std::size_t i = 0; i < part.mesh->triangles.size(); ++i) {
            std::copy(part.mesh->triangles[i].begin(), part.mesh->triangles[i].end(), indices + 3 * i);
        }
        rtcSetGeometryMask(part.geometry, 0xFFFFFFFFU);
        part.motion = shape.motion;
        if (part.moves()) rtcSetGeometryBuildQuality(part.geometry, RTC_BUILD_QUALITY_REFIT);
        rtcAttachGeometry(scene.get(), part.geometry);
        rtcReleaseGeometry(part.geometry);  // the scene keeps a reference
        parts.push_back(std::move(part));
    }
    for (Part& part : parts) set_pose(part, 0.0);
    rtcCommitScene(scene.get());
    embree::check_device(device.get(), "building the benchmark's reference");
}

void NaiveMotion::Impl::set_pose(Part& part, double time) {
    if (part.frame) part.pose = frames->at(*part.frame, time);
    if (part.motion) part.moment = part.motion->at(time);
    part.placed.resize(part.vertices.size());
    auto* const corners = static_cast<float*>(rtcGetGeometryBufferData(part.geometry, RTC_BUFFER_TYPE_VERTEX, 0));
    for (std::size_t i = 0; i < part.vertices.size(); ++i) {
        const Vec3 corner = part.motion  ? part.moment.position(i)
                            : part.frame ? part.pose.point(part.vertices[i])
                                         : part.vertices[i];
        part.placed[i] = corner;
        for (int axis = 0; axis < 3; ++axis)
            corners[3 * i + static_cast<std::size_t>(axis)] = static_cast<float>(corner[axis]);
    }
    rtcUpdateGeometryBuffer(part.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(part.geometry);
}

void NaiveMotion::Impl::move_to(double time) {
    parallel_for_blocks(parts.size(), 1, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            if (parts[k].moves()) set_pose(parts[k], time);
        }
    });
    rtcCommitScene(scene.get());
}

/// Moves a particle by one step. Returns true if it bounces.
bool NaiveMotion::Impl::step(Flight& flight, double time_step, double restitution) const {
    embree::QueryContext context;
    embree::init_context(context, nullptr);
    const Vec3 displacement = time_step * flight.velocity;
    RTCRayHit ray = ray_of({to_floats(flight.position), to_floats(displacement)});
    embree::intersect1(scene.get(), context, ray);
    if (ray.hit.primID == kNoTriangle) {
        flight.position += displacement;
        return false;
    }
    const Part& part = parts[ray.hit.geomID];
    const Triangle& triangle = part.mesh->triangles[ray.hit.primID];
    const Vec3& a = part.placed[triangle[0]];
    Vec3 normal = normalized(cross(part.placed[triangle[1]] - a, part.placed[triangle[2]] - a));
    if (dot(normal, flight.velocity) > 0.0) normal = -normal;
    const double along = -dot(normal, displacement);
    const double share = along > 0.0 ? std::clamp(dot(flight.position - a, normal) / along, 0.0, 1.0) : 0.0;
    flight.position += share * displacement;
    flight.position += kRayOffset * max_abs(flight.position) * normal;
    Vec3 surface = part.pose.velocity +
                   cross(part.pose.angular_velocity, flight.position - part.pose.world_from_frame.translation);
    if (part.motion) surface = part.moment.velocity(triangle[0]);
    const double approach = -dot(normal, flight.velocity - surface);
    if (approach > 0.0) flight.velocity += (1.0 + restitution) * approach * normal;
    return true;
}

NaiveMotion::NaiveMotion(const std::vector<ColliderDescription>& colliders, std::shared_ptr<const FrameTree> frames)
    : impl_(std::make_unique<Impl>(colliders, std::move(frames))) {}
NaiveMotion::~NaiveMotion() = default;
NaiveMotion::NaiveMotion(NaiveMotion&&) noexcept = default;
NaiveMotion& NaiveMotion::operator=(NaiveMotion&&) noexcept = default;

std::uint64_t NaiveMotion::run(std::span<Flight> flights, const Steps& steps) {
    std::vector<std::uint64_t> bounces((flights.size() + kNaiveMotionBlock - 1) / kNaiveMotionBlock, 0);
    for (std::uint64_t step = 1; step <= steps.count; ++step) {
        impl_->move_to(steps.begin + static_cast<double>(step) * steps.time_step);
        parallel_for_blocks(
            flights.size(), kNaiveMotionBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    bounces[block] += impl_->step(flights[i], steps.time_step, steps.restitution) ? 1 : 0;
                }
            });
    }
    return std::accumulate(bounces.begin(), bounces.end(), std::uint64_t{0});
}

}  // namespace ricochet::bench
