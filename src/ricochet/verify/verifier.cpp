#include "ricochet/verify/verifier.h"
#include "ricochet/verify/parity.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <optional>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/verify/checked_shape.h"
#include "ricochet/verify/energy.h"
#include "ricochet/verify/triangle_tests.h"
#include "ricochet/verify/triangle_tree.h"

namespace ricochet {
namespace {

using verify::CheckedShape;
using verify::NamedTriangle;
using verify::TriangleTree;

template <class T>
struct OfCollider {
    std::uint32_t collider;
    T surface;
};

bool same_bits(const Vec3& a, const Vec3& b) {
    const auto same = [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    };
    return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}

void add_triangles(const TriangleMesh& mesh, std::uint32_t collider, std::vector<NamedTriangle>& triangles) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = mesh.triangles[t];
        const verify::Corners corners{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
        if (verify::on_one_line(corners.a, corners.b, corners.c)) continue;
        triangles.push_back({corners, collider, static_cast<std::uint32_t>(t)});
    }
}

void require(bool condition, const char* what) {
    if (!condition) throw InputError(what);
}

void require_good(const TriangleMesh& mesh) {
    require_corners(mesh);
    require(std::all_of(mesh.vertices.begin(), mesh.vertices.end(), is_finite),
            "verified mesh: found a vertex that is not finite");
}

Side side_of(int sign) { return sign > 0 ? Side::outside : (sign < 0 ? Side::inside : Side::on_surface); }

}  // namespace

struct Verifier::Impl {
    /// What one step is judged by.
    struct Judged {
        const VerifiedStep& step;
        std::vector<Violation>& violations;

        void report(ViolationKind kind, const Vec3& position, double time, std::optional<std::uint32_t> collider,
                    std::optional<std::uint32_t> triangle = std::nullopt) const {
            violations.push_back({kind, step.particle, position, time, collider, triangle});
        }
    };

    explicit Impl(const std::vector<VerifiedSurface>& surfaces);

    void check_chain(const Judged& judged, const Vec3& before) const;
    void check_segment(const Judged& judged, const Segment& segment, bool starts_on_surface) const;
    void check_sides(const Judged& judged, VerifiedParticle& particle) const;
    void check_distance(const Judged& judged, VerifiedParticle& particle) const;
    static void check_energy(const Judged& judged);
    [[nodiscard]] std::size_t side_count() const { return planes.size() + shapes.size() + bodies.size(); }
    [[nodiscard]] std::vector<Side> sides_of(const Vec3& p) const;
    [[nodiscard]] bool is_on_surface(const Vec3& p) const;
    /// Calls found(collider, triangle or nothing) for every surface that is nearer to p than `least`, in no fixed
    /// order.
    template <class Found>
    void visit_nearer(const Vec3& p, double least, const Found& found) const;

    std::vector<OfCollider<VerifiedPlane>> planes;
    std::vector<OfCollider<CheckedShape>> shapes;
    std::vector<OfCollider<ParityOracle>> bodies;  ///< closed meshes
    TriangleTree triangles;
};

Verifier::Impl::Impl(const std::vector<VerifiedSurface>& surfaces) {
    std::vector<NamedTriangle> all;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const auto collider = static_cast<std::uint32_t>(i);
        if (const auto* mesh = std::get_if<TriangleMesh>(&surfaces[i])) {
            require_good(*mesh);
            add_triangles(*mesh, collider, all);
            if (count_open_edges(*mesh) == 0) bodies.push_back({collider, ParityOracle(*mesh)});
        } else if (const auto* plane = std::get_if<VerifiedPlane>(&surfaces[i])) {
            require(is_finite(plane->point) && is_finite(plane->normal) && max_abs(plane->normal) > 0.0,
                    "verified plane: expected finite numbers and a normal above 0");
            planes.push_back({collider, *plane});
        } else {
            const auto& shape = std::get<VerifiedShape>(surfaces[i]);
            const AffineMap& map = shape.world_from_unit;
            require(is_finite(map.row_x) && is_finite(map.row_y) && is_finite(map.row_z) &&
                        is_finite(map.translation) && map.determinant() != 0.0,
                    "verified shape: expected finite numbers and a volume");
            shapes.push_back({collider, CheckedShape(shape.world_from_unit, shape.is_cylinder)});
        }
    }
    triangles = TriangleTree(std::move(all));
}

