/// \file
/// Takes the noise of few samples out of a picture, and leaves edges: of surfaces, colours and shadows.
/// Method: edge-avoiding a-trous wavelets: H. Dammertz et al., "Edge-Avoiding A-Trous Wavelet Transform for fast Global
/// Illumination Filtering", HPG 2010; weights by the variance of the samples as C. Schied et al., "Spatiotemporal
/// Variance-Guided Filtering", HPG 2017, section 4.4.
#pragma once

#include <vector>

namespace ricochet {

/// Three numbers in single precision.
struct Float3 {
    float x = 0.0F;
    float y = 0.0F;
    float z = 0.0F;
};

/// What is known of a pixel: means over its samples.
struct PixelFeatures {
    Float3 normal;          ///< zero where nothing is
    Float3 albedo;          ///< colour of the surface; white where nothing is
    float distance = 0.0F;  ///< m from the camera; 0 where nothing is
    float slope = 0.0F;  ///< change of the distance, m, from this pixel to the next that the surface's slant explains
};

/// A picture with what is known of its pixels, rows from the top; all vectors have width * height entries.
struct NoisyPicture {
    int width = 0;
    int height = 0;
    std::vector<Float3> light;    ///< in the display's range
    std::vector<float> variance;  ///< of the luminance of `light`, as a mean of samples
    std::vector<PixelFeatures> features;
};

/// Filters `light`. The less its variance, the less it changes.
void filter_noise(NoisyPicture& picture);

}  // namespace ricochet
