#include "ricochet/dynamics/block_cholesky.h"

#include <Eigen/OrderingMethods>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/dynamics/dense_front.h"

namespace ricochet {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Largest fraction of zeros in a front. Consecutive columns are merged into one front up to this limit. Larger dense
/// matrices are faster, and this gain exceeds the cost of operations on some zeros. Local, because the limit affects
/// only the cost and the rounding.
constexpr double kMostZeros = 0.2;

using Pair = BlockCholesky::Pair;
using Lists = std::vector<std::vector<std::uint32_t>>;

/// Returns the elimination order, which keeps L sparse: entry i is the row of blocks that is eliminated as number i.
std::vector<std::uint32_t> elimination_order(std::size_t rows, std::span<const Pair> pairs) {
    using Pattern = Eigen::SparseMatrix<double>;
    std::vector<Eigen::Triplet<double>> slots;
    for (std::size_t i = 0; i < rows; ++i) slots.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.0);
    for (const Pair& pair : pairs) {
        slots.emplace_back(static_cast<int>(pair.first), static_cast<int>(pair.second), 1.0);
        slots.emplace_back(static_cast<int>(pair.second), static_cast<int>(pair.first), 1.0);
    }
    Pattern pattern(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(rows));
    pattern.setFromTriplets(slots.begin(), slots.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(pattern, order);
    std::vector<std::uint32_t> result;
    for (std::size_t i = 0; i < rows; ++i) {
        result.push_back(static_cast<std::uint32_t>(order.indices()[static_cast<Eigen::Index>(i)]));
    }
    return result;
}

/// Returns, for every row in elimination order, the coupled rows that are eliminated later.
Lists later_neighbours(std::span<const std::uint32_t> order, std::span<const Pair> pairs) {
    Lists later(order.size());
    for (const Pair& pair : pairs) {
        const auto [low, high] = std::minmax(order[pair.first], order[pair.second]);
        later[low].push_back(high);
    }
    for (std::vector<std::uint32_t>& list : later) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return later;
}

std::vector<std::uint32_t> united(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    std::vector<std::uint32_t> result;
    result.reserve(a.size() + b.size());
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

/// Returns the parent of every row in the elimination tree: the first row below the diagonal with a nonzero in its
/// column of L.
std::vector<std::uint32_t> parents_of(const Lists& later) {
    std::vector<std::uint32_t> parent(later.size(), kNone);
    std::vector<std::uint32_t> ancestor(later.size(), kNone);
    Lists earlier(later.size());
    for (std::uint32_t k = 0; k < later.size(); ++k) {
        for (const std::uint32_t row : later[k]) earlier[row].push_back(k);
    }
    for (std::uint32_t row = 0; row < later.size(); ++row) {
        for (std::uint32_t k : earlier[row]) {
            while (k != kNone && k < row) {
                const std::uint32_t next = std::exchange(ancestor[k], row);
                if (next == kNone) parent[k] = row;
                k = next;
            }
        }
    }
    return parent;
}

/// Returns the position of each row in a postorder, in which every subtree is contiguous.
std::vector<std::uint32_t> postorder(const std::vector<std::uint32_t>& parent) {
    const auto count = static_cast<std::uint32_t>(parent.size());
    std::vector<std::uint32_t> below(count, 1);  // number of rows in the subtree of each row, itself included
    for (std::uint32_t k = 0; k < count; ++k) {
        if (parent[k] != kNone) below[parent[k]] += below[k];
    }
    std::vector<std::uint32_t> free(count, 0);  // first free position for the next child of each row
    std::vector<std::uint32_t> slot(count, 0);
    std::uint32_t of_roots = 0;
    for (std::uint32_t k = count; k-- > 0;) {
        std::uint32_t& first = parent[k] == kNone ? of_roots : free[parent[k]];
        free[k] = first;
        first += below[k];
        slot[k] = first - 1;
    }
    return slot;
}

}  // namespace

/// Nonzero structure of L.
struct BlockCholesky::Structure {
    std::vector<std::uint32_t> parent;
    Lists below;  // for every column, the rows below its diagonal, ascending
};

BlockCholesky::BlockCholesky(std::size_t rows, std::span<const Pair> pairs) {
    std::vector<std::uint32_t> order(rows);
    const std::vector<std::uint32_t> eliminated = elimination_order(rows, pairs);
    for (std::uint32_t k = 0; k < rows; ++k) order[eliminated[k]] = k;
    const std::vector<std::uint32_t> slot = postorder(parents_of(later_neighbours(order, pairs)));
    for (std::uint32_t& k : order) k = slot[k];
    order_ = std::move(order);
    Structure structure{{}, later_neighbours(order_, pairs)};
    structure.parent.assign(rows, kNone);
    for (std::uint32_t k = 0; k < rows; ++k) {
        const std::vector<std::uint32_t>& below = structure.below[k];
        if (below.empty()) continue;
        const std::uint32_t parent = structure.parent[k] = below.front();
        structure.below[parent] = united(structure.below[parent], {below.begin() + 1, below.end()});
    }
    make_fronts(structure);
    place_entries(pairs);
}

/// Groups the columns into fronts. A column joins the front of the column before it if both have nonzeros in almost the
/// same rows.
void BlockCholesky::make_fronts(const Structure& structure) {
    const auto rows = static_cast<std::uint32_t>(structure.below.size());
    front_of_.assign(rows, 0);
    for (std::uint32_t k = 0; k < rows;) {
        Front front;
        front.begin = k;
        double filled = 0.0;  // number of nonzero blocks
        for (;; ++k) {
            const auto count = static_cast<double>(k + 1 - front.begin);
            filled += 1.0 + static_cast<double>(structure.below[k].size());
            front_of_[k] = static_cast<std::uint32_t>(fronts_.size());
            if (structure.parent[k] != k + 1) break;
            const double next = 1.0 + static_cast<double>(structure.below[k + 1].size());
            const double stored = next * (count + 1.0) + 0.5 * count * (count + 1.0);
            if (stored - filled - next > kMostZeros * stored) break;
        }
        ++k;
        front.count = k - front.begin;
        front.below = structure.below[k - 1];
        fronts_.push_back(std::move(front));
    }
    std::size_t values = 0;
    for (std::uint32_t f = 0; f < fronts_.size(); ++f) {
        Front& front = fronts_[f];
        front.values = values;
        values += front.rows() * front.columns();
        if (front.below.empty()) continue;
        Front& parent = fronts_[front_of_[front.below.front()]];
        parent.children.push_back(f);
        for (const std::uint32_t row : front.below) front.slots.push_back(index_in(parent, row));
    }
    values_.resize(values);
}

/// Returns the index of a row of blocks in a front.
std::uint32_t BlockCholesky::index_in(const Front& front, std::uint32_t row) {
    if (row < front.begin + front.count) return row - front.begin;
    const auto found = std::lower_bound(front.below.begin(), front.below.end(), row);
    return front.count + static_cast<std::uint32_t>(found - front.below.begin());
}

void BlockCholesky::place_entries(std::span<const Pair> pairs) {
    row_of_.resize(order_.size());
    for (std::uint32_t row = 0; row < order_.size(); ++row) row_of_[order_[row]] = row;
    for (std::uint32_t k = 0; k < pairs.size(); ++k) {
        const std::uint32_t first = order_[pairs[k].first];
        const std::uint32_t second = order_[pairs[k].second];
        const auto [low, high] = std::minmax(first, second);
        Front& front = fronts_[front_of_[low]];
        front.entries.push_back({k, index_in(front, high), low - front.begin, first == low});
    }
}

double BlockCholesky::operations() const {
    double sum = 0.0;
    for (const Front& front : fronts_) {
        const auto rows = static_cast<double>(front.rows());
        const auto left = rows - static_cast<double>(front.columns());
        sum += (rows * rows * rows - left * left * left) / 6.0 + rows * rows;
    }
    return sum;
}

bool BlockCholesky::factorize(const BlockMatrix& matrix) {
    updates_.clear();
    for (const Front& front : fronts_) {
        assemble(front, matrix);
        if (!eliminate(front_values_, front.rows(), front.columns())) return false;
        store_columns(front);
    }
    return true;
}

/// Assembles a front: its own entries of the matrix, plus the updates of its children.
void BlockCholesky::assemble(const Front& front, const BlockMatrix& matrix) {
    const std::size_t rows = front.rows();
    front_values_.assign(rows * rows, 0.0);
    for (std::uint32_t k = 0; k < front.count; ++k) {
        const Block3& block = matrix.own[row_of_[front.begin + k]];
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j <= i; ++j) front_values_[(3 * k + j) * rows + 3 * k + i] += block[i][j];
        }
    }
    for (const Entry& entry : front.entries) {
        const Block3& block = matrix.between[entry.pair];
        double* const corner = front_values_.data() + 3 * entry.column * rows + 3 * entry.row;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                corner[j * rows + i] += entry.is_transposed ? block[j][i] : block[i][j];
            }
        }
    }
    for (auto child = front.children.rbegin(); child != front.children.rend(); ++child) {
        add_update(fronts_[*child], rows);
    }
}