std::vector<Side> Verifier::Impl::sides_of(const Vec3& p) const {
    std::vector<Side> sides;
    sides.reserve(side_count());
    for (const auto& [collider, plane] : planes) {
        sides.push_back(side_of(verify::height_sign(plane.normal, plane.point, p)));
    }
    for (const auto& [collider, shape] : shapes) sides.push_back(side_of(shape.side(p)));
    for (const auto& [collider, body] : bodies) sides.push_back(body.side(p));
    return sides;
}

bool Verifier::Impl::is_on_surface(const Vec3& p) const {
    bool is_on = false;
    triangles.near_segment(p, p, [&](const NamedTriangle& t) { is_on = is_on || verify::intersects(p, p, t.corners); });
    return is_on;
}

template <class Found>
void Verifier::Impl::visit_nearer(const Vec3& p, double least, const Found& found) const {
    for (const auto& [collider, plane] : planes) {
        if (verify::is_nearer(p, plane.point, plane.normal, least)) found(collider, std::nullopt);
    }
    for (const auto& [collider, shape] : shapes) {
        if (shape.is_nearer(p, least)) found(collider, std::nullopt);
    }
    const double padded = (1.0 + 0x1p-40) * least + 0x1p-40 * max_abs(p);
    const Vec3 reach{padded, padded, padded};
    triangles.near_box({p - reach, p + reach}, [&](const NamedTriangle& t) {
        if (verify::is_nearer(p, t.corners, least)) found(t.collider, t.triangle);
    });
}

void Verifier::Impl::check_chain(const Judged& judged, const Vec3& before) const {
    const VerifiedStep& step = judged.step;
    const auto expect = [&](const Vec3& at, const Vec3& next) {
        if (!same_bits(at, next)) judged.report(ViolationKind::gap, next, step.time, std::nullopt);
    };
    expect(before, step.from);
    Vec3 at = step.from;
    for (const Segment& segment : step.segments) {
        expect(at, segment.from);
        at = segment.to;
    }
    expect(at, step.to);
}

/// A particle that stands on surfaces at the segment's start may leave them to either side.
void Verifier::Impl::check_segment(const Judged& judged, const Segment& segment, bool starts_on_surface) const {
    const Vec3& p = segment.from;
    const Vec3& q = segment.to;
    if (same_bits(p, q)) return;  // its position belongs to the segment before
    if (!is_finite(p) || !is_finite(q)) {
        judged.report(ViolationKind::gap, q, segment.time, std::nullopt);
        return;
    }
    const std::size_t first = judged.violations.size();
    for (const auto& [collider, plane] : planes) {
        const int of_p = verify::height_sign(plane.normal, plane.point, p);
        const int of_q = verify::height_sign(plane.normal, plane.point, q);
        const bool leaves = starts_on_surface && of_p == 0 && of_q != 0;
        if (of_p * of_q <= 0 && !leaves) judged.report(ViolationKind::crossing, q, segment.time, collider);
    }
    for (const auto& [collider, shape] : shapes) {
        if (!shape.intersects(p, q)) continue;
        const bool leaves = starts_on_surface && shape.side(p) == 0 && !shape.intersects_after_start(p, q);
        if (!leaves) judged.report(ViolationKind::crossing, q, segment.time, collider);
    }
    triangles.near_segment(p, q, [&](const NamedTriangle& t) {
        if (!verify::intersects(p, q, t.corners)) return;
        if (starts_on_surface && !verify::intersects_after_start(p, q, t.corners)) return;
        judged.report(ViolationKind::crossing, verify::crossing_point(p, q, t.corners), segment.time, t.collider,
                      t.triangle);
    });
    std::sort(judged.violations.begin() + static_cast<std::ptrdiff_t>(first), judged.violations.end(),
              [](const Violation& a, const Violation& b) {
                  return a.collider != b.collider ? a.collider < b.collider : a.triangle < b.triangle;
              });
}

