// Summaries of a few repeated measurements.
#pragma once

#include <optional>
#include <vector>

namespace ndhull {

/// Middle value, of an even number the mean of the two in the middle; NaN for none.
double median(std::vector<double> values);

/// exp(mean(log)); NaN for none. Precondition: all positive.
double geometric_mean(const std::vector<double>& values);

/// Slope of the line of least squares through (x, y); none when x has fewer than two different values.
std::optional<double> slope(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace ndhull
