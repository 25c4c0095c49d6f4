/// \file
/// Motion of the vertices of a deforming mesh. Positions are given at times that are called keys. Between two keys each
/// vertex moves along a straight line at constant speed.
///
/// MeshMoment::position() is the only formula for the position of a vertex, and it always rounds in the same way.
/// Proofs about stored positions of particles therefore apply to the mesh that this formula defines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// The motion before the first and after the last key.
enum class MeshEnds : std::uint8_t {
    hold,    ///< the mesh rests at the first or the last positions
    repeat,  ///< the keys repeat; the last positions equal the first ones
};

/// The vertices at one time.
struct MeshMoment {
    std::span<const Vec3> from;  ///< in m, at the previous key
    std::span<const Vec3> to;    ///< in m, at the next key
    double part = 0.0;           ///< elapsed fraction of the time between both keys, in [0, 1)
    double duration = 0.0;       ///< in s, between both keys; 0: the vertices are at rest

    /// Returns the position of a vertex, in m: fl(from + fl(part fl(to - from))), componentwise. It is exactly `from`
    /// at a key.
    [[nodiscard]] Vec3 position(std::size_t vertex) const {
        const Vec3& begin = from[vertex];
        return part == 0.0 ? begin : begin + part * (to[vertex] - begin);
    }
    /// Returns the velocity of a vertex, in m/s. At a key it is the velocity after the key.
    [[nodiscard]] Vec3 velocity(std::size_t vertex) const {
        return duration > 0.0 ? (to[vertex] - from[vertex]) / duration : Vec3{};
    }
};

/// Motion of all vertices of a mesh. Immutable, so it is safe from any number of threads.
class MeshMotion {
public:
    /// Makes a motion from keys. times: of the keys, in s, ascending by more than rounding. positions: of all vertices
    /// at each key, in m. Throws InputError in these cases:
    /// - Fewer than two keys.
    /// - Numbers that are not finite or beyond 1e75.
    /// - A number of vertices that differs from the first key.
    /// - Repeating keys whose last positions differ from the first.
    MeshMotion(std::vector<double> times, std::vector<std::vector<Vec3>> positions, MeshEnds ends = MeshEnds::hold);

    [[nodiscard]] std::size_t vertex_count() const { return positions_.front().size(); }
    [[nodiscard]] std::size_t key_count() const { return times_.size(); }
    [[nodiscard]] std::span<const double> times() const { return times_; }
    /// Returns the positions at a key, in m. The index is below key_count().
    [[nodiscard]] std::span<const Vec3> positions(std::size_t key) const { return positions_[key]; }
    [[nodiscard]] MeshEnds ends() const { return ends_; }

    /// Returns the vertices at a time, in s. The result is valid as long as this object exists.
    [[nodiscard]] MeshMoment at(double time) const;
    /// Returns the time of the first key after a time, in s, or infinity if there is none. Key k of a round of
    /// repeating keys is at fl(times[k] + fl(round * period)).
    [[nodiscard]] double next_key(double time) const;
    /// Returns the motion with every position transformed by a map. Throws InputError if a mapped position is beyond
    /// 1e75.
    [[nodiscard]] MeshMotion mapped(const AffineMap& map) const;
    /// Returns the bytes in use.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    /// Returns the time, in s, of a key that is numbered across all rounds.
    [[nodiscard]] double key_time(std::int64_t key) const;
    [[nodiscard]] std::int64_t key_before(double time) const;
    [[nodiscard]] std::size_t keys_a_round() const { return times_.size() - 1; }

    std::vector<double> times_;
    std::vector<std::vector<Vec3>> positions_;
    MeshEnds ends_;
};

/// Returns a motion whose keys are samples of a function at the given times. positions_at(time) returns the positions
/// of all vertices, in m, at a time, in s. Throws InputError like MeshMotion.
[[nodiscard]] MeshMotion sampled_motion(const std::function<std::vector<Vec3>(double time)>& positions_at,
                                        std::vector<double> times, MeshEnds ends = MeshEnds::hold);

}  // namespace ricochet
