/// \file
/// Sums of the inverse-square law over many sources, directly and by a tree. Private to the library.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/symmetric_matrix.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Points with weights (masses or charges) that all act on each other. With the softening length e, the field g and
/// potential f at point i are:
///
///     g_i = sum over j of w_j (x_j - x_i) / (|x_j - x_i|^2 + e^2)^(3/2);
///     f_i = sum over j of w_j / (|x_j - x_i|^2 + e^2)^(1/2).
///
/// The sums exclude j = i. If e = 0, they also exclude points that coincide with point i. Both lists have the same
/// length.
struct Sources {
    std::span<const Vec3> positions;  ///< in m
    std::span<const double> weights;
    double softening = 0.0;  ///< in m
};

/// Compute the field g or the potential f from all pairs. The sum of each point is accumulated in the order of the
/// points, so the bits do not depend on threads.
void direct_field(const Sources& sources, std::span<Vec3> field);
void direct_potential(const Sources& sources, std::span<double> potential);

/// Moments of a group of points about its centre.
struct GroupMoments {
    Vec3 center;             ///< mean position of the points, weighted by absolute weights, in m
    double weight = 0.0;     ///< zeroth moment
    Vec3 first;              ///< first moment
    SymmetricMatrix second;  ///< second moment
};

/// Numbers of interactions that a sum by a tree has evaluated.
struct TreeWork {
    std::uint64_t with_points = 0;
    std::uint64_t with_groups = 0;
};

/// The sources as an octree, whose shape depends only on the positions and their order. The effect of a distant group
/// is computed from its moments. Source of the method: J. Barnes, P. Hut, Nature 324, 1986. The opening criterion uses
/// the farthest point of a group: J. K. Salmon, M. S. Warren, J. Comput. Phys. 111, 1994.
class SourceTree {
public:
    /// The data behind the spans of `sources` must outlive the tree.
    explicit SourceTree(const Sources& sources);

    /// Computes the field g, and adds the numbers of interactions to `work`. opening: see InverseSquareSettings.
    void field(double opening, std::span<Vec3> field, TreeWork* work = nullptr) const;
    /// Computes the potential f.
    void potential(double opening, std::span<double> potential) const;

private:
    struct Node : GroupMoments {
        double reach = 0.0;       // upper bound of the points' distances from the centre, in m
        Box3 box;                 // bounds of the points
        double magnitude = 0.0;   // sum of absolute weights
        std::uint32_t begin = 0;  // range of the node's points in sorted order
        std::uint32_t end = 0;
        std::uint32_t child = 0;     // index of the first child; the children are contiguous
        std::uint32_t children = 0;  // number of children; 0 in a leaf
    };
    /// Nodes whose effects on the points of a leaf are summed.
    struct Interactions {
        std::vector<std::uint32_t> groups;  // nodes used through their moments
        std::vector<std::uint32_t> leaves;  // nodes used through their points
    };
    /// Encoding of cells in the keys of sorted points.
    struct Cells {
        std::size_t first = 0;    // index of the point that the first key belongs to
        unsigned index_bits = 0;  // number of low bits of a key that encode the point's index instead of a cell
        double side = 0.0;        // edge of the cube, in m
    };

    void refine(std::size_t node, double outer_side);
    void split(std::size_t node, std::span<const std::uint64_t> keys, const Cells& cells, unsigned level);
    void find_moments();
    void take_points(Node& node) const;
    void take_children(Node& node) const;
    [[nodiscard]] Interactions interactions_of(const Node& leaf, double opening) const;

    Sources sources_;
    std::vector<std::uint32_t> order_;  // original index of each sorted point
    std::vector<Vec3> position_;        // sorted
    std::vector<double> weight_;        // sorted
    std::vector<Node> nodes_;           // all nodes, parents before their children
    std::vector<std::uint32_t> leaves_;
};

}  // namespace ricochet
