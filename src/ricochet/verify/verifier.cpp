#include "ricochet/verify/verifier.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/verify/checked_deformation.h"
#include "ricochet/verify/checked_frame.h"
#include "ricochet/verify/energy.h"

namespace ricochet {
namespace {

using verify::CheckedDeformation;
using verify::CheckedFrame;

bool same_bits(const Vec3& a, const Vec3& b) {
    const auto same = [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    };
    return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}

}  // namespace

struct Verifier::Impl {
    /// The step to check, and the list that receives its violations.
    struct Judged {
        const VerifiedStep& step;
        std::vector<Violation>& violations;

        void report(ViolationKind kind, const Vec3& position, double time, std::optional<std::uint32_t> collider,
                    std::optional<std::uint32_t> triangle = std::nullopt) const {
            violations.push_back({kind, step.particle, position, time, collider, triangle});
        }
    };

    Impl(const std::vector<VerifiedSurface>& surfaces, const VerifiedMotion& motion);

    void check_chain(const Judged& judged, const VerifiedParticle& particle) const;
    void check_segment(const Judged& judged, const Segment& segment, const VerifiedParticle& particle,
                       bool starts_on_surface) const;
    void check_sides(const Judged& judged, VerifiedParticle& particle) const;
    void compare_sides(const Judged& judged, const std::vector<Side>& before, const std::vector<Side>& after) const;
    void check_distance(const Judged& judged, VerifiedParticle& particle) const;
    static void check_energy(const Judged& judged);
    [[nodiscard]] bool moves() const { return frames.size() > 1 || !deformations.empty(); }
    [[nodiscard]] std::size_t side_count() const;
    [[nodiscard]] std::vector<Side> sides_of(const Vec3& p, double time) const;
    [[nodiscard]] bool is_on_surface(const Vec3& p, double time) const;

    std::vector<CheckedFrame> frames;  ///< all frames; the first one contains the colliders at rest
    std::vector<CheckedDeformation> deformations;
};

Verifier::Impl::Impl(const std::vector<VerifiedSurface>& surfaces, const VerifiedMotion& motion) {
    frames.emplace_back(nullptr, std::nullopt);
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (const auto* deformation = std::get_if<VerifiedDeformation>(&surfaces[i])) {
            deformations.emplace_back(static_cast<std::uint32_t>(i), *deformation);
            continue;
        }
        const std::optional<std::size_t> frame = i < motion.frame_of.size() ? motion.frame_of[i] : std::nullopt;
        auto of_frame =
            std::ranges::find_if(frames, [&](const CheckedFrame& checked) { return checked.frame() == frame; });
        if (of_frame == frames.end()) of_frame = frames.insert(frames.end(), CheckedFrame(motion.frames, frame));
        of_frame->add(static_cast<std::uint32_t>(i), surfaces[i]);
    }
    for (CheckedFrame& frame : frames) frame.build();
}

std::size_t Verifier::Impl::side_count() const {
    std::size_t count = 0;
    for (const CheckedFrame& frame : frames) count += frame.side_count();
    for (const CheckedDeformation& deformation : deformations) count += deformation.is_closed() ? 1 : 0;
    return count;
}

std::vector<Side> Verifier::Impl::sides_of(const Vec3& p, double time) const {
    std::vector<Side> sides;
    sides.reserve(side_count());
    for (const CheckedFrame& frame : frames) frame.append_sides(p, time, sides);
    for (const CheckedDeformation& deformation : deformations) {
        if (deformation.is_closed()) sides.push_back(deformation.side(p, time));
    }
    return sides;
}

bool Verifier::Impl::is_on_surface(const Vec3& p, double time) const {
    return std::ranges::any_of(frames, [&](const CheckedFrame& frame) { return frame.is_on_surface(p, time); }) ||
           std::ranges::any_of(
               deformations, [&](const CheckedDeformation& deformation) { return deformation.is_on_surface(p, time); });
}

