#include "ricochet/dynamics/inverse_square.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/inverse_square_lanes.h"

namespace ricochet {
namespace {

/// Largest number of points in a leaf. A leaf of coincident points may have more.
constexpr std::size_t kLeaf = 32;
/// Leaves and points per unit of parallel work.
constexpr std::size_t kLeafBlock = 16;
constexpr std::size_t kPointBlock = 4 * kLanes;

Box3 cube_around(std::span<const Vec3> positions, std::span<const std::uint32_t> numbers) {
    Box3 box;
    for (const std::uint32_t i : numbers) box.include(positions[i]);
    if (box.empty()) return {{}, {}};
    const double half = 0.5 * max_abs(box.size());
    const Vec3 center = box.center();
    return {center - Vec3{half, half, half}, center + Vec3{half, half, half}};
}

double distance_to(const Box3& box, const Vec3& p) { return length(max(Vec3{}, max(box.lower - p, p - box.upper))); }

}  // namespace

void direct_field(const Sources& sources, std::span<Vec3> field) {
    const double softening = sources.softening * sources.softening;
    parallel_for_blocks(field.size(), kPointBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end; first += kLanes) {
            FieldLanes lanes(sources.positions.subspan(first, std::min(kLanes, end - first)));
            lanes.add_points(sources.positions, sources.weights, softening);
            lanes.store(field.subspan(first, std::min(kLanes, end - first)));
        }
    });
}

void direct_potential(const Sources& sources, std::span<double> potential) {
    const double softening = sources.softening * sources.softening;
    parallel_for_blocks(potential.size(), kPointBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            potential[i] =
                point_potential(sources.positions[i], sources.positions.first(i), sources.weights, softening) +
                point_potential(sources.positions[i], sources.positions.subspan(i + 1), sources.weights.subspan(i + 1),
                                softening);
        }
    });
}

SourceTree::SourceTree(const Sources& sources)
    : sources_(sources), order_(sources.positions.size()), position_(order_.size()), weight_(order_.size()) {
    for (std::size_t k = 0; k < order_.size(); ++k) order_[k] = static_cast<std::uint32_t>(k);
    nodes_.emplace_back().end = static_cast<std::uint32_t>(order_.size());
    refine(0, INFINITY);
    for (std::size_t k = 0; k < order_.size(); ++k) {
        position_[k] = sources.positions[order_[k]];
        weight_[k] = sources.weights[order_[k]];
    }
    find_moments();
}

/// Sorts a node's points along the Z-order curve through a cube around them, and splits the node by the cells of the
/// curve. outer_side: edge of the enclosing cube, whose cells could not separate the points. Coincident points remain
/// in one leaf.
void SourceTree::refine(std::size_t node, double outer_side) {
    const std::size_t begin = nodes_[node].begin;
    const std::size_t count = nodes_[node].end - begin;
    const std::span<std::uint32_t> numbers = std::span(order_).subspan(begin, count);
    const Box3 cube = cube_around(sources_.positions, numbers);
    Cells cells{begin, 1, cube.size().x};
    if (count <= kLeaf || !(cells.side > 0.0 && cells.side < outer_side)) return;
    while (count >> cells.index_bits != 0) ++cells.index_bits;
    std::vector<std::uint64_t> keys(count);
    parallel_for_blocks(count, 1024, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            keys[k] = morton_key(sources_.positions[numbers[k]], cube, static_cast<std::uint32_t>(k), cells.index_bits);
        }
    });
    parallel_sort(keys);
    const std::vector<std::uint32_t> before(numbers.begin(), numbers.end());
    for (std::size_t k = 0; k < count; ++k) numbers[k] = before[index_of_key(keys[k], cells.index_bits)];
    split(node, keys, cells, 0);
}

void SourceTree::split(std::size_t node, std::span<const std::uint64_t> keys, const Cells& cells, unsigned level) {
    const std::uint32_t begin = nodes_[node].begin;
    const std::uint32_t end = nodes_[node].end;
    if (end - begin <= kLeaf) return;
    constexpr unsigned kTopDigit = 61;  // lowest bit of the first digit of a key
    if (kTopDigit < cells.index_bits + 3 * level) return refine(node, cells.side);
    const unsigned shift = kTopDigit - 3 * level;
    const auto digit_at = [&](std::size_t k) { return static_cast<unsigned>(keys[k - cells.first] >> shift & 7U); };
    std::array<std::uint32_t, 9> bounds{};
    bounds.fill(end);
    std::uint32_t k = begin;
    for (unsigned digit = 0; digit < 8; ++digit) {
        bounds[digit] = k;
        const auto last = keys.begin() + static_cast<std::ptrdiff_t>(end - cells.first);
        const auto from = keys.begin() + static_cast<std::ptrdiff_t>(k - cells.first);
        const auto next =
            std::partition_point(from, last, [&](std::uint64_t key) { return (key >> shift & 7U) <= digit; });
        k = static_cast<std::uint32_t>(cells.first + static_cast<std::size_t>(next - keys.begin()));
    }
    if (digit_at(begin) == digit_at(end - 1)) return split(node, keys, cells, level + 1);
    const std::size_t first_child = nodes_.size();
    for (unsigned digit = 0; digit < 8; ++digit) {
        if (bounds[digit] == bounds[digit + 1]) continue;
        Node& child = nodes_.emplace_back();
        child.begin = bounds[digit];
        child.end = bounds[digit + 1];
    }
    nodes_[node].child = static_cast<std::uint32_t>(first_child);
    nodes_[node].children = static_cast<std::uint32_t>(nodes_.size() - first_child);
    const std::size_t past_child = nodes_.size();
    for (std::size_t child = first_child; child < past_child; ++child) split(child, keys, cells, level + 1);
}