/// Adds the last update on the stack to the current front.
void BlockCholesky::add_update(const Front& child, std::size_t rows) {
    const std::size_t blocks = child.slots.size();
    const std::size_t size = 3 * blocks;
    const double* update = updates_.data() + updates_.size() - size * size;
    for (std::size_t column = 0; column < size; ++column, update += size) {
        double* const to = front_values_.data() + (3 * child.slots[column / 3] + column % 3) * rows;
        for (std::size_t k = column / 3; k < blocks; ++k) {
            for (std::size_t i = 0; i < 3; ++i) to[3 * child.slots[k] + i] += update[3 * k + i];
        }
    }
    updates_.resize(updates_.size() - size * size);
}

/// Stores the eliminated columns of L, and pushes the update for the parent on the stack.
void BlockCholesky::store_columns(const Front& front) {
    const std::size_t rows = front.rows();
    const std::size_t columns = front.columns();
    std::copy_n(front_values_.begin(), rows * columns, values_.begin() + static_cast<std::ptrdiff_t>(front.values));
    for (std::size_t j = columns; j < rows; ++j) {
        const auto column = front_values_.begin() + static_cast<std::ptrdiff_t>(j * rows);
        updates_.insert(updates_.end(), column + static_cast<std::ptrdiff_t>(columns),
                        column + static_cast<std::ptrdiff_t>(rows));
    }
}