/// Checks that each segment starts where the last one ended. If colliders move, it must also start at the time when the
/// last one ended.
void Verifier::Impl::check_chain(const Judged& judged, const VerifiedParticle& particle) const {
    const VerifiedStep& step = judged.step;
    const auto expect = [&](const Vec3& at, const Vec3& next, double time_at, double time_next) {
        if (same_bits(at, next) && (!moves() || time_at == time_next)) return;
        judged.report(ViolationKind::gap, next, step.time, std::nullopt);
    };
    expect(particle.position, step.from, particle.time, particle.time);
    Vec3 at = step.from;
    double time = particle.time;
    for (const Segment& segment : step.segments) {
        expect(at, segment.from, time, segment.begin);
        at = segment.to;
        time = segment.end;
    }
    expect(at, step.to, time, step.stored_time);
}

void Verifier::Impl::check_segment(const Judged& judged, const Segment& segment, const VerifiedParticle& particle,
                                   bool starts_on_surface) const {
    // A segment between equal positions needs no check if nothing moves, because the position was checked with the
    // previous segment. If colliders move, a particle at rest still has a path through space and time.
    if (same_bits(segment.from, segment.to) && !moves()) return;
    if (!is_finite(segment.from) || !is_finite(segment.to)) {
        judged.report(ViolationKind::gap, segment.to, segment.time, std::nullopt);
        return;
    }
    std::vector<CheckedFrame::Crossing> crossings;
    for (const CheckedFrame& frame : frames) {
        const bool stays = same_bits(segment.from, segment.to) && (!frame.frame() || segment.begin == segment.end);
        if (!stays) frame.find_crossings(segment, starts_on_surface, crossings);
    }
    const bool passes = !same_bits(segment.from, segment.to) || segment.begin != segment.end;
    for (const CheckedDeformation& deformation : deformations) {
        if (passes) deformation.find_crossings(segment, segment.begin < particle.checked_until, crossings);
    }
    std::ranges::sort(crossings, [](const auto& a, const auto& b) {
        return a.collider != b.collider ? a.collider < b.collider : a.triangle < b.triangle;
    });
    for (const auto& [position, collider, triangle] : crossings) {
        judged.report(ViolationKind::crossing, position, segment.time, collider, triangle);
    }
}

/// Checks the sides of all closed surfaces. A position that is not finite has no known side. Such a position has
/// already been reported as a gap.
void Verifier::Impl::check_sides(const Judged& judged, VerifiedParticle& particle) const {
    const VerifiedStep& step = judged.step;
    if (!is_finite(step.to)) return;
    std::vector<Side> sides = sides_of(step.to, step.stored_time);
    if (particle.sides.empty()) particle.sides.assign(sides.size(), Side::on_surface);
    compare_sides(judged, particle.sides, sides);
    particle.sides = std::move(sides);
}

void Verifier::Impl::compare_sides(const Judged& judged, const std::vector<Side>& before,
                                   const std::vector<Side>& after) const {
    std::size_t first = 0;
    const auto compare = [&](std::size_t k, std::uint32_t collider) {
        if (before[k] == after[k] || before[k] == Side::on_surface) return;
        judged.report(ViolationKind::wrong_side, judged.step.to, judged.step.time, collider);
    };
    for (const CheckedFrame& frame : frames) {
        frame.visit_sides([&](std::size_t k, std::uint32_t collider) { compare(first + k, collider); });
        first += frame.side_count();
    }
    for (const CheckedDeformation& deformation : deformations) {
        if (deformation.is_closed()) compare(first++, deformation.collider());
    }
}

void Verifier::Impl::check_distance(const Judged& judged, VerifiedParticle& particle) const {
    const VerifiedStep& step = judged.step;
    if (!(step.radius > 0.0) || !is_finite(step.to)) return;
    double largest = std::max(max_abs(step.from), max_abs(step.to));
    double distance = 0.0;
    for (const Segment& segment : step.segments) {
        largest = std::max({largest, max_abs(segment.from), max_abs(segment.to)});
        distance += length(segment.to - segment.from);
    }
    struct Name {
        std::uint32_t collider;
        std::optional<std::uint32_t> triangle;
        [[nodiscard]] auto order() const { return std::pair(collider, triangle.value_or(0)); }
    };
    std::optional<Name> first;
    const auto consider = [&](std::uint32_t collider, std::optional<std::uint32_t> triangle) {
        const Name name{collider, triangle};
        if (!first || name.order() < first->order()) first = name;
    };
    for (const CheckedFrame& frame : frames) {
        frame.visit_overlapped(step.to, step.stored_time, step.radius, largest, distance, consider);
    }
    for (const CheckedDeformation& deformation : deformations) {
        deformation.visit_overlapped(step.to, step.stored_time, step.radius, largest, consider);
    }
    if (first && particle.has_been_free) {
        judged.report(ViolationKind::overlap, step.to, step.time, first->collider, first->triangle);
    }
    particle.has_been_free = !first;
}

