/// \file
/// Removes the noise of few samples from a picture, and preserves edges of surfaces, colours and shadows.
/// Method: edge-avoiding a-trous wavelets (H. Dammertz et al., "Edge-Avoiding A-Trous Wavelet Transform for fast
/// Global Illumination Filtering", HPG 2010). The weights use the variance of the samples (C. Schied et al.,
/// "Spatiotemporal Variance-Guided Filtering", HPG 2017, section 4.4).
#pragma once

#include <vector>

namespace ricochet {

/// A vector in single precision.
struct Float3 {
    float x = 0.0F;
    float y = 0.0F;
    float z = 0.0F;
};

/// Features of a pixel: means over its samples.
struct PixelFeatures {
    Float3 normal;          ///< zero if the pixel is empty
    Float3 albedo;          ///< colour of the surface; white if the pixel is empty
    float distance = 0.0F;  ///< distance from the camera, in m; 0 if the pixel is empty
    float slope = 0.0F;     ///< change of the distance to the next pixel that the surface's slant explains, in m
};

/// A picture with the features of its pixels. Rows start at the top. All vectors have width * height entries.
struct NoisyPicture {
    int width = 0;
    int height = 0;
    std::vector<Float3> light;    ///< in the display's range
    std::vector<float> variance;  ///< variance of the luminance of `light`, as a mean of samples
    std::vector<PixelFeatures> features;
};

/// Filters `light`. Pixels with a lower variance change less.
void filter_noise(NoisyPicture& picture);

}  // namespace ricochet
