#include "ricochet/dynamics/block_cholesky.h"

#include <Eigen/OrderingMethods>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

// Tells GCC that the columns do not overlap, so that it vectorizes a loop over rows. Other compilers test for overlap
// at run time.
#if defined(__GNUC__) && !defined(__clang__)
#define RICOCHET_INDEPENDENT_ROWS _Pragma("GCC ivdep")
#else
#define RICOCHET_INDEPENDENT_ROWS
#endif

namespace ricochet {
namespace {

/// Largest fraction of zeros in a front, up to which consecutive columns are merged. The speed of larger dense matrices
/// exceeds the cost of operations on some zeros. Local, because the limit affects only the cost and the rounding.
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

/// Returns the nonzero structure of L: for every column, the rows below its diagonal, ascending.
Lists structure_of(std::span<const std::uint32_t> order, std::span<const Pair> pairs) {
    Lists structure = later_neighbours(order, pairs);
    for (const std::vector<std::uint32_t>& below : structure) {
        if (below.empty()) continue;
        std::vector<std::uint32_t>& of_parent = structure[below.front()];
        of_parent = united(of_parent, {below.begin() + 1, below.end()});
    }
    return structure;
}

/// Returns the position of each row in a postorder, in which every subtree is contiguous.
std::vector<std::uint32_t> postorder(const Lists& structure) {
    const auto count = static_cast<std::uint32_t>(structure.size());
    std::vector<std::uint32_t> below(count, 1);  // number of rows in the subtree of each row, itself included
    for (std::uint32_t k = 0; k < count; ++k) {
        if (!structure[k].empty()) below[structure[k].front()] += below[k];
    }
    std::vector<std::uint32_t> free(count, 0);  // first free position for the next child of each row
    std::vector<std::uint32_t> slot(count, 0);
    std::uint32_t of_roots = 0;
    for (std::uint32_t k = count; k-- > 0;) {
        std::uint32_t& first = structure[k].empty() ? of_roots : free[structure[k].front()];
        free[k] = first;
        first += below[k];
        slot[k] = first - 1;
    }
    return slot;
}

/// Number of columns in a panel. A panel is eliminated before the columns to its right are updated.
constexpr std::size_t kPanel = 24;

/// Lower half of a matrix, stored by columns.
struct Lower {
    double* values;
    std::size_t rows;
    [[nodiscard]] double* column(std::size_t j) const { return values + j * rows; }
};

/// Subtracts the contributions of columns k to `end` of L from columns j and j + 1, from row j on. Four columns of L
/// are processed together, so each load and store of an entry serves four products.
void update_two(const Lower& m, std::size_t j, std::size_t k, std::size_t end) {
    double* const c0 = m.column(j);
    double* const c1 = m.column(j + 1);
    for (; k + 3 < end; k += 4) {
        const double* const a0 = m.column(k);
        const double* const a1 = m.column(k + 1);
        const double* const a2 = m.column(k + 2);
        const double* const a3 = m.column(k + 3);
        const double b00 = a0[j];
        const double b01 = a1[j];
        const double b02 = a2[j];
        const double b03 = a3[j];
        const double b10 = a0[j + 1];
        const double b11 = a1[j + 1];
        const double b12 = a2[j + 1];
        const double b13 = a3[j + 1];
        c0[j] -= (a0[j] * b00 + a1[j] * b01) + (a2[j] * b02 + a3[j] * b03);
        RICOCHET_INDEPENDENT_ROWS
        for (std::size_t i = j + 1; i < m.rows; ++i) {
            c0[i] -= (a0[i] * b00 + a1[i] * b01) + (a2[i] * b02 + a3[i] * b03);
            c1[i] -= (a0[i] * b10 + a1[i] * b11) + (a2[i] * b12 + a3[i] * b13);
        }
    }
    for (; k < end; ++k) {
        const double* const a = m.column(k);
        const double b0 = a[j];
        const double b1 = a[j + 1];
        c0[j] -= a[j] * b0;
        RICOCHET_INDEPENDENT_ROWS
        for (std::size_t i = j + 1; i < m.rows; ++i) {
            c0[i] -= a[i] * b0;
            c1[i] -= a[i] * b1;
        }
    }
}

void update_one(const Lower& m, std::size_t j, std::size_t k, std::size_t end) {
    double* const c = m.column(j);
    for (; k < end; ++k) {
        const double* const a = m.column(k);
        const double b = a[j];
        RICOCHET_INDEPENDENT_ROWS
        for (std::size_t i = j; i < m.rows; ++i) c[i] -= a[i] * b;
    }
}

/// Eliminates the columns from `begin` to `end`, which already contain the updates of earlier panels.
bool eliminate_panel(const Lower& m, std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
        update_one(m, j, begin, j);
        double* const column = m.column(j);
        if (!(column[j] > 0.0)) return false;
        const double root = std::sqrt(column[j]);
        column[j] = root;
        const double factor = 1.0 / root;
        for (std::size_t i = j + 1; i < m.rows; ++i) column[i] *= factor;
    }
    return true;
}

/// Eliminates the first `columns` columns of a symmetric matrix with `rows` rows. The matrix stores its lower half by
/// columns. The eliminated columns become columns of L, and the rest becomes the Schur complement. Returns false if the
/// matrix is not positive definite.
bool eliminate(std::span<double> matrix, std::size_t rows, std::size_t columns) {
    const Lower m{matrix.data(), rows};
    for (std::size_t begin = 0; begin < columns; begin += kPanel) {
        const std::size_t end = std::min(columns, begin + kPanel);
        if (!eliminate_panel(m, begin, end)) return false;
        std::size_t j = end;
        for (; j + 1 < rows; j += 2) update_two(m, j, begin, end);
        if (j < rows) update_one(m, j, begin, end);
    }
    return true;
}

}  // namespace

