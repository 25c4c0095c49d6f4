#include "ricochet/dynamics/dense_front.h"

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

}  // namespace

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

}  // namespace ricochet
