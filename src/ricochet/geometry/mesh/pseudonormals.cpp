#include "ricochet/geometry/mesh/pseudonormals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/mesh/edge_table.h"
#include "ricochet/geometry/mesh/vertex_welder.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/point_sweep.h"

namespace ricochet {
namespace {

/// Value that marks a triangle without area. It replaces the first neighbour.
constexpr std::uint32_t kLeftOut = std::numeric_limits<std::uint32_t>::max();
/// Offset that is added to indices of irregular edges, to distinguish them from indices of triangles.
constexpr std::uint32_t kIrregularEdge = 1U << 31U;

/// Returns the arc tangent of t in [0, 1] within about 2^-51. The system's function is not used, because its last bit
/// can differ between systems. Method: halves the angle three times by tan(x / 2) = t / (1 + sqrt(1 + t^2)), then sums
/// the series.
double arc_tangent(double t) {
    for (int k = 0; k < 3; ++k) t /= 1.0 + std::sqrt(1.0 + t * t);
    const double square = t * t;  // below 0.0098, so the next term is below 2^-64
    double sum = 0.0;
    for (int k = 8; k >= 0; --k) sum = 1.0 / (2 * k + 1) - square * sum;
    return 8.0 * t * sum;
}

/// Returns the angle between two nonzero directions, in rad, within about 2^-50. The angle is twice the arc tangent of
/// |p - q| / |p + q| for the unit vectors p and q. Method: W. Kahan, "How Futile are Mindless Assessments of Roundoff
/// in Floating-Point Computation?", 2006, section 12.
double angle_between(const Vec3& u, const Vec3& v) {
    const Vec3 p = normalized(u / max_abs(u));
    const Vec3 q = normalized(v / max_abs(v));
    const double across = length(p - q);
    const double along = length(p + q);
    return across <= along ? 2.0 * arc_tangent(across / along) : std::numbers::pi - 2.0 * arc_tangent(along / across);
}

Vec3 zero_if_cancelled(const Vec3& mean) { return max_abs(mean) <= kPseudonormalRounding ? Vec3{} : mean; }

/// Signed distance from a triangle's plane with its error, which matters for slender triangles.
struct Height {
    double value;
    double error;
};

Height height_over(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const double value = signed_distance(p, a, b, c);
    const double slenderness = length(b - a) * length(c - a) / length(cross(b - a, c - a));
    return {value, 0x1p-49 * (1.0 + slenderness) * std::fabs(value)};
}

}  // namespace

Pseudonormals::Pseudonormals(std::span<const Vec3> vertices, std::span<const Triangle> triangles)
    : vertices_(vertices), triangles_(triangles), sides_(triangles.size()) {
    const std::size_t vertex_count = weld();
    link_edges(vertex_count);
    sum_at_vertices(vertex_count);
}

std::size_t Pseudonormals::weld() {
    if (triangles_.empty()) return 0;
    first_vertex_ = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t last = 0;
    for (const Triangle& t : triangles_) {
        for (const std::uint32_t v : t) {
            first_vertex_ = std::min(first_vertex_, v);
            last = std::max(last, v);
        }
    }
    std::vector<Vec3> positions;
    VertexWelder welder(positions);
    welded_.reserve(last - first_vertex_ + 1);
    for (std::size_t v = first_vertex_; v <= last; ++v) welded_.push_back(welder.index_of(vertices_[v]));
    return positions.size();
}

void Pseudonormals::link_edges(std::size_t vertex_count) {
    std::vector<std::uint32_t> live;
    FaceList faces;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const auto& [a, b, c] = triangles_[t];
        sides_[t][0] = kLeftOut;
        if (are_collinear(vertices_[a], vertices_[b], vertices_[c])) continue;
        live.push_back(t);
        const auto first = static_cast<std::uint32_t>(faces.corners.size());
        for (const std::uint32_t k : {0U, 1U, 2U}) {
            faces.corners.push_back(welded(t, k));
            faces.next_corner.push_back(first + (k + 1) % 3);
        }
    }
    vertex_is_open_.assign(vertex_count, 0);
    const EdgeTable edges(faces, vertex_count);
    std::vector<TriangleSide> sides;
    edges.for_each_edge([&](std::span<const std::uint32_t> corners) {
        sides.clear();
        for (const std::uint32_t corner : corners) sides.push_back({live[corner / 3], corner % 3});
        link_edge(sides);
    });
    std::sort(copies_.begin(), copies_.end());
}

