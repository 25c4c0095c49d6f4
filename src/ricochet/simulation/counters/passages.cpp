#include "ricochet/simulation/counters/passages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ricochet/geometry/sweep/path.h"

namespace ricochet {
namespace {

/// Number of bisections for the time of a passage. Local: more would exceed the precision of a double.
constexpr int kPassageHalvings = 64;

/// Times, in s, at which a piece of a path reaches an extreme height above a plane, in ascending order.
struct Extremes {
    std::array<double, 2> time{};
    int count = 0;

    void add(double s, double duration) {
        if (s > 0.0 && s < duration) time[static_cast<std::size_t>(count++)] = s;
    }
};

/// Returns the extremes of the height along a path. Between two extremes the height is monotonic.
Extremes extremes_of(const Path& path, const Vec3& normal, double duration) {
    const double a = 3.0 * dot(normal, path.c[3]);
    const double b = 2.0 * dot(normal, path.c[2]);
    const double c = dot(normal, path.c[1]);
    Extremes extremes;
    const double discriminant = b * b - 4.0 * a * c;
    if (!(discriminant > 0.0)) return extremes;
    // The root of larger magnitude has no cancellation. The other root follows from the product of both.
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    double first = a != 0.0 ? q / a : -1.0;
    double second = q != 0.0 ? c / q : -1.0;
    if (first > second) std::swap(first, second);
    extremes.add(first, duration);
    extremes.add(second, duration);
    return extremes;
}

bool is_still(const FlownPiece& piece) {
    return !(piece.duration > 0.0) ||
           (piece.path.c[1] == Vec3{} && piece.path.c[2] == Vec3{} && piece.path.c[3] == Vec3{});
}

/// Returns true if a single piece certainly stays on one side of a disk's plane, as most free flights do.
bool stays_on_one_side(const CounterDisk& disk, const MovedParticle& moved, std::span<const FlownPiece> pieces) {
    if (pieces.size() != 1) return false;
    const bool is_in_front = disk.is_in_front(moved.from);
    const ControlPoints hull = pieces[0].path.control_points();
    return is_in_front == disk.is_in_front(moved.to) &&
           std::ranges::all_of(hull, [&](const Vec3& point) { return disk.is_in_front(point) == is_in_front; });
}

/// Follows one particle and finds its passages through one disk.
class DiskTrace {
public:
    DiskTrace(const CounterDisk& disk, const Vec3& from) : disk_(disk), is_in_front_(disk.is_in_front(from)) {}

    /// Follows a path for a duration, in s. next: stored position at which the particle continues. It replaces the end
    /// of the path, because after a contact the particle continues at a safe position.
    template <class Report>
    void follow(const Path& path, double duration, const Vec3& next, const Report& report) {
        double from = 0.0;
        const Extremes extremes = extremes_of(path, disk_.normal(), duration);
        for (int k = 0; k < extremes.count; ++k) {
            const double to = extremes.time[static_cast<std::size_t>(k)];
            pass(path, from, to, disk_.is_in_front(path.position(to)), report);
            from = to;
        }
        pass(path, from, duration, disk_.is_in_front(next), report);
    }

private:
    template <class Report>
    void pass(const Path& path, double from, double to, bool is_in_front, const Report& report) {
        if (is_in_front == is_in_front_) return;
        for (int k = 0; k < kPassageHalvings; ++k) {
            const double middle = 0.5 * (from + to);
            (disk_.is_in_front(path.position(middle)) == is_in_front ? to : from) = middle;
        }
        is_in_front_ = is_in_front;
        if (disk_.contains(path.position(to))) report(is_in_front);
    }

    const CounterDisk& disk_;
    bool is_in_front_;
};

}  // namespace

CounterDisk::CounterDisk(const CounterDescription& counter)
    : center_(counter.center), normal_(normalized(counter.normal / max_abs(counter.normal))), radius_(counter.radius) {}

bool CounterDisk::contains(const Vec3& position) const {
    const Vec3 offset = position - center_;
    return length(offset - dot(normal_, offset) * normal_) <= radius_;
}

PassageFinder::PassageFinder(std::span<const CounterDescription> counters) : disks_(counters.begin(), counters.end()) {}

void PassageFinder::trace(const MovedParticle& moved, std::span<const FlownPiece> pieces,
                          std::vector<Passage>& passages) const {
    if (!is_finite(moved.from) || !is_finite(moved.to)) return;
    const auto next_moving = [&](std::size_t k) {
        while (k < pieces.size() && is_still(pieces[k])) ++k;
        return k;
    };
    const std::size_t first = next_moving(0);
    for (std::uint32_t n = 0; n < disks_.size(); ++n) {
        const auto report = [&](bool is_forward) { passages.push_back({n, is_forward, moved.id, moved.mass}); };
        if (stays_on_one_side(disks_[n], moved, pieces)) continue;
        DiskTrace trace(disks_[n], moved.from);
        const Vec3& start = first < pieces.size() ? pieces[first].path.c[0] : moved.to;
        if (start != moved.from) trace.follow(line_path(moved.from, start - moved.from, 1.0), 1.0, start, report);
        for (std::size_t k = first; k < pieces.size();) {
            const std::size_t next = next_moving(k + 1);
            const Vec3& end = next < pieces.size() ? pieces[next].path.c[0] : moved.to;
            trace.follow(pieces[k].path, pieces[k].duration, end, report);
            k = next;
        }
    }
}

void PassageFinder::trace(const MovedParticle& moved, std::span<const Segment> segments,
                          std::vector<Passage>& passages) const {
    std::vector<FlownPiece> pieces;
    for (const Segment& segment : segments) {
        pieces.push_back({line_path(segment.from, segment.to - segment.from, 1.0), 0.0, 1.0, {}, {}, false});
    }
    trace(moved, pieces, passages);
}

}  // namespace ricochet
