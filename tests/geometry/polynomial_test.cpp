#include "ricochet/geometry/sweep/polynomial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ricochet/core/random.h"
#include "support/exact_oracle.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns sum |c_k| duration^k. Errors are relative to it.
double magnitude(const Polynomial& p) {
    double sum = 0.0;
    for (int k = p.degree; k >= 0; --k) {
        sum = std::fabs(p.coefficients[static_cast<std::size_t>(k)].hi) + p.duration * sum;
    }
    return sum;
}

using testing::exact;
using testing::Rational;
using Coefficients = std::vector<Rational>;  // in ascending order

constexpr std::uint64_t kSeed = 20240611;

/// Random numbers of one case.
class Draws {
public:
    explicit Draws(std::uint64_t index) : random_(kSeed, 0, index) {}
    double uniform(double low, double high) { return low + (high - low) * random_.uniform(); }
    int whole(int low, int high) { return low + static_cast<int>(random_.uniform() * (high - low + 1)); }

private:
    RandomSequence random_;
};

Coefficients times_factor(const Coefficients& p, const Coefficients& factor) {
    Coefficients product(p.size() + factor.size() - 1);
    for (std::size_t i = 0; i < p.size(); ++i) {
        for (std::size_t j = 0; j < factor.size(); ++j) product[i + j] += p[i] * factor[j];
    }
    return product;
}

Rational value_at(const Coefficients& p, const Rational& s) {
    Rational sum = 0;
    for (std::size_t k = p.size(); k-- > 0;) sum = sum * s + p[k];
    return sum;
}

/// Rounds the coefficients to the nearest double-doubles.
Polynomial rounded_polynomial(const Coefficients& p, double duration) {
    Polynomial result;
    result.degree = static_cast<int>(p.size()) - 1;
    result.duration = duration;
    for (std::size_t k = 0; k < p.size(); ++k) {
        const double hi = static_cast<double>(p[k]);
        result.coefficients[k] = fast_two_sum(hi, static_cast<double>(Rational(p[k] - exact(hi))));
    }
    return result;
}

Coefficients exact_coefficients(const Polynomial& p) {
    Coefficients c;
    for (int k = 0; k <= p.degree; ++k) c.push_back(exact(p.coefficients[static_cast<std::size_t>(k)]));
    return c;
}

void trim(Coefficients& p) {
    while (!p.empty() && p.back() == 0) p.pop_back();
}

/// Returns the number of distinct real roots in (from, to] by Sturm's theorem. p must not be zero at both ends.
int sturm_count(Coefficients p, const Rational& from, const Rational& to) {
    trim(p);
    Coefficients derivative;
    for (std::size_t k = 1; k < p.size(); ++k) derivative.push_back(p[k] * static_cast<int>(k));
    std::vector<Coefficients> chain{p, derivative};
    while (chain.back().size() > 1) {
        Coefficients rest = chain[chain.size() - 2];
        const Coefficients& by = chain.back();
        while (rest.size() >= by.size()) {
            const Rational quotient = rest.back() / by.back();
            const std::size_t shift = rest.size() - by.size();
            for (std::size_t k = 0; k < by.size(); ++k) rest[shift + k] -= quotient * by[k];
            rest.back() = 0;
            trim(rest);
        }
        if (rest.empty()) break;
        for (Rational& x : rest) x = -x;
        chain.push_back(rest);
    }
    const auto variations = [&](const Rational& s) {
        int count = 0;
        int previous = 0;
        for (const Coefficients& q : chain) {
            const int sign = testing::sign_of(value_at(q, s));
            count += static_cast<int>(sign * previous < 0);
            if (sign != 0) previous = sign;
        }
        return count;
    };
    return variations(from) - variations(to);
}

/// Returns a polynomial of degree 1 to 6 with roots in and around [0, duration], clustered in some cases.
Polynomial random_polynomial(std::uint64_t index, bool may_cluster = true) {
    Draws draw(index);
    const int degree = draw.whole(1, 6);
    const double duration = std::exp2(draw.whole(-12, 4));
    const double center = draw.uniform(0.05, 0.95);
    const double spread = draw.whole(0, 1) == 0 || !may_cluster ? 0.0 : std::exp2(-draw.whole(3, 40));
    Coefficients p{exact(draw.uniform(-1.0, 1.0))};
    while (static_cast<int>(p.size()) <= degree) {
        const bool is_pair = degree - static_cast<int>(p.size()) >= 1 && draw.whole(0, 2) == 0;
        const double position = spread > 0.0 ? center + spread * draw.uniform(-1.0, 1.0) : draw.uniform(-0.5, 1.5);
        const Rational root = exact(position) * exact(duration);
        if (is_pair) {
            const Rational imaginary = exact(draw.uniform(0.0, 0.5) * duration);
            p = times_factor(p, {root * root + imaginary * imaginary, -2 * root, 1});
        } else {
            p = times_factor(p, {-root, 1});
        }
    }
    return rounded_polynomial(p, duration);
}