void BlockCholesky::solve(std::span<double> values) const {
    std::vector<double> x(values.size());
    for (std::size_t k = 0; k < row_of_.size(); ++k) {
        for (std::size_t i = 0; i < 3; ++i) x[3 * k + i] = values[3 * row_of_[k] + i];
    }
    for (const Front& front : fronts_) solve_forwards(front, x);
    for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) solve_backwards(*front, x);
    for (std::size_t k = 0; k < row_of_.size(); ++k) {
        for (std::size_t i = 0; i < 3; ++i) values[3 * row_of_[k] + i] = x[3 * k + i];
    }
}

/// Replaces x by L^-1 x in the front's columns.
void BlockCholesky::solve_forwards(const Front& front, std::vector<double>& x) const {
    const std::size_t rows = front.rows();
    const std::size_t columns = front.columns();
    double* const own = x.data() + 3 * front.begin;
    for (std::size_t j = 0; j < columns; ++j) {
        const double* const l = values_.data() + front.values + j * rows;
        const double y = own[j] /= l[j];
        for (std::size_t i = j + 1; i < columns; ++i) own[i] -= l[i] * y;
        for (std::size_t k = 0; k < front.below.size(); ++k) {
            for (std::size_t i = 0; i < 3; ++i) x[3 * front.below[k] + i] -= l[columns + 3 * k + i] * y;
        }
    }
}

/// Replaces x by L^-T x in the front's columns.
void BlockCholesky::solve_backwards(const Front& front, std::vector<double>& x) const {
    const std::size_t rows = front.rows();
    const std::size_t columns = front.columns();
    double* const own = x.data() + 3 * front.begin;
    for (std::size_t j = columns; j-- > 0;) {
        const double* const l = values_.data() + front.values + j * rows;
        double sum = own[j];
        for (std::size_t i = j + 1; i < columns; ++i) sum -= l[i] * own[i];
        for (std::size_t k = 0; k < front.below.size(); ++k) {
            for (std::size_t i = 0; i < 3; ++i) sum -= l[columns + 3 * k + i] * x[3 * front.below[k] + i];
        }
        own[j] = sum / l[j];
    }
}

}  // namespace ricochet
