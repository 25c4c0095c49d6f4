/// \file
/// Colours of the light of black bodies.
/// Sources: Planck's law with the constants of CODATA 2018; C. Wyman, P.-P. Sloan, P. Shirley, "Simple Analytic
/// Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013 (the multi-lobe fit to CIE 1931, 2
/// degrees); IEC 61966-2-1 (sRGB from XYZ).
#pragma once

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Returns the CIE 1931 coordinates X, Y, Z of a black body's light, in a unit that is the same for all temperatures.
/// Returns zero if the temperature is not above 0 K.
[[nodiscard]] Vec3 black_body_xyz(double kelvin);

/// Black-body colours, scaled by the luminance of a reference temperature.
class BlackBody {
public:
    /// Sets the temperature whose light has luminance 1, in K. The temperature must be above 0.
    explicit BlackBody(double reference);

    /// Returns linear light (red, green, blue). If the colour is outside the display's gamut, negative channels are set
    /// to 0 and the luminance is restored.
    [[nodiscard]] Vec3 light(double kelvin) const;

private:
    double scale_;
};

}  // namespace ricochet
