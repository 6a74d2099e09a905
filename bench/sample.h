// Summaries of a few repeated measurements.
#pragma once

#include <vector>

namespace ndhull {

/// Middle value, of an even number the mean of the two in the middle; NaN for none.
double median(std::vector<double> values);

/// exp(mean(log)); NaN for none. Precondition: all positive.
double geometric_mean(const std::vector<double>& values);

}  // namespace ndhull
