/// \file
/// A deforming mesh in world coordinates. Private to the verifier.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/segment.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/verify/boxes.h"
#include "ricochet/verify/checked_frame.h"
#include "ricochet/verify/item_tree.h"
#include "ricochet/verify/parity.h"
#include "ricochet/verify/triangle_tests.h"
#include "ricochet/verify/verifier.h"

namespace ricochet::verify {

/// A deforming mesh that the verifier checks. Between the keys a and b, the position of a vertex is defined as fl(a +
/// fl(part fl(b - a))), as in MeshMoment. fl() is rounding to double. This class evaluates the definition with its own
/// code. It is thread-safe.
class CheckedDeformation {
public:
    /// Throws InputError for invalid motions and for corner indices without a vertex.
    CheckedDeformation(std::uint32_t collider, VerifiedDeformation surface);

    [[nodiscard]] std::uint32_t collider() const { return collider_; }
    /// Returns true if the mesh encloses a volume. side() is defined only for such meshes.
    [[nodiscard]] bool is_closed() const { return is_closed_; }
    [[nodiscard]] Side side(const Vec3& p, double time) const;
    [[nodiscard]] bool is_on_surface(const Vec3& p, double time) const;
    /// Appends the crossings of a segment that a particle has travelled. A triangle is crossed unless the segment is
    /// proven to be apart from it in space and time. Near the mesh, a segment must also end at each key of the mesh;
    /// otherwise a crossing is reported. A late segment (`is_late`) belongs to a particle that was stalled, and may
    /// extend over keys. The test then assumes that corners move in straight lines between the ends of the segment.
    void find_crossings(const Segment& segment, bool is_late, std::vector<CheckedFrame::Crossing>& crossings) const;
    /// Calls found(collider, triangle) for every triangle that overlaps a sphere about the point p, see CheckedFrame.
    template <class Found>
    void visit_overlapped(const Vec3& p, double time, double radius, double largest, const Found& found) const {
        const double least = radius - sphere_tolerance(radius, largest);
        if (!(least > 0.0)) return;
        const double padded = (1.0 + 0x1p-40) * least + 0x1p-40 * max_abs(p);
        visit_near(widened({p, p}, padded), {time, time}, [&](std::uint32_t triangle) {
            if (is_nearer(p, corners_at(triangle, moment_at(time)), least)) {
                found(collider_, std::optional<std::uint32_t>(triangle));
            }
        });
    }

private:
    /// A time, expressed by the two keys around it.
    struct Moment {
        std::size_t from = 0;  ///< index of the key before the time
        std::size_t to = 0;
        double part = 0.0;
        double next_key = 0.0;  ///< time of the next key, in s; infinite after the last key
    };
    struct Span {
        double begin = 0.0;
        double end = 0.0;
    };
    struct Oracles {
        std::mutex mutex;
        std::array<std::pair<double, std::shared_ptr<const ParityOracle>>, 4> latest;
        std::size_t next = 0;
    };

    [[nodiscard]] Moment moment_at(double time) const;
    [[nodiscard]] Vec3 position(std::uint32_t vertex, const Moment& moment) const;
    [[nodiscard]] Corners corners_at(std::uint32_t triangle, const Moment& moment) const;
    [[nodiscard]] std::vector<Moment> moments_of(const Span& span) const;
    [[nodiscard]] Box3 box_at(std::size_t node, const Moment& moment) const;
    [[nodiscard]] std::shared_ptr<const ParityOracle> oracle_at(double time) const;

    /// Calls visit(triangle) for all triangles that touch a box within a time span, and possibly for further triangles.
    template <class Visit>
    void visit_near(const Box3& box, const Span& span, const Visit& visit) const {
        const std::vector<Moment> moments = moments_of(span);
        const auto meets = [&](std::uint32_t node) {
            Box3 swept;
            for (const Moment& moment : moments) swept.include(box_at(node, moment));
            return meet(box, swept);
        };
        tree_.visit(meets, [&](std::uint32_t k) { visit(order_[k]); });
    }

    std::uint32_t collider_;
    VerifiedDeformation surface_;
    bool is_closed_ = false;
    double largest_ = 0.0;  ///< largest coordinate, in m
    ItemTree tree_;
    std::vector<std::uint32_t> order_;      ///< triangles in the order of the tree's leaves
    std::vector<std::vector<Box3>> boxes_;  ///< boxes of the tree's nodes, at each key
    std::unique_ptr<Oracles> oracles_ = std::make_unique<Oracles>();
};

}  // namespace ricochet::verify