/// Checks that surfaces at rest add no energy in any recorded part of the motion, and that each part starts in the end
/// state of the last one.
void Verifier::Impl::check_energy(const Judged& judged) {
    const VerifiedStep& step = judged.step;
    if (step.motion.parts.empty()) return;
    const auto report = [&](const RecordedMotion& motion, double time) {
        judged.report(ViolationKind::energy, motion.position, time, std::nullopt);
    };
    const RecordedMotion* at = &step.motion.before;
    for (const MotionPart& part : step.motion.parts) {
        if (part.begin != *at || verify::gains_energy(part)) report(part.begin, part.time);
        at = &part.end;
    }
    if (step.motion.after != *at) report(step.motion.after, step.time);
}

Verifier::Verifier(const std::vector<VerifiedSurface>& surfaces, const VerifiedMotion& motion)
    : impl_(std::make_shared<const Impl>(surfaces, motion)) {}
Verifier::~Verifier() = default;
Verifier::Verifier(const Verifier&) = default;
Verifier& Verifier::operator=(const Verifier&) = default;

VerifiedParticle Verifier::watch(const Vec3& position, double radius, double time) const {
    VerifiedParticle particle;
    particle.position = position;
    particle.time = time;
    particle.checked_until = time;
    if (!is_finite(position)) return particle;
    particle.sides = impl_->sides_of(position, time);
    particle.is_on_surface = std::ranges::find(particle.sides, Side::on_surface) != particle.sides.end() ||
                             impl_->is_on_surface(position, time);
    const auto overlaps = [&](std::uint32_t, std::optional<std::uint32_t>) { particle.has_been_free = false; };
    for (const auto& frame : impl_->frames) {
        frame.visit_overlapped(position, time, radius, max_abs(position), 0.0, overlaps);
    }
    for (const auto& deformation : impl_->deformations) {
        deformation.visit_overlapped(position, time, radius, max_abs(position), overlaps);
    }
    return particle;
}

void Verifier::check(const VerifiedStep& step, VerifiedParticle& particle, std::vector<Violation>& violations) const {
    const Impl::Judged judged{step, violations};
    const bool stays = step.segments.empty() && (!impl_->moves() || particle.time == step.stored_time);
    if (stays && same_bits(step.from, particle.position) && same_bits(step.to, particle.position)) {
        Impl::check_energy(judged);
        particle.checked_until = step.time;
        return;
    }
    if (!particle.sides.empty()) require_same_length(particle.sides.size(), impl_->side_count(), "sides of a particle");
    impl_->check_chain(judged, particle);
    bool starts_on_surface = particle.is_on_surface;
    for (const Segment& segment : step.segments) {
        impl_->check_segment(judged, segment, particle, starts_on_surface);
        starts_on_surface = starts_on_surface && same_bits(segment.from, segment.to);
    }
    impl_->check_sides(judged, particle);
    impl_->check_distance(judged, particle);
    Impl::check_energy(judged);
    particle.position = step.to;
    particle.time = step.stored_time;
    particle.checked_until = step.time;
    particle.is_on_surface = starts_on_surface;
}

void Verifier::check_end(std::uint64_t id, double time, const VerifiedParticle& particle,
                         std::vector<Violation>& violations) const {
    if (!(particle.time < time) || !impl_->moves() || particle.sides.empty()) return;
    const VerifiedStep end{id, particle.position, particle.position, 0.0, time, {}, {}, particle.time};
    impl_->compare_sides({end, violations}, particle.sides, impl_->sides_of(particle.position, time));
}

}  // namespace ricochet