void Pseudonormals::link_edge(std::span<const TriangleSide> sides) {
    record_copies(sides);
    if (sides.size() == 2) {
        sides_[sides[0].triangle][sides[0].side] = sides[1].triangle;
        sides_[sides[1].triangle][sides[1].side] = sides[0].triangle;
        return;
    }
    IrregularEdge edge;
    edge.is_open = sides.size() % 2 == 1;
    for (const auto& [triangle, side] : sides) {
        edge.normal += unit_normal_of(triangle);
        sides_[triangle][side] = kIrregularEdge + static_cast<std::uint32_t>(irregular_edges_.size());
        if (!edge.is_open) continue;
        vertex_is_open_[welded(triangle, side)] = 1;
        vertex_is_open_[welded(triangle, (side + 1) % 3)] = 1;
    }
    edge.normal = zero_if_cancelled(edge.normal / static_cast<double>(sides.size()));
    irregular_edges_.push_back(edge);
}

/// Records triangles that are listed several times. Copies share all their edges, so each copy is recorded only at the
/// edge opposite to its largest vertex.
void Pseudonormals::record_copies(std::span<const TriangleSide> sides) {
    struct Use {
        std::uint32_t opposite;
        std::uint32_t triangle;
        int direction;
    };
    std::vector<Use> uses;
    for (const auto& [triangle, side] : sides) {
        const std::uint32_t from = welded(triangle, side);
        const std::uint32_t to = welded(triangle, (side + 1) % 3);
        const std::uint32_t opposite = welded(triangle, (side + 2) % 3);
        if (opposite > std::max(from, to)) uses.push_back({opposite, triangle, from < to ? 1 : -1});
    }
    std::sort(uses.begin(), uses.end(), [](const Use& x, const Use& y) {
        return x.opposite != y.opposite ? x.opposite < y.opposite : x.triangle < y.triangle;
    });
    for (auto first = uses.begin(); first != uses.end();) {
        int excess = 0;
        auto end = first;
        for (; end != uses.end() && end->opposite == first->opposite; ++end) excess += end->direction;
        if (end - first > 1) {
            for (auto use = first; use != end; ++use) {
                copies_.emplace_back(use->triangle, sign_beyond(excess * use->direction, 0.0));
            }
        }
        first = end;
    }
}

void Pseudonormals::sum_at_vertices(std::size_t vertex_count) {
    at_vertex_.assign(vertex_count, {});
    std::vector<double> weights(vertex_count, 0.0);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        if (is_left_out(t)) continue;
        const Vec3 normal = unit_normal_of(t);
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3& at = vertices_[triangles_[t][corner]];
            const double angle = angle_between(vertices_[triangles_[t][(corner + 1) % 3]] - at,
                                               vertices_[triangles_[t][(corner + 2) % 3]] - at);
            at_vertex_[welded(t, corner)] += angle * normal;
            weights[welded(t, corner)] += angle;
        }
    }
    for (std::size_t v = 0; v < vertex_count; ++v) {
        at_vertex_[v] = weights[v] > 0.0 ? zero_if_cancelled(at_vertex_[v] / weights[v]) : Vec3{};
    }
}

bool Pseudonormals::is_left_out(std::uint32_t triangle) const { return sides_[triangle][0] == kLeftOut; }

std::uint32_t Pseudonormals::welded(std::uint32_t triangle, std::size_t corner) const {
    return welded_[triangles_[triangle][corner] - first_vertex_];
}

Vec3 Pseudonormals::unit_normal_of(std::uint32_t triangle) const {
    const auto& [a, b, c] = triangles_[triangle];
    return unit_normal(vertices_[a], vertices_[b], vertices_[c]);
}

