#include "ricochet/geometry/acceleration/triangle_bvh.h"

#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/thread_sanitizer.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/acceleration/embree.h"

namespace ricochet {
namespace {

std::string& embree_config() {
    static std::string config;
    return config;
}

/// Maps world coordinates in doubles to the floats that Embree uses: centred, and scaled by a power of two to about 1.
struct FloatFrame {
    Vec3 center;
    double scale = 1.0;

    [[nodiscard]] Vec3 apply(const Vec3& p) const { return scale * (p - center); }
};

/// Distance beyond which segments are not clipped, in units of the float frame (about the scene's half extent). Beyond
/// it, the rounding of the clipped point could exceed the boxes' padding. Every triangle is then a candidate. Such
/// segments are rare, because they must also point at the collider. Local, because only the cost depends on it.
constexpr double kFarAway = 0x1p20;

/// Length below which the direction of a ray is undefined in single precision. Local: a guard against underflow.
constexpr double kShortestRay = 0x1p-120;

float round_down(double value) {
    const auto f = static_cast<float>(value);
    return static_cast<double>(f) <= value ? f : std::nextafterf(f, -std::numeric_limits<float>::infinity());
}

float round_up(double value) { return -round_down(-value); }

FloatFrame frame_of(const Box3& box) {
    FloatFrame frame;
    if (box.empty()) return frame;
    frame.center = box.center();
    const double half_extent = 0.5 * max_abs(box.size());
    if (half_extent > 0.0) frame.scale = std::ldexp(1.0, -std::ilogb(half_extent));
    return frame;
}

/// The part of a segment inside a box, in fractions of the segment.
struct ClippedRange {
    double begin;
    double end;
};

std::optional<ClippedRange> clip_to_box(const Vec3& from, const Vec3& to, const Box3& box) {
    double begin = 0.0;
    double end = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double delta = to[axis] - from[axis];
        if (delta == 0.0) {
            if (from[axis] < box.lower[axis] || from[axis] > box.upper[axis]) return std::nullopt;
            continue;
        }
        const double t0 = (box.lower[axis] - from[axis]) / delta;
        const double t1 = (box.upper[axis] - from[axis]) / delta;
        begin = std::max(begin, std::min(t0, t1));
        end = std::min(end, std::max(t0, t1));
    }
    if (begin > end) return std::nullopt;
    return ClippedRange{begin, end};
}

/// State of a segment or tube query during traversal.
struct Query {
    void* context;
    const TriangleClusters* clusters;
    TriangleBvh::VisitSegment visit = nullptr;    ///< either this one or `visit_tube` is set
    TriangleBvh::VisitTube visit_tube = nullptr;  ///< for triangles that the tube may touch
    Tube tube = {};
    double clip_begin = 0.0;        ///< fraction of the segment at which the ray starts
    double ray_per_fraction = 0.0;  ///< ray length of the whole segment
    double fraction_limit = 1.0;

    /// Visits the triangles of a cluster. Returns the smallest fraction that visits have returned so far.
    double visit_cluster(const TriangleCluster& cluster);
};

double Query::visit_cluster(const TriangleCluster& cluster) {
    double limit = fraction_limit;
    if (visit != nullptr) {
        for (const std::uint32_t triangle : cluster.triangle) {
            if (triangle != kNoTriangle) limit = std::min(limit, visit(context, triangle));
        }
        return limit;
    }
    TubeIntervals intervals;
    unsigned bits = cluster.overlaps(tube, intervals);
    for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
        limit =
            std::min(limit, visit_tube(context, cluster.triangle[lane], intervals.enter[lane], intervals.leave[lane]));
    }
    return limit;
}

