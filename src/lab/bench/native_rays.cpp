#include "lab/bench/native_rays.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "lab/bench/native_ray.h"
#include "ricochet/core/parallel.h"

namespace ricochet::bench {
namespace {

// Rays per unit of parallel work. The number is a multiple of the packet size.
constexpr std::size_t kBlock = 1024;
constexpr std::size_t kPacket = 16;

// Largest number of bounces of a flight. It equals the default limit of the simulation.
constexpr int kMostBounces = 1000;

/// Traces sixteen rays at once. A ray is traced if its entry of `valid` is -1, and skipped if its entry is 0. `valid`
/// must be aligned to 64 bytes.
void intersect16(const int* valid, RTCScene scene, embree::QueryContext& context, RTCRayHit16& ray_hits) {
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context.base;
    rtcIntersect16(valid, scene, &ray_hits, &arguments);
#else
    rtcIntersect16(valid, scene, &context.base, &ray_hits);
#endif
}

/// Up to sixteen rays, and a mask of the lanes that contain a ray.
struct Packet {
    alignas(64) std::array<int, kPacket> valid{};
    RTCRayHit16 rays{};  // initialized, because Embree also reads unused lanes

    void set(std::size_t lane, const RaySegment& segment) {
        valid[lane] = -1;
        rays.ray.org_x[lane] = segment.from[0];
        rays.ray.org_y[lane] = segment.from[1];
        rays.ray.org_z[lane] = segment.from[2];
        rays.ray.dir_x[lane] = segment.along[0];
        rays.ray.dir_y[lane] = segment.along[1];
        rays.ray.dir_z[lane] = segment.along[2];
        rays.ray.tnear[lane] = 0.0F;
        rays.ray.tfar[lane] = 1.0F;
        rays.ray.time[lane] = 0.0F;
        rays.ray.mask[lane] = 0xFFFFFFFFU;
        rays.ray.flags[lane] = 0;
        rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        rays.hit.primID[lane] = kNoTriangle;
    }
};

}  // namespace

struct NativeRays::Impl {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
    double offset = 0.0;  ///< distance from the surface at which a ray starts after a bounce, in m
    embree::Device device;
    embree::Scene scene;

    explicit Impl(const TriangleMesh& mesh);
    [[nodiscard]] std::uint32_t first_hit(const RaySegment& segment) const;
    void trace_packet(std::span<const RaySegment> segments, std::span<std::uint32_t> hits) const;
    [[nodiscard]] std::uint64_t fly(Flight flight, const BounceRules& rules, Vec3& end) const;
    /// Moves the flight to the triangle's plane, reduces `left` (the remaining time, in s), and reflects the velocity.
    void reflect(Flight& flight, double& left, double restitution, const Triangle& triangle) const;
};

NativeRays::Impl::Impl(const TriangleMesh& mesh)
    : vertices(mesh.vertices), triangles(mesh.triangles), device(embree::make_device()) {
    scene = embree::Scene(rtcNewScene(device.get()));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const corners = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices.size()));
    auto* const indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), triangles.size()));
    embree::check_device(device.get(), "making the benchmark's reference");
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const std::array<float, 3> corner = to_floats(vertices[i]);
        std::copy(corner.begin(), corner.end(), corners + 3 * i);
        offset = std::max(offset, kRayOffset * max_abs(vertices[i]));
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        std::copy(triangles[i].begin(), triangles[i].end(), indices + 3 * i);
    }
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene.get());
    embree::check_device(device.get(), "building the benchmark's reference");
}

NativeRays::NativeRays(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
NativeRays::~NativeRays() = default;
NativeRays::NativeRays(NativeRays&&) noexcept = default;
NativeRays& NativeRays::operator=(NativeRays&&) noexcept = default;

std::uint32_t NativeRays::Impl::first_hit(const RaySegment& segment) const {
    embree::QueryContext context;
    embree::init_context(context, nullptr);
    RTCRayHit ray = ray_of(segment);
    embree::intersect1(scene.get(), context, ray);
    return ray.hit.primID;
}

void NativeRays::trace(std::span<const RaySegment> segments, std::span<std::uint32_t> triangles) const {
    parallel_for_blocks(segments.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) triangles[i] = impl_->first_hit(segments[i]);
    });
}

void NativeRays::Impl::trace_packet(std::span<const RaySegment> segments, std::span<std::uint32_t> hits) const {
    embree::QueryContext context;
    embree::init_context(context, nullptr);
    Packet packet;
    for (std::size_t lane = 0; lane < segments.size(); ++lane) packet.set(lane, segments[lane]);
    intersect16(packet.valid.data(), scene.get(), context, packet.rays);
    std::copy_n(std::begin(packet.rays.hit.primID), hits.size(), hits.begin());
}

void NativeRays::trace_packets(std::span<const RaySegment> segments, std::span<std::uint32_t> triangles) const {
    parallel_for_blocks(segments.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; i += kPacket) {
            const std::size_t count = std::min(kPacket, end - i);
            impl_->trace_packet(segments.subspan(i, count), triangles.subspan(i, count));
        }
    });
}

void NativeRays::Impl::reflect(Flight& flight, double& left, double restitution, const Triangle& triangle) const {
    const Vec3& a = vertices[triangle[0]];
    Vec3 normal = normalized(cross(vertices[triangle[1]] - a, vertices[triangle[2]] - a));
    if (dot(normal, flight.velocity) > 0.0) normal = -normal;
    const double approach = -dot(normal, flight.velocity);
    const double time = approach > 0.0 ? std::clamp(dot(flight.position - a, normal) / approach, 0.0, left) : 0.0;
    flight.position += time * flight.velocity + offset * normal;
    flight.velocity += (1.0 + restitution) * approach * normal;
    left -= time;
}

std::uint64_t NativeRays::Impl::fly(Flight flight, const BounceRules& rules, Vec3& end) const {
    double left = rules.duration;
    std::uint64_t bounces = 0;
    for (; bounces < kMostBounces; ++bounces) {
        const std::uint32_t hit = first_hit({to_floats(flight.position), to_floats(left * flight.velocity)});
        if (hit == kNoTriangle) {
            flight.position += left * flight.velocity;
            break;
        }
        reflect(flight, left, rules.restitution, triangles[hit]);
    }
    end = flight.position;
    return bounces;
}

std::uint64_t NativeRays::bounce(std::span<const Flight> flights, const BounceRules& rules,
                                 std::span<Vec3> ends) const {
    std::vector<std::uint64_t> bounces((flights.size() + kBlock - 1) / kBlock, 0);
    parallel_for_blocks(flights.size(), kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        std::uint64_t count = 0;
        for (std::size_t i = begin; i < end; ++i) count += impl_->fly(flights[i], rules, ends[i]);
        bounces[block] = count;
    });
    return std::accumulate(bounces.begin(), bounces.end(), std::uint64_t{0});
}

}  // namespace ricochet::bench
