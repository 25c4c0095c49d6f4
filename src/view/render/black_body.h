/// \file
/// The light of hot things.
/// Sources: Planck's law with the constants of CODATA 2018; C. Wyman, P.-P. Sloan, P. Shirley, "Simple Analytic
/// Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013 (the multi-lobe fit to CIE 1931, 2
/// degrees); IEC 61966-2-1 (sRGB from XYZ).
#pragma once

#include "ricochet/core/vec3.h"

namespace ricochet {

/// CIE 1931 X, Y, Z of a black body, in one unit for all temperatures; zero for those that are not above 0 K.
[[nodiscard]] Vec3 black_body_xyz(double kelvin);

/// Black bodies beside one whose light is known.
class BlackBody {
public:
    /// At `reference`, K, > 0, the luminance is 1.
    explicit BlackBody(double reference);

    /// Linear light, red, green and blue. Colours that the display cannot show are the nearest it can, as bright.
    [[nodiscard]] Vec3 light(double kelvin) const;

private:
    double scale_;
};

}  // namespace ricochet