/// Callback of Embree for a cluster whose box the ray of a query hits. It shortens the ray to the narrowed fraction.
void visit_cluster_on_ray(const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    auto& query = *static_cast<Query*>(embree::user_of(args));
    const double limit = query.visit_cluster((*query.clusters)[args->primID]);
    if (limit >= query.fraction_limit) return;
    query.fraction_limit = limit;
    // The new length is rounded up generously, because the shortened ray must still reach all triangles up to the
    // limit.
    const double ray_length = (limit - query.clip_begin) * query.ray_per_fraction;
    float& tfar = RTCRayN_tfar(RTCRayHitN_RayN(args->rayhit, args->N), args->N, 0);
    tfar = std::min(tfar, round_up(std::max(ray_length, 0.0) * (1.0 + 0x1p-20)));
}

/// State of a point query during traversal.
struct PointQuery {
    void* context;
    TriangleBvh::VisitPoint visit;
    const TriangleClusters* clusters;
    double within;  ///< in m, the smallest distance returned so far
    double scale;   ///< of the float frame

    [[nodiscard]] float radius() const;
};

/// Embree compares squared distances in single precision, with about 8 roundings. The point is rounded to 2^-23 of its
/// largest coordinate. This rounding is at most the boxes' padding plus 2^-23 of the distance. The factor 1 + 2^-20
/// covers both errors. The radius is limited, because an infinite radius would also include empty boxes that Embree
/// stores. All triangles are within the limit from a point that is not far away.
float PointQuery::radius() const {
    // Local: a distance beyond every triangle.
    constexpr double kEverything = 4.0 * kFarAway;
    return round_up(std::min(scale * within * (1.0 + 0x1p-20), kEverything));
}

bool visit_cluster_near_point(RTCPointQueryFunctionArguments* args) {
    auto& query = *static_cast<PointQuery*>(args->userPtr);
    double limit = query.within;
    for (const std::uint32_t triangle : (*query.clusters)[args->primID].triangle) {
        if (triangle != kNoTriangle) limit = std::min(limit, std::max(query.visit(query.context, triangle), 0.0));
    }
    if (!(limit < query.within)) return false;
    query.within = limit;
    args->query->radius = std::min(args->query->radius, query.radius());
    return true;
}

/// Returns the largest distance of a point from a box along an axis, or 0 inside. This is a lower bound on the distance
/// from the box.
double distance_to_box(const Box3& box, const Vec3& p) {
    const Vec3 outside = max(box.lower - p, p - box.upper);
    return std::max({outside.x, outside.y, outside.z, 0.0});
}

/// Bytes that Embree has allocated. Embree's own threads update the count too.
struct MemoryCount {
    std::atomic<std::ptrdiff_t> bytes{0};
    SyncPoint begun;
    SyncPoint counted;

    MemoryCount() { begun.release(); }
    ~MemoryCount() { counted.acquire(); }
    MemoryCount(const MemoryCount&) = delete;
    MemoryCount& operator=(const MemoryCount&) = delete;
};

bool count_memory(void* user, ssize_t bytes, bool /*post*/) {
    auto& count = *static_cast<MemoryCount*>(user);
    count.begun.acquire();
    count.bytes.fetch_add(bytes, std::memory_order_relaxed);
    count.counted.release();
    return true;
}

/// Returns the device that hierarchies share. The device exists as long as one of these hierarchies.
std::shared_ptr<const embree::Device> shared_device() {
    static std::mutex mutex;
    static std::weak_ptr<const embree::Device> shared;
    const std::lock_guard lock(mutex);
    std::shared_ptr<const embree::Device> device = shared.lock();
    if (!device) {
        device = std::make_shared<const embree::Device>(embree::make_device(embree_config()));
        shared = device;
    }
    return device;
}

}  // namespace

struct TriangleBvh::Impl {
    Clusters clusters;
    double margin = 0.0;
    double slack = 0.0;
    FloatFrame frame;
    double padding = 0.0;  ///< in the float frame: rounding, slack and margin
    Box3 clip_box;         ///< in world coordinates; generously larger than the padded boxes
    MemoryCount memory;
    std::shared_ptr<const embree::Device> device;
    bool shares_device = false;
    embree::Scene scene;

    /// Argument of Embree's threads during a build.
    struct Build {
        const Impl* impl;
        LoopSync sync;  // after impl, because it is constructed when impl is set
    };

