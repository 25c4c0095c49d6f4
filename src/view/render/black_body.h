/// \file
/// Light of black bodies.
/// Sources: Planck's law with the constants of CODATA 2018; C. Wyman, P.-P. Sloan, P. Shirley, "Simple Analytic
/// Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013 (the multi-lobe fit to CIE 1931, 2
/// degrees); IEC 61966-2-1 (sRGB from XYZ).
#pragma once

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Returns CIE 1931 X, Y, Z of a black body. The unit is the same for all temperatures. Returns zero unless the
/// temperature is above 0 K.
[[nodiscard]] Vec3 black_body_xyz(double kelvin);

/// Black-body colours, scaled by the luminance of a reference temperature.
class BlackBody {
public:
    /// Sets the temperature that has luminance 1, in K. It must be above 0.
    explicit BlackBody(double reference);

    /// Returns linear light (red, green, blue). A colour outside the display's gamut is clipped to it at the same
    /// luminance.
    [[nodiscard]] Vec3 light(double kelvin) const;

private:
    double scale_;
};

}  // namespace ricochet
