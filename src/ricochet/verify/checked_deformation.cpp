#include "ricochet/verify/checked_deformation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "ricochet/core/error.h"
#include "ricochet/verify/space_time.h"

namespace ricochet::verify {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void require(bool condition, const char* what) {
    if (!condition) throw InputError(what);
}

/// Returns, for each vertex, the lowest index of a vertex that has the same positions at all keys.
std::vector<std::uint32_t> joined_vertices(const std::vector<std::vector<Vec3>>& keys) {
    std::vector<std::uint32_t> order(keys.front().size());
    std::iota(order.begin(), order.end(), 0U);
    const auto compare = [&](std::uint32_t a, std::uint32_t b) {
        for (const std::vector<Vec3>& key : keys) {
            for (int axis = 0; axis < 3; ++axis) {
                if (key[a][axis] != key[b][axis]) return key[a][axis] < key[b][axis] ? -1 : 1;
            }
        }
        return 0;
    };
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return compare(a, b) < 0; });
    std::vector<std::uint32_t> joined(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        joined[order[i]] = i > 0 && compare(order[i - 1], order[i]) == 0 ? joined[order[i - 1]] : order[i];
    }
    return joined;
}

/// Returns true if every edge belongs to an even number of triangle sides. Vertices with equal positions at all keys
/// are treated as one vertex.
bool encloses(const VerifiedDeformation& surface) {
    const std::vector<std::uint32_t> joined = joined_vertices(surface.vertices);
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> is_odd;
    for (const Triangle& t : surface.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            bool& odd = is_odd[std::minmax(joined[t[k]], joined[t[(k + 1) % 3]])];
            odd = !odd;
        }
    }
    return std::none_of(is_odd.begin(), is_odd.end(), [](const auto& edge) { return edge.second; });
}

}  // namespace

CheckedDeformation::CheckedDeformation(std::uint32_t collider, VerifiedDeformation surface)
    : collider_(collider), surface_(std::move(surface)) {
    require(surface_.times.size() > 1 && surface_.times.size() == surface_.vertices.size(),
            "verified mesh that deforms: expected two keys or more, and vertices at each");
    for (const std::vector<Vec3>& key : surface_.vertices) {
        require(key.size() == surface_.vertices.front().size() && std::all_of(key.begin(), key.end(), is_finite),
                "verified mesh that deforms: expected the same number of finite vertices at each key");
        for (const Vec3& vertex : key) largest_ = std::max(largest_, max_abs(vertex));
    }
    for (const Triangle& t : surface_.triangles) {
        require(std::max({t[0], t[1], t[2]}) < surface_.vertices.front().size(),
                "verified mesh that deforms: found a corner that is not there");
    }
    require(!surface_.triangles.empty(), "verified mesh that deforms: expected triangles");
    is_closed_ = encloses(surface_);
    // Triangles that contain a vertex twice are skipped, because they never have an area.
    std::vector<std::uint32_t> listed;
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
        if (std::set(surface_.triangles[t].begin(), surface_.triangles[t].end()).size() == 3) listed.push_back(t);
    }
    constexpr std::uint32_t kLeafSize = 8;
    tree_ = ItemTree(static_cast<std::uint32_t>(listed.size()), kLeafSize, [&](std::uint32_t k) {
        const auto [a, b, c] = corners_at(listed[k], Moment{});
        return a + b + c;
    });
    for (const std::uint32_t k : tree_.order()) order_.push_back(listed[k]);
    for (const std::vector<Vec3>& key : surface_.vertices) {
        boxes_.push_back(tree_.boxes([&](std::uint32_t k) {
            const auto [a, b, c] = surface_.triangles[order_[k]];
            return enclosing(key[a], key[b], key[c]);
        }));
    }
}

/// Returns the moment at a time, between its two nearest keys. If the keys repeat, each period begins with the first
/// key. This key replaces the last key of the preceding period.
CheckedDeformation::Moment CheckedDeformation::moment_at(double time) const {
    const std::vector<double>& times = surface_.times;
    const std::size_t last = times.size() - 1;
    double round = 0.0;
    const double period = times.back() - times.front();
    const auto begin_of = [&](std::size_t key, double in_round) { return times[key] + in_round * period; };
    if (!surface_.repeats && time < times.front()) return {0, 0, 0.0, times.front()};
    if (!surface_.repeats && time >= times.back()) return {last, last, 0.0, kInfinity};
    if (surface_.repeats) {
        round = std::floor((time - times.front()) / period);
        while (begin_of(0, round) > time) round -= 1.0;
        while (begin_of(0, round + 1.0) <= time) round += 1.0;
    }
    // The key is found by bisection, because colliders with a scaled time can have thousands of keys.
    std::size_t key = 0;
    for (std::size_t after = last; after - key > 1;) {
        const std::size_t middle = key + (after - key) / 2;
        (begin_of(middle, round) <= time ? key : after) = middle;
    }
    const bool wraps = surface_.repeats && key + 1 == last;
    const double begin = begin_of(key, round);
    const double end = wraps ? begin_of(0, round + 1.0) : begin_of(key + 1, round);
    return {key, key + 1, (time - begin) / (end - begin), end};
}

