/// \file
/// Private to the library: sums of the inverse-square law over many sources, directly and by a tree.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/symmetric_matrix.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Points with weights (masses or charges), all of which act on each other: softened by the length e, the field at
/// point i is
///
///     g_i = sum over j of w_j (x_j - x_i) / (|x_j - x_i|^2 + e^2)^(3/2),   f_i = sum of w_j / (|x_j - x_i|^2 +
///     e^2)^(1/2)
///
/// without j = i and without points at the same place where e = 0. Lists have the same length.
struct Sources {
    std::span<const Vec3> positions;  ///< m
    std::span<const double> weights;
    double softening = 0.0;  ///< m
};

/// g, every pair by itself. Each point adds up its own sum in the order of the points: the bits do not depend on
/// threads.
void direct_field(const Sources& sources, std::span<Vec3> field);
/// f in the same way.
void direct_potential(const Sources& sources, std::span<double> potential);

/// Interactions that a sum by a tree has taken.
struct TreeWork {
    std::uint64_t with_points = 0;
    std::uint64_t with_groups = 0;
};

/// The sources as an octree: points that lie together are groups, and what a distant group does follows from its weight
/// and its first and second moments about its centre. Source: J. Barnes, P. Hut, Nature 324, 1986; the criterion, by
/// the farthest point of a group, is that of J. K. Salmon, M. S. Warren, J. Comput. Phys. 111, 1994. Its shape depends
/// on the positions and their order only.
class SourceTree {
public:
    /// What sources spans must outlive it.
    explicit SourceTree(const Sources& sources);

    /// g; opening: see InverseSquareSettings. Adds to `work` where it is not null.
    void field(double opening, std::span<Vec3> field, TreeWork* work = nullptr) const;
    /// f.
    void potential(double opening, std::span<double> potential) const;

private:
    struct Node {
        Vec3 center;              // of the absolute weights, m
        double reach = 0.0;       // m, no point is farther from it
        double weight = 0.0;      // zeroth moment
        Vec3 first;               // first moment about the centre
        SymmetricMatrix second;   // second moment about it
        Box3 box;                 // of the points
        double magnitude = 0.0;   // sum of absolute weights
        std::uint32_t begin = 0;  // its points in sorted order
        std::uint32_t end = 0;
        std::uint32_t child = 0;     // the first of its children, which stand together
        std::uint32_t children = 0;  // 0: a leaf
    };
    /// What acts on the points of a leaf.
    struct Interactions {
        std::vector<std::uint32_t> groups;  // nodes by their moments
        std::vector<std::uint32_t> leaves;  // nodes by their points
    };
    /// The cells that keys of sorted points name.
    struct Cells {
        std::size_t first = 0;    // number of the point of the first key
        unsigned index_bits = 0;  // of a key that name no cell
        double side = 0.0;        // m, of the cube
    };

    void refine(std::size_t node, double outer_side);
    void split(std::size_t node, std::span<const std::uint64_t> keys, const Cells& cells, unsigned level);
    void find_moments();
    void take_points(Node& node) const;
    void take_children(Node& node) const;
    [[nodiscard]] Interactions interactions_of(const Node& leaf, double opening) const;

    Sources sources_;
    std::vector<std::uint32_t> order_;  // number of each sorted point
    std::vector<Vec3> position_;        // sorted
    std::vector<double> weight_;        // sorted
    std::vector<Node> nodes_;           // parents before their children
    std::vector<std::uint32_t> leaves_;
};

}  // namespace ricochet
