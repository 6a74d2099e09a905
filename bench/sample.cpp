#include "bench/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ndhull {

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double geometric_mean(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  double log_sum = 0.0;
  for (const double value : values) log_sum += std::log(value);
  return std::exp(log_sum / static_cast<double>(values.size()));
}

std::optional<double> slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto count = static_cast<double>(x.size());
  double x_mean = 0.0, y_mean = 0.0;
  for (std::size_t index = 0; index < x.size(); ++index) {
    x_mean += x[index] / count;
    y_mean += y[index] / count;
  }
  double products = 0.0, squares = 0.0;
  for (std::size_t index = 0; index < x.size(); ++index) {
    products += (x[index] - x_mean) * (y[index] - y_mean);
    squares += (x[index] - x_mean) * (x[index] - x_mean);
  }
  if (!(squares > 0.0)) return std::nullopt;
  return products / squares;
}

}  // namespace ndhull