Vec3 CheckedDeformation::position(std::uint32_t vertex, const Moment& moment) const {
    const Vec3& a = surface_.vertices[moment.from][vertex];
    const Vec3& b = surface_.vertices[moment.to][vertex];
    if (moment.part == 0.0) return a;
    const auto between = [&](double from, double to) {
        const double step = moment.part * (to - from);
        return from + step;
    };
    return {between(a.x, b.x), between(a.y, b.y), between(a.z, b.z)};
}

Corners CheckedDeformation::corners_at(std::uint32_t triangle, const Moment& moment) const {
    const auto [a, b, c] = surface_.triangles[triangle];
    return {position(a, moment), position(b, moment), position(c, moment)};
}

/// Returns the moments at both ends of a time span and at the keys within the span.
std::vector<CheckedDeformation::Moment> CheckedDeformation::moments_of(const Span& span) const {
    std::vector<Moment> moments{moment_at(span.begin)};
    while (moments.back().next_key < span.end) moments.push_back(moment_at(moments.back().next_key));
    if (span.end > span.begin) moments.push_back(moment_at(span.end));
    return moments;
}

/// Returns the box of a node at a moment. The box is interpolated between the boxes at both keys, and therefore
/// encloses the interpolated vertices.
Box3 CheckedDeformation::box_at(std::size_t node, const Moment& moment) const {
    const Box3& a = boxes_[moment.from][node];
    const Box3& b = boxes_[moment.to][node];
    const Box3 between{a.lower + moment.part * (b.lower - a.lower), a.upper + moment.part * (b.upper - a.upper)};
    return widened(between, 0x1p-45 * largest_);
}

std::shared_ptr<const ParityOracle> CheckedDeformation::oracle_at(double time) const {
    const std::lock_guard lock(oracles_->mutex);
    for (const auto& [of, oracle] : oracles_->latest) {
        if (oracle && of == time) return oracle;
    }
    TriangleMesh mesh;
    const Moment moment = moment_at(time);
    mesh.triangles = surface_.triangles;
    for (std::uint32_t v = 0; v < surface_.vertices.front().size(); ++v) mesh.vertices.push_back(position(v, moment));
    auto& slot = oracles_->latest[oracles_->next++ % oracles_->latest.size()];
    slot = {time, std::make_shared<const ParityOracle>(mesh)};
    return slot.second;
}

Side CheckedDeformation::side(const Vec3& p, double time) const { return oracle_at(time)->side(p); }

bool CheckedDeformation::is_on_surface(const Vec3& p, double time) const {
    bool is_on = false;
    visit_near({p, p}, {time, time}, [&](std::uint32_t triangle) {
        const Corners corners = corners_at(triangle, moment_at(time));
        is_on = is_on || (!on_one_line(corners.a, corners.b, corners.c) && intersects(p, p, corners));
    });
    return is_on;
}

void CheckedDeformation::find_crossings(const Segment& segment, bool is_late,
                                        std::vector<CheckedFrame::Crossing>& crossings) const {
    const Box3 box = enclosing(segment.from, segment.to);
    const Span span{segment.begin, segment.end};
    const std::vector<Moment> moments = moments_of(span);
    const bool leads_over_key = !is_late && moments.size() > 2;
    visit_near(box, span, [&](std::uint32_t triangle) {
        Box3 swept;
        for (const Moment& moment : moments) {
            const auto [a, b, c] = corners_at(triangle, moment);
            swept.include(enclosing(a, b, c));
        }
        if (!meet(box, swept)) return;
        const MovingCorners moving{corners_at(triangle, moments.front()), corners_at(triangle, moments.back())};
        if (!leads_over_key && are_apart({segment.from, segment.to}, moving)) return;
        crossings.push_back({segment.to, collider_, triangle});
    });
}

}  // namespace ricochet::verify