/// Returns true if p has opposite signs (or a zero) within `ulps` on either side of s.
bool brackets_a_root(const Coefficients& p, double s, double ulps) {
    const Rational margin = exact(ulps * (std::nextafter(s, 1e300) - s));
    return testing::sign_of(value_at(p, exact(s) - margin)) * testing::sign_of(value_at(p, exact(s) + margin)) <= 0;
}

TEST(PolynomialRoots, AreWithinTwoUlpOrHaveValuesBelowRounding) {
    int roots = 0;
    for (std::uint64_t index = 0; index < 4000; ++index) {
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        const Polynomial p = random_polynomial(index);
        const Coefficients exact_p = exact_coefficients(p);
        for (const double s : sign_changes(p)) {
            const bool is_tiny =
                boost::multiprecision::abs(value_at(exact_p, exact(s))) <= exact(0x1p-97 * magnitude(p));
            EXPECT_TRUE(is_tiny || brackets_a_root(exact_p, s, 2.0)) << s;
            ++roots;
        }
    }
    EXPECT_GT(roots, 4000);
}

TEST(PolynomialRoots, EncloseIntervalsOfConstantSignUpToTheStatedBound) {
    for (std::uint64_t index = 0; index < 2000; ++index) {
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        const Polynomial p = random_polynomial(index);
        const Times times = sign_changes(p);
        const Rational bound = exact(0x1p-76 * magnitude(p));
        double from = 0.0;
        for (int i = 0; i <= times.count; ++i) {
            const double to = i < times.count ? times[i] : p.duration;
            const double before = p.value(0.0).hi;
            const bool is_positive = (before > 0.0) == (i % 2 == 0);
            Coefficients raised = exact_coefficients(p);  // sign * p + bound must stay positive
            if (!is_positive) {
                for (Rational& c : raised) c = -c;
            }
            raised[0] += bound;
            EXPECT_GT(value_at(raised, exact(from)), 0);
            EXPECT_EQ(sturm_count(raised, exact(from), exact(to)), 0) << "between " << from << " and " << to;
            from = to;
        }
    }
}

TEST(PolynomialRoots, MatchTheCountOfSturmsTheoremIfTheyAreApart) {
    for (std::uint64_t index = 0; index < 4000; ++index) {
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        const Polynomial p = random_polynomial(index, /*may_cluster=*/false);
        EXPECT_EQ(sign_changes(p).count, sturm_count(exact_coefficients(p), 0, exact(p.duration)));
    }
}

/// q(s) ((s - middle)^2 - depth) with q positive: a dip that becomes shallower.
Polynomial dipping_polynomial(std::uint64_t index, double depth) {
    Draws draw(index);
    const double middle = draw.uniform(0.1, 0.9);
    Coefficients p{exact(middle) * exact(middle) - exact(depth), -2 * exact(middle), 1};
    const int pairs = draw.whole(0, 2);
    for (int i = 0; i < pairs; ++i) {
        const Rational center = exact(draw.uniform(-1.0, 2.0));
        p = times_factor(p, {center * center + exact(draw.uniform(0.01, 1.0)), -2 * center, 1});
    }
    return rounded_polynomial(p, 1.0);
}

TEST(PolynomialRoots, AreFoundInDipsDeeperThanTheStatedBound) {
    for (std::uint64_t index = 0; index < 400; ++index) {
        for (int exponent = 20; exponent <= 100; exponent += 4) {
            SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed << ", depth 2^-" << exponent);
            const double depth = std::exp2(-exponent);
            const Polynomial p = dipping_polynomial(index, depth);
            const Rational dip = exact(p.value(Draws(index).uniform(0.1, 0.9)));
            if (-dip < exact(0x1p-76 * magnitude(p))) continue;
            const Times times = sign_changes(p);
            ASSERT_EQ(times.count, 2);
            EXPECT_LE(std::fabs(times[1] - times[0] - 2.0 * std::sqrt(depth)), 0x1p-50 + 1e-6 * std::sqrt(depth));
            EXPECT_EQ(down_crossings(p, 0.0, 1.0).count, 1);
        }
    }
}

TEST(PolynomialRoots, AreNotReportedForDipsThatStayAboveZero) {
    for (std::uint64_t index = 0; index < 400; ++index) {
        for (int exponent = 20; exponent <= 80; exponent += 4) {
            SCOPED_TRACE(::testing::Message()
                         << "case " << index << " of seed " << kSeed << ", height 2^-" << exponent);
            const Polynomial p = dipping_polynomial(index, -std::exp2(-exponent));
            EXPECT_EQ(sign_changes(p).count, 0);
            EXPECT_EQ(down_crossings(p, 0.0, 1.0).count, 0);
        }
    }
}

