/// \file
/// Where the vertices of a mesh that deforms are: at given times, the keys, and between two of them each on a straight
/// line at constant speed.
///
/// Where a vertex is at a time is one formula, MeshMoment::position(), always rounded the same way: what is proved of
/// stored positions of particles is proved for the mesh as that says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// What holds before the first and after the last key.
enum class MeshEnds : std::uint8_t {
    hold,    ///< the first and the last positions, at rest
    repeat,  ///< the keys again and again; the last positions are the first ones
};

/// The vertices at one time.
struct MeshMoment {
    std::span<const Vec3> from;  ///< m, at the key before
    std::span<const Vec3> to;    ///< m, at the key after
    double part = 0.0;           ///< of the time between both that has passed, in [0, 1)
    double duration = 0.0;       ///< s, between both; 0: they stand still

    /// Of a vertex, m: fl(from + fl(part fl(to - from))), componentwise; exactly `from` at a key.
    [[nodiscard]] Vec3 position(std::size_t vertex) const {
        const Vec3& begin = from[vertex];
        return part == 0.0 ? begin : begin + part * (to[vertex] - begin);
    }
    /// Of a vertex, m/s; at a key what comes after it.
    [[nodiscard]] Vec3 velocity(std::size_t vertex) const {
        return duration > 0.0 ? (to[vertex] - from[vertex]) / duration : Vec3{};
    }
};

/// Immutable; safe from any number of threads.
class MeshMotion {
public:
    /// times: of the keys, s, ascending by more than rounding; positions: m, of all vertices at each. Throws InputError
    /// for less than two keys, numbers that are not finite or beyond 1e75, other numbers of vertices than at the first
    /// key, and, where it repeats, last positions that are not the first.
    MeshMotion(std::vector<double> times, std::vector<std::vector<Vec3>> positions, MeshEnds ends = MeshEnds::hold);

    [[nodiscard]] std::size_t vertex_count() const { return positions_.front().size(); }
    [[nodiscard]] std::size_t key_count() const { return times_.size(); }
    [[nodiscard]] std::span<const double> times() const { return times_; }
    /// m, at a key of that number, below key_count().
    [[nodiscard]] std::span<const Vec3> positions(std::size_t key) const { return positions_[key]; }
    [[nodiscard]] MeshEnds ends() const { return ends_; }

    /// Where the vertices are at a time, s. Valid as long as this is.
    [[nodiscard]] MeshMoment at(double time) const;
    /// The first key after a time, s; infinite when there is none. Rounds of keys that repeat begin at
    /// fl(times[k] + fl(round * period)).
    [[nodiscard]] double next_key(double time) const;
    /// The same motion with every position mapped. Throws InputError for what is beyond 1e75 then.
    [[nodiscard]] MeshMotion mapped(const AffineMap& map) const;
    /// Bytes that it holds.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    /// Number of a key among those of all rounds, and its time, s.
    [[nodiscard]] double key_time(std::int64_t key) const;
    [[nodiscard]] std::int64_t key_before(double time) const;
    [[nodiscard]] std::size_t keys_a_round() const { return times_.size() - 1; }

    std::vector<double> times_;
    std::vector<std::vector<Vec3>> positions_;
    MeshEnds ends_;
};

/// The motion that a function gives: the positions of all vertices, m, at a time, s, sampled at the times given.
/// Throws InputError as MeshMotion does.
[[nodiscard]] MeshMotion sampled_motion(const std::function<std::vector<Vec3>(double time)>& positions_at,
                                        std::vector<double> times, MeshEnds ends = MeshEnds::hold);

}  // namespace ricochet
