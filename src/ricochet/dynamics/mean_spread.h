/// \file
/// Mean and spread, as W. T. Reeves gives every quantity of his particles.
#pragma once

namespace ricochet {

/// Mean and spread: values are uniform in [mean - spread, mean + spread).
struct MeanSpread {
    double mean = 0.0;
    double spread = 0.0;  ///< >= 0
};

}  // namespace ricochet