void SourceTree::find_moments() {
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
        if (nodes_[n].children == 0 && nodes_[n].end > nodes_[n].begin)
            leaves_.push_back(static_cast<std::uint32_t>(n));
    }
    parallel_for_blocks(leaves_.size(), kLeafBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) take_points(nodes_[leaves_[k]]);
    });
    for (std::size_t n = nodes_.size(); n-- > 0;) {
        if (nodes_[n].children > 0) take_children(nodes_[n]);
    }
}

void SourceTree::take_points(Node& node) const {
    Vec3 sum;
    for (std::size_t k = node.begin; k < node.end; ++k) {
        node.box.include(position_[k]);
        node.magnitude += std::fabs(weight_[k]);
        sum += std::fabs(weight_[k]) * position_[k];
    }
    node.center = node.magnitude > 0.0 ? sum / node.magnitude : node.box.center();
    for (std::size_t k = node.begin; k < node.end; ++k) {
        const Vec3 arm = position_[k] - node.center;
        node.weight += weight_[k];
        node.first += weight_[k] * arm;
        node.second = node.second + weight_[k] * outer_product(arm);
        node.reach = std::max(node.reach, length(arm));
    }
}

void SourceTree::take_children(Node& node) const {
    const std::span<const Node> children = std::span(nodes_).subspan(node.child, node.children);
    Vec3 sum;
    for (const Node& child : children) {
        node.box.include(child.box);
        node.magnitude += child.magnitude;
        sum += child.magnitude * child.center;
    }
    node.center = node.magnitude > 0.0 ? sum / node.magnitude : node.box.center();
    double reach = 0.0;
    for (const Node& child : children) {
        const Vec3 arm = child.center - node.center;
        node.weight += child.weight;
        node.first += child.first + child.weight * arm;
        node.second = node.second + child.second + mixed_product(child.first, arm) + child.weight * outer_product(arm);
        reach = std::max(reach, length(arm) + child.reach);
    }
    // The distance to the farthest corner of the box is another upper bound of the reach.
    node.reach = std::min(reach, length(max(node.box.upper - node.center, node.center - node.box.lower)));
}

SourceTree::Interactions SourceTree::interactions_of(const Node& leaf, double opening) const {
    Interactions found;
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
        const std::uint32_t n = open.back();
        open.pop_back();
        const Node& node = nodes_[n];
        if (node.reach < opening * distance_to(leaf.box, node.center)) {
            found.groups.push_back(n);
        } else if (node.children == 0) {
            found.leaves.push_back(n);
        } else {
            for (std::uint32_t c = node.children; c-- > 0;) open.push_back(node.child + c);
        }
    }
    return found;
}

void SourceTree::field(double opening, std::span<Vec3> field, TreeWork* work) const {
    const double softening = sources_.softening * sources_.softening;
    const std::span<const Vec3> positions(position_);
    const std::span<const double> weights(weight_);
    std::vector<TreeWork> done(leaves_.size());
    parallel_for_blocks(leaves_.size(), kLeafBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Node& leaf = nodes_[leaves_[k]];
            const Interactions found = interactions_of(leaf, opening);
            std::size_t points = 0;
            for (const std::uint32_t n : found.leaves) points += nodes_[n].end - nodes_[n].begin;
            done[k] = {points * (leaf.end - leaf.begin), found.groups.size() * (leaf.end - leaf.begin)};
            for (std::size_t first = leaf.begin; first < leaf.end; first += kLanes) {
                const std::size_t count = std::min<std::size_t>(kLanes, leaf.end - first);
                FieldLanes lanes(positions.subspan(first, count));
                for (const std::uint32_t n : found.groups) lanes.add_group(nodes_[n], softening);
                for (const std::uint32_t n : found.leaves) {
                    const std::size_t size = nodes_[n].end - nodes_[n].begin;
                    lanes.add_points(positions.subspan(nodes_[n].begin, size), weights.subspan(nodes_[n].begin, size),
                                     softening);
                }
                std::array<Vec3, kLanes> sums;
                lanes.store(std::span(sums).first(count));
                for (std::size_t l = 0; l < count; ++l) field[order_[first + l]] = sums[l];
            }
        }
    });
    if (work == nullptr) return;
    for (const TreeWork& part : done) {
        work->with_points += part.with_points;
        work->with_groups += part.with_groups;
    }
}

void SourceTree::potential(double opening, std::span<double> potential) const {
    const double softening = sources_.softening * sources_.softening;
    const std::span<const Vec3> positions(position_);
    const std::span<const double> weights(weight_);
    parallel_for_blocks(leaves_.size(), kLeafBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Node& leaf = nodes_[leaves_[k]];
            const Interactions found = interactions_of(leaf, opening);
            for (std::size_t i = leaf.begin; i < leaf.end; ++i) {
                double sum = 0.0;
                for (const std::uint32_t n : found.groups) {
                    sum += group_potential(nodes_[n], positions[i], softening);
                }
                const auto add = [&](std::size_t from, std::size_t to) {
                    sum += point_potential(positions[i], positions.subspan(from, to - from),
                                           weights.subspan(from, to - from), softening);
                };
                for (const std::uint32_t n : found.leaves) {
                    const Node& node = nodes_[n];
                    const bool is_own = i >= node.begin && i < node.end;
                    add(node.begin, is_own ? i : node.end);
                    if (is_own) add(i + 1, node.end);
                }
                potential[order_[i]] = sum;
            }
        }
    });
}

}  // namespace ricochet
