#include "ricochet/geometry/acceleration/box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ricochet/core/loop_stop.h"

namespace ricochet {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Relative error bound. It covers the rounding to single precision and the rounding of the error bound itself. Local:
/// an error bound of this arithmetic.
constexpr float kOutward = 0x1p-22F;

/// A number in single precision with a bound on its error.
struct Rounded {
    explicit Rounded(double x)
        : value(static_cast<float>(std::clamp(x, -double{kLargest}, double{kLargest}))),
          error(kOutward * std::fabs(value) + std::numeric_limits<float>::min()) {}
    static constexpr float kLargest = std::numeric_limits<float>::max();
    float value;
    float error;
};

/// Returns the relative cost of a node for a query. It is the sum of the lengths of the node's edges, because this sum
/// is positive even for flat boxes.
double cost(const std::array<float, 3>& lower, const std::array<float, 3>& upper) {
    double sum = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) sum += double{upper[axis]} - double{lower[axis]};
    return sum;
}

/// Returns the number of boxes in a full child of a node over `count` boxes. The number is a power of four, so that
/// nodes at the lower levels are full.
std::uint32_t full_child_of(std::uint32_t count) {
    std::uint32_t full = 1;
    while (full < (count + 3) / 4) full *= 4;
    return full;
}

/// Returns about half of the given number of boxes, rounded to a multiple of `full`.
std::uint32_t half_of(std::uint32_t count, std::uint32_t full) {
    return std::min(count, std::max(full, (count / 2 + full / 2) / full * full));
}

}  // namespace

BoxTree::Bounds BoxTree::outward(const Box3& box) {
    Bounds bounds{};
    for (int axis = 0; axis < 3; ++axis) {
        const Rounded lower(box.lower[axis]);
        const Rounded upper(box.upper[axis]);
        bounds.lower[static_cast<std::size_t>(axis)] = lower.value - lower.error;
        bounds.upper[static_cast<std::size_t>(axis)] = upper.value + upper.error;
    }
    return bounds;
}

void BoxTree::build(std::span<const Box3> boxes) {
    nodes_.clear();
    bounds_ = {};
    order_.resize(boxes.size());
    boxes_.resize(boxes.size());
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    if (boxes.empty()) return;
    static_cast<void>(add_node(0, static_cast<std::uint32_t>(boxes.size()), boxes));
    place_boxes([&](std::uint32_t i) { return boxes[i]; });
    cost_when_built_ = place_branches();
}

/// Partially sorts the boxes from `begin` to `end` along the longest side of the box around their centres. The centres
/// of the boxes before `middle` then come first along that side.
void BoxTree::halve(std::uint32_t begin, std::uint32_t middle, std::uint32_t end, std::span<const Box3> boxes) {
    if (middle <= begin || middle >= end) return;
    Box3 centers;
    for (std::uint32_t k = begin; k < end; ++k) centers.include(boxes[order_[k]].center());
    const int axis = longest_axis(centers.size());
    const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
        const double at_a = boxes[a].lower[axis] + boxes[a].upper[axis];
        const double at_b = boxes[b].lower[axis] + boxes[b].upper[axis];
        return at_a != at_b ? at_a < at_b : a < b;
    };
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, is_before);
}

/// Adds a node over the given range of the order, and the nodes below it. Returns its index.
std::uint32_t BoxTree::add_node(std::uint32_t begin, std::uint32_t end, std::span<const Box3> boxes) {
    poll_loop_stop();
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    const Quad none{kNone, kNone, kNone, kNone};
    nodes_.push_back({none, none, none, none, none, none, {kNoChild, kNoChild, kNoChild, kNoChild}});
    const std::uint32_t full = full_child_of(end - begin);
    const std::uint32_t middle = begin + half_of(end - begin, full);
    const std::array<std::uint32_t, kLanes + 1> cuts{begin, begin + half_of(middle - begin, full), middle,
                                                     middle + half_of(end - middle, full), end};
    halve(begin, middle, end, boxes);
    halve(begin, cuts[1], middle, boxes);
    halve(middle, cuts[3], end, boxes);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::uint32_t count = cuts[lane + 1] - cuts[lane];
        if (count == 0) continue;
        const std::uint32_t child = count == 1 ? (kBox | cuts[lane]) : add_node(cuts[lane], cuts[lane + 1], boxes);
        nodes_[index].child[lane] = child;
    }
    return index;
}

BoxTree::Bounds BoxTree::bounds_of(const Node& node) {
    const auto least = [](const Quad& of) {  // NaN is ignored
        float smallest = std::numeric_limits<float>::infinity();
        for (std::size_t lane = 0; lane < kLanes; ++lane) smallest = std::min(smallest, of[lane]);
        return smallest;
    };
    return {{least(node.lower_x), least(node.lower_y), least(node.lower_z)},
            {-least(-node.upper_x), -least(-node.upper_y), -least(-node.upper_z)}};
}

/// Updates the bounds of all branches from the last node to the first, because children are stored after their parents.
/// Returns the cost of all nodes.
double BoxTree::place_branches() {
    double sum = 0.0;
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const std::uint32_t child = nodes_[i].child[lane];
            if ((child & kBox) != 0) continue;
            const Bounds bounds = bounds_of(nodes_[child]);
            place(nodes_[i], lane, bounds);
            sum += cost(bounds.lower, bounds.upper);
        }
    }
    const auto [lower, upper] = bounds_of(nodes_.front());
    bounds_ = {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}};
    return sum;
}

}  // namespace ricochet
