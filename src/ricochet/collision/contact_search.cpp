#include "ricochet/collision/contact_search.h"

#include <algorithm>
#include <limits>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates.h"

namespace ricochet {
namespace {

/// Halvings of a path in search of pieces flat enough for the boxes. Only pieces near the triangles are halved; a path
/// that bends so much that this is not enough is tested against every triangle.
constexpr int kPieceDepth = 40;

double largest_coordinate(const Path& path) {
    const double h = path.duration;
    Vec3 magnitude = abs(path.c[0]);
    double power = h;
    for (int k = 1; k <= path.degree; ++k, power *= h) magnitude += power * abs(path.c[static_cast<std::size_t>(k)]);
    return max_abs(magnitude);
}

}  // namespace

Vec3 facing_normal(const CollisionWorld& world, SurfaceId surface, int side, const Vec3& v) {
    if (side != 0) return side > 0 ? world.unit_normal_of(surface) : -world.unit_normal_of(surface);
    const double speed = length(v);
    return speed > 0.0 ? v / -speed : world.unit_normal_of(surface);
}

std::optional<Contact> ContactSearch::search(const Path& path) {
    scratch_.triangles.clear();
    scratch_.planes.clear();
    scratch_.found.clear();
    const double reach = largest_coordinate(path);
    slack_ = kCandidateSlack * reach + kLongestParkingUlps * kSmallestParkingGap;
    first_time_ = std::numeric_limits<double>::infinity();
    all_triangles_ = false;
    search_planes(path);
    if (kPathRounding * reach <= world_.bvh().slack()) {
        search_triangles(path, 0.0, path.duration, kPieceDepth);
    } else if (may_reach_triangles(path, 0.0, path.duration)) {
        search_all_triangles(path);
    }
    if (scratch_.found.empty()) return std::nullopt;
    return first_of_found(path);
}

void ContactSearch::search_planes(const Path& path) {
    const auto planes = world_.planes();
    for (std::uint32_t k = 0; k < planes.size(); ++k) {
        if (clears_plane(path, planes[k].plane, slack_)) continue;
        scratch_.planes.push_back(k);
        const auto crossing = first_crossing(path, planes[k].plane);
        if (!crossing) continue;
        scratch_.found.push_back({crossing->time, planes[k].surface, crossing->side});
        first_time_ = std::min(first_time_, crossing->time);
    }
}

// A point of a chord lies within the chord's sagitta of the path, and that point of the path within its piece's sagitta
// of the piece's chord; together they must stay within the allowance of the boxes.
bool ContactSearch::covers_chord(const Path& path, double from, double to) const {
    return all_triangles_ || path.degree < 2 || world_.triangles().empty() ||
           2.0 * path.sagitta(from, to) <= world_.bvh().curvature_allowance() || !may_reach_triangles(path, from, to);
}

// The allowance keeps chords that begin on such a piece and end on the next one away from the triangles too.
bool ContactSearch::may_reach_triangles(const Path& path, double from, double to) const {
    Box3 box;
    box.include(path.position(from));
    box.include(path.position(to));
    const double margin = path.sagitta(from, to) + slack_ + world_.bvh().curvature_allowance();
    const Vec3 by{margin, margin, margin};
    const Vec3 gap = max(box.lower - by - world_.bounds().upper, world_.bounds().lower - (box.upper + by));
    return std::max({gap.x, gap.y, gap.z}) <= 0.0;
}

void ContactSearch::search_all_triangles(const Path& path) {
    all_triangles_ = true;
    for (std::uint32_t triangle = 0; triangle < world_.triangles().size(); ++triangle) {
        (void)look_at_triangle(path, triangle);
    }
}

// Pieces are visited in the order of time, so a contact ends the search. How the path is cut serves the boxes only:
// every triangle is judged on the whole path.
void ContactSearch::search_triangles(const Path& path, double from, double to, int depth) {
    if (from > first_time_ || all_triangles_) return;
    if (!covers_chord(path, from, to)) {
        if (depth == 0) {
            search_all_triangles(path);
            return;
        }
        const double middle = 0.5 * (from + to);
        search_triangles(path, from, middle, depth - 1);
        search_triangles(path, middle, to, depth - 1);
        return;
    }
    const double span = to - from;
    world_.bvh().visit(path.position(from), path.position(to), [&](std::uint32_t triangle) {
        const double first = look_at_triangle(path, triangle);
        return first < to ? std::max(0.0, (first - from) / span) : 1.0;
    });
}

double ContactSearch::look_at_triangle(const Path& path, std::uint32_t triangle) {
    if (world_.is_left_out(triangle)) return first_time_;
    const auto [a, b, c] = world_.corners_of_triangle(triangle);
    if (clears_plane_of(path, a, b, c, slack_)) return first_time_;
    scratch_.triangles.push_back(triangle);
    const auto crossing = first_crossing(path, a, b, c);
    if (!crossing) return first_time_;
    scratch_.found.push_back({crossing->time, world_.surface_of_triangle(triangle), crossing->side});
    first_time_ = std::min(first_time_, crossing->time);
    return first_time_;
}

Contact ContactSearch::first_of_found(const Path& path) const {
    Contact contact;
    contact.time = first_time_;
    const double latest = first_time_ + kSimultaneousUlps * ulp(first_time_);
    auto& found = scratch_.found;
    std::erase_if(found, [&](const ContactScratch::Found& f) { return f.time > latest; });
    // A surface met rim-on answers only when nothing is met from a side.
    const bool any_side = std::any_of(found.begin(), found.end(), [](const auto& f) { return f.side != 0; });
    if (any_side) std::erase_if(found, [](const auto& f) { return f.side == 0; });
    std::sort(found.begin(), found.end(), [](const auto& f, const auto& g) { return f.surface < g.surface; });
    for (std::size_t k = 0; k < found.size() && contact.count < Contact::kMostSurfaces; ++k) {
        if (k > 0 && found[k].surface == found[k - 1].surface) continue;
        contact.surfaces[static_cast<std::size_t>(contact.count++)] = {
            found[k].surface, facing_normal(world_, found[k].surface, found[k].side, path.velocity(first_time_))};
    }
    return contact;
}

std::optional<SurfaceId> ContactSearch::blocker(const Vec3& p, const Vec3& q) const {
    std::optional<SurfaceId> smallest;
    const auto consider = [&](SurfaceId surface) {
        if (!smallest || surface < *smallest) smallest = surface;
    };
    for (const std::uint32_t k : scratch_.planes) {
        const auto& [plane, surface] = world_.planes()[k];
        if (side_of(plane, p) * side_of(plane, q) <= 0) consider(surface);
    }
    for (const std::uint32_t triangle : scratch_.triangles) {
        const auto [a, b, c] = world_.corners_of_triangle(triangle);
        if (segment_meets_triangle(p, q, a, b, c)) consider(world_.surface_of_triangle(triangle));
    }
    return smallest;
}

std::vector<SurfaceId> ContactSearch::gathered() const {
    std::vector<SurfaceId> surfaces;
    for (const std::uint32_t k : scratch_.planes) surfaces.push_back(world_.planes()[k].surface);
    for (const std::uint32_t triangle : scratch_.triangles) surfaces.push_back(world_.surface_of_triangle(triangle));
    std::sort(surfaces.begin(), surfaces.end());
    surfaces.erase(std::unique(surfaces.begin(), surfaces.end()), surfaces.end());
    return surfaces;
}

std::vector<SurfaceId> ContactSearch::surfaces_at(const Vec3& p) const {
    std::vector<SurfaceId> surfaces = gathered();
    std::erase_if(surfaces, [&](SurfaceId surface) { return !world_.point_on(surface, p); });
    return surfaces;
}

bool ContactSearch::is_free_after(const Vec3& p, const Vec3& q) const {
    const std::vector<SurfaceId> surfaces = gathered();
    return std::all_of(surfaces.begin(), surfaces.end(), [&](SurfaceId surface) {
        if (!world_.segment_meets(surface, p, q)) return true;
        return world_.point_on(surface, p) && world_.side_of_surface(surface, q) != 0;
    });
}

bool ContactSearch::is_free(const Vec3& p, const Vec3& q) const {
    const auto planes = world_.planes();
    for (const std::uint32_t k : scratch_.planes) {
        if (side_of(planes[k].plane, p) * side_of(planes[k].plane, q) <= 0) return false;
    }
    return std::none_of(scratch_.triangles.begin(), scratch_.triangles.end(), [&](std::uint32_t triangle) {
        const auto [a, b, c] = world_.corners_of_triangle(triangle);
        return segment_meets_triangle(p, q, a, b, c);
    });
}

}  // namespace ricochet
