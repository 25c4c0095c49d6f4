/// \file
/// Filter that removes the noise of a picture with few samples per pixel, and preserves edges of surfaces, colours and
/// shadows.
/// Method: edge-avoiding a-trous wavelets (H. Dammertz et al., "Edge-Avoiding A-Trous Wavelet Transform for fast Global
/// Illumination Filtering", HPG 2010). The weights use the variance of the samples (C. Schied et al., "Spatiotemporal
/// Variance-Guided Filtering", HPG 2017, section 4.4).
#pragma once

#include <vector>

namespace ricochet {

/// A vector in single precision.
struct Float3 {
    float x = 0.0F;
    float y = 0.0F;
    float z = 0.0F;
};

/// Surface features of a pixel, as means over its samples.
struct PixelFeatures {
    Float3 normal;          ///< zero if the pixel is empty
    Float3 albedo;          ///< colour of the surface; white if the pixel is empty
    float distance = 0.0F;  ///< distance from the camera, in m; 0 if the pixel is empty
    /// Change of `distance` from one pixel to the next, in m, because the surface is inclined.
    float slope = 0.0F;
};

/// Picture with the features of its pixels. The first row is at the top. All vectors have width * height entries.
struct NoisyPicture {
    int width = 0;
    int height = 0;
    std::vector<Float3> light;    ///< in the display's range
    std::vector<float> variance;  ///< variance of the luminance of `light`, which is a mean of samples
    std::vector<PixelFeatures> features;
};

/// Filters `light`. Pixels with a low variance change less than pixels with a high variance.
void filter_noise(NoisyPicture& picture);

}  // namespace ricochet