    Impl() = default;
    // After an allocation has failed, Embree's threads may keep the device longer than this object exists. They must
    // not count memory after that.
    ~Impl() {
        if (device && !shares_device) rtcSetDeviceMemoryMonitorFunction(device->get(), nullptr, nullptr);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void build();
    void set_frame();
    void write_bounds(std::uint32_t number, RTCBounds& bounds) const;
    void visit_all(Query& query) const;
    void visit_segment(const Vec3& from, const Vec3& to, Query& query) const;
    void query_near(PointQuery& query, const Vec3& point) const;
    void cast(Query& query, const Vec3& begin, const Vec3& direction, double ray_length) const;
};

void TriangleBvh::Impl::set_frame() {
    Box3 box;
    for (const TriangleCluster& cluster : *clusters) box.include(cluster.box());
    frame = frame_of(box);
    // In the float frame the half extent H is at least 1, and the length of a clipped segment is at most 2 sqrt(3) H.
    const double half_extent = std::max(1.0, frame.scale * 0.5 * max_abs(box.size()));
    slack = kBoxSlack * half_extent / frame.scale + kCandidateSlack * max_abs(max(abs(box.lower), abs(box.upper)));
    const double beside = frame.scale * (margin + slack);
    padding = kBoxPaddingUnits * 0x1p-24 * (4.5 * half_extent + beside) + beside;
    clip_box = grown(box, 2.0 * padding / frame.scale);
}

void TriangleBvh::Impl::write_bounds(std::uint32_t number, RTCBounds& bounds) const {
    const Box3 world = (*clusters)[number].box();
    const Box3 box{frame.apply(world.lower), frame.apply(world.upper)};
    bounds.lower_x = round_down(box.lower.x - padding);
    bounds.lower_y = round_down(box.lower.y - padding);
    bounds.lower_z = round_down(box.lower.z - padding);
    bounds.upper_x = round_up(box.upper.x + padding);
    bounds.upper_y = round_up(box.upper.y + padding);
    bounds.upper_z = round_up(box.upper.z + padding);
}

void TriangleBvh::Impl::build() {
    set_frame();
    if (shares_device) {
        device = shared_device();
    } else {
        device = std::make_shared<const embree::Device>(embree::make_device(embree_config()));
        rtcSetDeviceMemoryMonitorFunction(device->get(), count_memory, &memory);
    }
    scene = embree::Scene(rtcNewScene(device->get()));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device->get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(clusters->size()));
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcSetGeometryBoundsFunction(
        geometry,
        [](const RTCBoundsFunctionArguments* args) {
            auto& build = *static_cast<Build*>(args->geometryUserPtr);
            const LoopSync::Iteration iteration(build.sync);
            build.impl->write_bounds(args->primID, *args->bounds_o);
        },
        nullptr);
    rtcSetGeometryIntersectFunction(geometry, visit_cluster_on_ray);
    {
        Build build{this, {}};
        rtcSetGeometryUserData(geometry, &build);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene.get(), geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene.get());
    }
    embree::check_device(device->get(), "building the hierarchy of a collider");
}

TriangleBvh::TriangleBvh(std::span<const Vec3> vertices, std::span<const Triangle> triangles, double margin)
    : TriangleBvh(std::make_shared<const TriangleClusters>(make_clusters(vertices, triangles)), margin) {}

TriangleBvh::TriangleBvh(Clusters clusters, double margin, Device device) : impl_(std::make_unique<Impl>()) {
    impl_->shares_device = device == Device::shared;
    impl_->clusters = std::move(clusters);
    impl_->margin = margin;
    if (!impl_->clusters->empty()) impl_->build();
}
TriangleBvh::~TriangleBvh() = default;
TriangleBvh::TriangleBvh(TriangleBvh&&) noexcept = default;
TriangleBvh& TriangleBvh::operator=(TriangleBvh&&) noexcept = default;

double TriangleBvh::margin() const { return impl_->margin; }
double TriangleBvh::slack() const { return impl_->slack; }
std::size_t TriangleBvh::memory_bytes() const { return static_cast<std::size_t>(impl_->memory.bytes.load()); }