BlockCholesky::BlockCholesky(std::size_t rows, std::span<const Pair> pairs) : order_(rows) {
    const std::vector<std::uint32_t> eliminated = elimination_order(rows, pairs);
    for (std::uint32_t k = 0; k < rows; ++k) order_[eliminated[k]] = k;
    const Lists unsorted = structure_of(order_, pairs);
    const std::vector<std::uint32_t> slot = postorder(unsorted);
    for (std::uint32_t& k : order_) k = slot[k];
    // The rows below a diagonal are ancestors of its column, and a postorder keeps the order of ancestors.
    Lists structure(rows);
    for (std::uint32_t k = 0; k < rows; ++k) {
        for (const std::uint32_t row : unsorted[k]) structure[slot[k]].push_back(slot[row]);
    }
    make_fronts(structure);
    place_entries(pairs);
}

/// Groups the columns into fronts. A column joins the front of the column before it if both have nonzeros in almost the
/// same rows. structure: for every column, the rows below its diagonal.
void BlockCholesky::make_fronts(const Lists& structure) {
    const auto rows = static_cast<std::uint32_t>(structure.size());
    front_of_.assign(rows, 0);
    for (std::uint32_t k = 0; k < rows;) {
        Front front;
        front.begin = k;
        double filled = 0.0;  // number of nonzero blocks
        for (;; ++k) {
            const auto count = static_cast<double>(k + 1 - front.begin);
            filled += 1.0 + static_cast<double>(structure[k].size());
            front_of_[k] = static_cast<std::uint32_t>(fronts_.size());
            if (structure[k].empty() || structure[k].front() != k + 1) break;
            const double next = 1.0 + static_cast<double>(structure[k + 1].size());
            const double stored = next * (count + 1.0) + 0.5 * count * (count + 1.0);
            if (stored - filled - next > kMostZeros * stored) break;
        }
        ++k;
        front.count = k - front.begin;
        front.below = structure[k - 1];
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