/// A position that is not finite is on no known side; that it was reached has been reported as a gap.
void Verifier::Impl::check_sides(const Judged& judged, VerifiedParticle& particle) const {
    const VerifiedStep& step = judged.step;
    if (!is_finite(step.to)) return;
    std::vector<Side> sides = sides_of(step.to);
    if (particle.sides.empty()) particle.sides.assign(sides.size(), Side::on_surface);
    const auto compare = [&](std::size_t k, std::uint32_t collider) {
        if (particle.sides[k] == sides[k] || particle.sides[k] == Side::on_surface) return;
        judged.report(ViolationKind::wrong_side, step.to, step.time, collider);
    };
    std::size_t k = 0;
    for (const auto& plane : planes) compare(k++, plane.collider);
    for (const auto& shape : shapes) compare(k++, shape.collider);
    for (const auto& body : bodies) compare(k++, body.collider);
    particle.sides = std::move(sides);
}

void Verifier::Impl::check_distance(const Judged& judged, VerifiedParticle& particle) const {
    const VerifiedStep& step = judged.step;
    if (!(step.radius > 0.0) || !is_finite(step.to)) return;
    double largest = std::max(max_abs(step.from), max_abs(step.to));
    for (const Segment& segment : step.segments)
        largest = std::max({largest, max_abs(segment.from), max_abs(segment.to)});
    const double least = step.radius - sphere_tolerance(step.radius, largest);
    if (!(least > 0.0)) return;
    struct Name {
        std::uint32_t collider;
        std::optional<std::uint32_t> triangle;
        [[nodiscard]] auto order() const { return std::pair(collider, triangle.value_or(0)); }
    };
    std::optional<Name> first;
    visit_nearer(step.to, least, [&](std::uint32_t collider, std::optional<std::uint32_t> triangle) {
        const Name name{collider, triangle};
        if (!first || name.order() < first->order()) first = name;
    });
    if (first && particle.has_been_free) {
        judged.report(ViolationKind::overlap, step.to, step.time, first->collider, first->triangle);
    }
    particle.has_been_free = !first;
}

/// What surfaces at rest do gives no energy, part by part; and nothing is left out.
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

Verifier::Verifier(const std::vector<VerifiedSurface>& surfaces) : impl_(std::make_shared<const Impl>(surfaces)) {}
Verifier::~Verifier() = default;
Verifier::Verifier(const Verifier&) = default;
Verifier& Verifier::operator=(const Verifier&) = default;

VerifiedParticle Verifier::watch(const Vec3& position, double radius) const {
    VerifiedParticle particle;
    particle.position = position;
    if (!is_finite(position)) return particle;
    particle.sides = impl_->sides_of(position);
    particle.is_on_surface =
        std::find(particle.sides.begin(), particle.sides.end(), Side::on_surface) != particle.sides.end() ||
        impl_->is_on_surface(position);
    const double least = radius - sphere_tolerance(radius, max_abs(position));
    if (least > 0.0) {
        impl_->visit_nearer(position, least,
                            [&](std::uint32_t, std::optional<std::uint32_t>) { particle.has_been_free = false; });
    }
    return particle;
}

void Verifier::check(const VerifiedStep& step, VerifiedParticle& particle, std::vector<Violation>& violations) const {
    const Impl::Judged judged{step, violations};
    if (step.segments.empty() && same_bits(step.from, particle.position) && same_bits(step.to, particle.position)) {
        Impl::check_energy(judged);
        return;
    }
    if (!particle.sides.empty()) require_same_length(particle.sides.size(), impl_->side_count(), "sides of a particle");
    impl_->check_chain(judged, particle.position);
    bool starts_on_surface = particle.is_on_surface;
    for (const Segment& segment : step.segments) {
        impl_->check_segment(judged, segment, starts_on_surface);
        starts_on_surface = starts_on_surface && same_bits(segment.from, segment.to);
    }
    impl_->check_sides(judged, particle);
    impl_->check_distance(judged, particle);
    Impl::check_energy(judged);
    particle.position = step.to;
    particle.is_on_surface = starts_on_surface;
}

}  // namespace ricochet