int Pseudonormals::excess_of(std::uint32_t triangle) const {
    if (copies_.empty()) return 1;
    const auto at = std::lower_bound(copies_.begin(), copies_.end(), triangle,
                                     [](const auto& copy, std::uint32_t t) { return copy.first < t; });
    return at != copies_.end() && at->first == triangle ? at->second : 1;
}

Vec3 Pseudonormals::of_edge(std::uint32_t triangle, std::size_t side) const {
    const Neighbour beyond = sides_[triangle][side];
    if (beyond >= kIrregularEdge) return irregular_edges_[beyond - kIrregularEdge].normal;
    return zero_if_cancelled(0.5 * (unit_normal_of(triangle) + unit_normal_of(beyond)));
}

Vec3 Pseudonormals::of(std::uint32_t triangle, TriangleFeature feature) const {
    if (feature == TriangleFeature::kFace) return static_cast<double>(excess_of(triangle)) * unit_normal_of(triangle);
    const std::size_t number = number_of(feature);
    return rank(feature) == 2 ? at_vertex_[welded(triangle, number)] : of_edge(triangle, number);
}

int Pseudonormals::side(std::uint32_t triangle, const ClosestPointOnTriangle& nearest, const Vec3& p) const {
    if (nearest.feature == TriangleFeature::kFace) return excess_of(triangle) * side_of_face(triangle, p);
    const std::size_t number = number_of(nearest.feature);
    if (rank(nearest.feature) == 1) return side_of_edge(triangle, number, p);
    return sign_beyond(dot(nearest.offset, at_vertex_[welded(triangle, number)]),
                       kPseudonormalRounding * length(nearest.offset));
}

int Pseudonormals::side_of_face(std::uint32_t triangle, const Vec3& p) const {
    const auto& [a, b, c] = triangles_[triangle];
    return orient3d(vertices_[a], vertices_[b], vertices_[c], p);
}

/// The offset is measured from the nearer end, because the rounding of its component along the edge is then smallest.
/// This component should not contribute to the scalar product.
int Pseudonormals::side_of_edge(std::uint32_t triangle, std::size_t side, const Vec3& p) const {
    const Vec3 from_start = p - vertices_[triangles_[triangle][side]];
    const Vec3 from_end = p - vertices_[triangles_[triangle][(side + 1) % 3]];
    const Vec3& offset = length_squared(from_start) <= length_squared(from_end) ? from_start : from_end;
    const int decided = sign_beyond(dot(offset, of_edge(triangle, side)), kPseudonormalRounding * length(offset));
    if (decided != 0) return decided;
    const Neighbour beyond = sides_[triangle][side];
    return beyond < kIrregularEdge ? side_of_two_faces(triangle, beyond, p) : 0;
}

/// The scalar product with an edge's pseudonormal is the mean of the distances from both faces' planes. The function
/// uses these distances, because their signs are exact.
int Pseudonormals::side_of_two_faces(std::uint32_t first, std::uint32_t second, const Vec3& p) const {
    const int first_side = side_of_face(first, p);
    const int second_side = side_of_face(second, p);
    if (first_side * second_side >= 0) return first_side != 0 ? first_side : second_side;
    const auto height = [&](std::uint32_t triangle) {
        const auto& [a, b, c] = triangles_[triangle];
        return height_over(p, vertices_[a], vertices_[b], vertices_[c]);
    };
    const Height x = height(first);
    const Height y = height(second);
    return sign_beyond(x.value + y.value, x.error + y.error);
}

bool Pseudonormals::is_on_boundary(std::uint32_t triangle, TriangleFeature feature) const {
    if (feature == TriangleFeature::kFace) return false;
    const std::size_t number = number_of(feature);
    if (rank(feature) == 2) return vertex_is_open_[welded(triangle, number)] != 0;
    const Neighbour beyond = sides_[triangle][number];
    return beyond >= kIrregularEdge && irregular_edges_[beyond - kIrregularEdge].is_open;
}

std::size_t Pseudonormals::memory_bytes() const {
    const auto bytes = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
    return bytes(welded_) + bytes(at_vertex_) + bytes(vertex_is_open_) + bytes(sides_) + bytes(irregular_edges_) +
           bytes(copies_);
}

}  // namespace ricochet
