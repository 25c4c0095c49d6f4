// The equations of a CoulombProblem, their derivatives, and the linear system of a step of Newton's method.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ricochet/response/coulomb_problem.h"

namespace ricochet {

double CoulombProblem::gain_of(std::size_t contact, const Compliance& compliance) const {
    return 1.0 / (delassus_[contact][contact] + compliance.value);
}

/// The force that would take the rate away. One that is moving wants more against its heading than it may have.
CoulombProblem::Wish CoulombProblem::wish_of(std::size_t resistance, const Compliance& compliance) const {
    const CoulombResistance& r = resistances_[resistance];
    const std::size_t i = first_[resistance];
    Wish wish;
    wish.most = friction_ * r.bound * std::max(0.0, force_[r.contact]);
    if (r.is_moving) {
        wish.size = 1.0;
        wish.force = {-r.heading[0], -r.heading[1]};
        wish.is_cut = true;
        return wish;
    }
    double diagonal = delassus_[i][i];
    if (r.size == 2) diagonal = std::max(diagonal, delassus_[i + 1][i + 1]);
    wish.gain = 1.0 / (diagonal + compliance.value);
    for (std::size_t d = 0; d < r.size; ++d) wish.force[d] = force_[i + d] - wish.gain * rate_[i + d];
    wish.size = std::sqrt(wish.force[0] * wish.force[0] + wish.force[1] * wish.force[1]);
    wish.is_cut = wish.size > wish.most;
    return wish;
}

/// Alart and Curnier's equations: N = max(0, N - gain rate), T = the wish, cut to the bound. The largest defect.
double CoulombProblem::find_defects(const Compliance& compliance) {
    const MotionVector all = change();
    for (std::size_t i = 0; i < unknowns_; ++i) {
        rate_[i] = free_rate_[i] + dot(direction_[i], all) + compliance.value * (force_[i] - compliance.anchor[i]);
    }
    for (std::size_t k = 0; k < contact_count_; ++k) {
        defect_[k] = force_[k] - std::max(0.0, force_[k] - gain_of(k, compliance) * rate_[k]);
    }
    for (std::size_t k = 0; k < resistance_count_; ++k) {
        const Wish wish = wish_of(k, compliance);
        const double part = wish.is_cut ? wish.most / wish.size : 1.0;
        for (std::size_t d = 0; d < resistances_[k].size; ++d) {
            defect_[first_[k] + d] = force_[first_[k] + d] - part * wish.force[d];
        }
    }
    double largest = 0.0;
    for (std::size_t i = 0; i < unknowns_; ++i) largest = std::max(largest, std::fabs(defect_[i]));
    return largest;
}

/// Their derivatives by the forces.
void CoulombProblem::find_matrix(const Compliance& compliance) {
    for (std::size_t k = 0; k < contact_count_; ++k) {
        const double gain = gain_of(k, compliance);
        const bool is_closed = force_[k] > gain * rate_[k];
        for (std::size_t j = 0; j < unknowns_; ++j) matrix_[k][j] = is_closed ? gain * delassus_[k][j] : 0.0;
        matrix_[k][k] = 1.0;
    }
    for (std::size_t k = 0; k < resistance_count_; ++k) find_rows_of(k, compliance);
}

void CoulombProblem::find_rows_of(std::size_t resistance, const Compliance& compliance) {
    const CoulombResistance& r = resistances_[resistance];
    const std::size_t i = first_[resistance];
    const Wish wish = wish_of(resistance, compliance);
    const bool cut = wish.is_cut;
    const double part = cut ? wish.most / wish.size : 1.0;
    const std::array unit{cut ? wish.force[0] / wish.size : 0.0, cut ? wish.force[1] / wish.size : 0.0};
    for (std::size_t d = 0; d < r.size; ++d) {
        for (std::size_t j = 0; j < unknowns_; ++j) {
            double of_wish = 0.0;  // derivative of what the bound leaves of the wish
            for (std::size_t e = 0; e < r.size && !r.is_moving; ++e) {
                const double own = i + e == j ? 1.0 - wish.gain * compliance.value : 0.0;
                const double turned = (d == e ? 1.0 : 0.0) - unit[d] * unit[e];
                of_wish += part * turned * (own - wish.gain * delassus_[i + e][j]);
            }
            matrix_[i + d][j] = (i + d == j ? 1.0 : 0.0) - of_wish;
        }
        if (cut && force_[r.contact] > 0.0) matrix_[i + d][r.contact] -= friction_ * r.bound * unit[d];
    }
}

/// Gaussian elimination with partial pivoting.
bool CoulombProblem::eliminate() {
    for (std::size_t c = 0; c < unknowns_; ++c) {
        std::size_t pivot = c;
        for (std::size_t i = c + 1; i < unknowns_; ++i) {
            if (std::fabs(matrix_[i][c]) > std::fabs(matrix_[pivot][c])) pivot = i;
        }
        if (!(std::fabs(matrix_[pivot][c]) > 0.0)) return false;
        if (pivot != c) {
            for (std::size_t j = c; j < unknowns_; ++j) std::swap(matrix_[pivot][j], matrix_[c][j]);
            std::swap(defect_[pivot], defect_[c]);
        }
        const double inverse = 1.0 / matrix_[c][c];
        for (std::size_t i = c + 1; i < unknowns_; ++i) {
            const double factor = matrix_[i][c] * inverse;
            if (factor == 0.0) continue;
            for (std::size_t j = c + 1; j < unknowns_; ++j) matrix_[i][j] -= factor * matrix_[c][j];
            defect_[i] -= factor * defect_[c];
        }
    }
    for (std::size_t c = unknowns_; c-- > 0;) {
        double sum = defect_[c];
        for (std::size_t j = c + 1; j < unknowns_; ++j) sum -= matrix_[c][j] * defect_[j];
        defect_[c] = sum / matrix_[c][c];
    }
    return true;
}

}  // namespace ricochet