void TriangleBvh::Impl::visit_all(Query& query) const {
    for (const TriangleCluster& cluster : *clusters) (void)query.visit_cluster(cluster);
}

void TriangleBvh::Impl::cast(Query& query, const Vec3& begin, const Vec3& direction, double ray_length) const {
    embree::QueryContext context;
    embree::init_context(context, &query);
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(begin.x);
    ray.ray.org_y = static_cast<float>(begin.y);
    ray.ray.org_z = static_cast<float>(begin.z);
    ray.ray.dir_x = static_cast<float>(direction.x);
    ray.ray.dir_y = static_cast<float>(direction.y);
    ray.ray.dir_z = static_cast<float>(direction.z);
    ray.ray.tnear = 0.0F;
    ray.ray.tfar = round_up(ray_length * (1.0 + 0x1p-20)) + 0x1p-24F;
    ray.ray.mask = 0xFFFFFFFFU;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree::intersect1(scene.get(), context, ray);
}

void TriangleBvh::query_segment(const Vec3& from, const Vec3& to, void* context, VisitSegment visitor) const {
    Query query{context, impl_->clusters.get(), visitor};
    impl_->visit_segment(from, to, query);
}

void TriangleBvh::query_tube(const Tube& tube, void* context, VisitTube visitor) const {
    Query query{context, impl_->clusters.get(), nullptr, visitor, tube};
    impl_->visit_segment(tube.from, tube.from + tube.along, query);
}

void TriangleBvh::Impl::visit_segment(const Vec3& from, const Vec3& to, Query& query) const {
    if (clusters->empty()) return;
    const double far = std::max(max_abs(from - frame.center), max_abs(to - frame.center));
    if (far * frame.scale > kFarAway) {
        if (clip_to_box(from, to, grown(clip_box, far * 0x1p-45))) visit_all(query);
        return;
    }
    const auto range = clip_to_box(from, to, clip_box);
    if (!range) return;
    const Vec3 delta = to - from;
    const Vec3 along = frame.scale * delta;
    query.clip_begin = range->begin;
    query.ray_per_fraction = length(along);
    // A segment too short for single precision counts as a point for the boxes.
    const bool is_point = query.ray_per_fraction <= kShortestRay;
    const Vec3 direction = is_point ? Vec3{1, 0, 0} : along / query.ray_per_fraction;
    const double ray_length = (range->end - range->begin) * query.ray_per_fraction;
    cast(query, frame.apply(from + range->begin * delta), direction, ray_length);
}

void TriangleBvh::Impl::query_near(PointQuery& query, const Vec3& point) const {
    RTCPointQuery around{};
    around.x = static_cast<float>(point.x);
    around.y = static_cast<float>(point.y);
    around.z = static_cast<float>(point.z);
    around.radius = query.radius();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene.get(), &around, &context, visit_cluster_near_point, &query);
}

void TriangleBvh::query_point(const Vec3& p, double within, void* context, VisitPoint visitor) const {
    // The clip box extends beyond the padded boxes by far more than the rounding of a point that is not far away. The
    // factor covers the rounding of a point that is far away.
    if (impl_->clusters->empty() || distance_to_box(impl_->clip_box, p) > within * (1.0 + 0x1p-50)) return;
    const FloatFrame& frame = impl_->frame;
    if (max_abs(p - frame.center) * frame.scale > kFarAway) {
        for (const TriangleCluster& cluster : *impl_->clusters) {
            for (const std::uint32_t triangle : cluster.triangle) {
                if (triangle != kNoTriangle) (void)visitor(context, triangle);
            }
        }
        return;
    }
    PointQuery query{context, visitor, impl_->clusters.get(), within, frame.scale};
    impl_->query_near(query, frame.apply(p));
}

void set_embree_config(std::string config) { embree_config() = std::move(config); }

std::string embree_version() {
    const embree::Device device = embree::make_device();
    const auto version = rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_VERSION);
    return "Embree " + std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
           std::to_string(version % 100);
}

}  // namespace ricochet
