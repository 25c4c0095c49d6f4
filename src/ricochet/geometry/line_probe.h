/// \file
/// Where does a straight line come near a triangle? A conservative answer in a few dozen operations, for looking
/// ahead: no roots, no exact arithmetic.
#pragma once

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A segment, thickened to a tube, prepared for many triangles.
class LineProbe {
public:
    /// The segment [from, to] and everything within `margin` metres of it (> 0). `largest` bounds the coordinates of
    /// the segment and of the triangles, m; the margin must be well above 2^-46 of it.
    LineProbe(const Vec3& from, const Vec3& to, double margin, double largest)
        : from_(from), along_(to - from), margin_(margin), rounding_(kRounding * largest) {}

    /// A stretch of the segment, in fractions of it.
    struct Stretch {
        double enter = 2.0;
        double leave = -1.0;

        [[nodiscard]] bool empty() const { return enter > leave; }
    };
    /// A stretch outside of which all points of the segment are certainly further than the margin from the triangle;
    /// empty when all are. Errs on the side of more. The triangle may be degenerate.
    [[nodiscard]] Stretch near(const Vec3& a, const Vec3& b, const Vec3& c) const;

private:
    /// Of a triple product with coordinates below 1: some twenty roundings of 2^-53 and the size 4 of differences.
    static constexpr double kRounding = 0x1p-46;

    Vec3 from_;
    Vec3 along_;
    double margin_;
    double rounding_;
};

}  // namespace ricochet