TEST(PolynomialRoots, AreTheNearestDoublesForQuadraticsEvenIfTheDiscriminantCancels) {
    for (std::uint64_t index = 0; index < 2000; ++index) {
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        Draws draw(index);
        const double first = draw.uniform(0.0, 1.0);
        const double second = first + std::exp2(-draw.whole(1, 50));
        const Polynomial p =
            rounded_polynomial(times_factor({-exact(first), 1}, {-exact(second), exact(draw.uniform(0.5, 2.0))}), 2.0);
        for (const double s : sign_changes(p)) EXPECT_TRUE(brackets_a_root(exact_coefficients(p), s, 1.0));
    }
}

Polynomial polynomial(const std::vector<double>& coefficients, double duration) {
    Polynomial p;
    p.degree = static_cast<int>(coefficients.size()) - 1;
    p.duration = duration;
    for (std::size_t k = 0; k < coefficients.size(); ++k) p.coefficients[k] = DoubleDouble(coefficients[k]);
    return p;
}

TEST(SignChanges, ExcludeDoubleRootsAndTheEnds) {
    EXPECT_EQ(sign_changes(polynomial({1, -2, 1}, 2.0)).count, 0);             // (s - 1)^2
    EXPECT_EQ(sign_changes(polynomial({0, 1}, 1.0)).count, 0);                 // root at 0
    EXPECT_EQ(sign_changes(polynomial({-1, 1}, 1.0)).count, 0);                // root at the end
    EXPECT_EQ(sign_changes(polynomial({0, 0, 0, 0, 0, 0, 0}, 1.0)).count, 0);  // zero
    const Times triple = sign_changes(polynomial({-1, 3, -3, 1}, 2.0));        // (s - 1)^3
    ASSERT_EQ(triple.count, 1);
    EXPECT_NEAR(triple[0], 1.0, 1e-9);
}

TEST(DownCrossings, CountDoubleRootsAndTheEndButNotAStartAtZero) {
    const Times touch = down_crossings(polynomial({1, -2, 1}, 2.0), 0.0, 2.0);
    ASSERT_EQ(touch.count, 1);
    EXPECT_EQ(touch[0], 1.0);
    const Times last = down_crossings(polynomial({1, -1}, 1.0), 0.0, 1.0);
    ASSERT_EQ(last.count, 1);
    EXPECT_EQ(last[0], 1.0);
    EXPECT_EQ(down_crossings(polynomial({0, -1}, 1.0), 0.0, 1.0).count, 0);
    EXPECT_EQ(down_crossings(polynomial({1, -1}, 2.0), 1.0, 2.0).count, 0);  // it came down at `from`
}

TEST(DownCrossings, EndWithTheIntervalEvenIfTheRootRoundsToItsEnd) {
    const DoubleDouble just_after{1.0, 0x1p-80};
    const DoubleDouble just_before{1.0, -0x1p-80};
    Polynomial p = polynomial({1, -1}, 1.0);
    p.coefficients[0] = just_after;  // root at 1 + 2^-80
    EXPECT_EQ(down_crossings(p, 0.0, 1.0).count, 0);
    p.coefficients[0] = just_before;
    ASSERT_EQ(down_crossings(p, 0.0, 1.0).count, 1);
    EXPECT_EQ(down_crossings(p, 0.0, 1.0)[0], 1.0);
    p.duration = 2.0;
    p.coefficients[0] = just_after;
    EXPECT_EQ(down_crossings(p, 1.0, 2.0).count, 1);
    p.coefficients[0] = just_before;
    EXPECT_EQ(down_crossings(p, 1.0, 2.0).count, 0);
}

TEST(DownCrossings, DoNotDependOnTheSubdivisionOfTheInterval) {
    for (std::uint64_t index = 0; index < 2000; ++index) {
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        const Polynomial p = random_polynomial(index);
        const Times whole = down_crossings(p, 0.0, p.duration);
        const double cut = Draws(index + 1000000).uniform(0.0, 1.0) * p.duration;
        const Times early = down_crossings(p, 0.0, cut);
        const Times late = down_crossings(p, cut, p.duration);
        ASSERT_EQ(early.count + late.count, whole.count);
        for (int i = 0; i < early.count; ++i) EXPECT_EQ(early[i], whole[i]);
        for (int i = 0; i < late.count; ++i) EXPECT_EQ(late[i], whole[early.count + i]);
    }
}

TEST(CertainlyPositive, IsNeverTrueForAPolynomialThatReachesZero) {
    int certain = 0;
    for (std::uint64_t index = 0; index < 4000; ++index) {
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        const Polynomial p = random_polynomial(index);
        if (!is_certainly_positive(p, p.duration)) continue;
        ++certain;
        EXPECT_EQ(sturm_count(exact_coefficients(p), 0, exact(p.duration)), 0);
        EXPECT_GT(p.coefficients[0].hi, 0.0);
    }
    EXPECT_GT(certain, 100);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
