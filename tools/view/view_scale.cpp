#include "tools/view/view_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ndhull {
namespace {

/// [ratio] of the largest value: what differs by less is the same but for rounding, and its ticks would be.
constexpr double kSame = 1e-9;

bool are_same(double low, double high) {
  return !(high - low > kSame * std::max(std::abs(low), std::abs(high)));
}

}  // namespace

std::vector<Tick> round_ticks(double low, double high, std::size_t count) {
  if (are_same(low, high) || !std::isfinite(high - low)) return {{low, three_digits(low)}};
  const double rough = (high - low) / static_cast<double>(count);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power < rough) continue;
    step = factor * power;
    break;
  }
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  std::vector<Tick> ticks;
  const auto slack = 1e-9 * step;
  for (double index = std::ceil((low - slack) / step); index * step <= high + slack; index += 1.0) {
    const double value = index * step + 0.0;  // no -0
    const bool is_plain = decimals <= 4 && std::abs(high) < 1e6 && std::abs(low) < 1e6;
    ticks.push_back({value, is_plain ? fmt::format("{:.{}f}", value == 0.0 ? 0.0 : value, decimals)
                                     : fmt::format("{:.4g}", value)});
  }
  return ticks;
}

std::string three_digits(double value) { return fmt::format("{:.3g}", value); }

std::string hex(const Colour& colour) {
  const auto byte = [](double part) {
    return static_cast<int>(std::lround(255.0 * std::clamp(part, 0.0, 1.0)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour[0]), byte(colour[1]), byte(colour[2]));
}

Colour lit(const Colour& colour, double brightness) {
  return {colour[0] * brightness, colour[1] * brightness, colour[2] * brightness};
}

ColourScale::ColourScale(std::span<const double> values, std::string_view title) : title_(title) {
  bool is_first = true;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low_ = is_first ? value : std::min(low_, value);
    high_ = is_first ? value : std::max(high_, value);
    is_first = false;
  }
}

bool ColourScale::is_constant() const { return are_same(low_, high_); }

double ColourScale::place_of(double value) const {
  if (!std::isfinite(value)) return 1.0;
  if (is_constant()) return 0.5;
  return std::clamp((value - low_) / (high_ - low_), 0.0, 1.0);
}

Colour ColourScale::colour_at(double place) {
  static constexpr std::array<Colour, 5> kStops{{{0.953, 0.918, 0.835},
                                                 {0.667, 0.820, 0.812},
                                                 {0.318, 0.639, 0.733},
                                                 {0.082, 0.416, 0.612},
                                                 {0.043, 0.184, 0.333}}};
  const double scaled = place * static_cast<double>(kStops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(scaled), kStops.size() - 2);
  const double part = scaled - static_cast<double>(below);
  Colour colour{};
  for (std::size_t k = 0; k < colour.size(); ++k) {
    colour[k] = kStops[below][k] + part * (kStops[below + 1][k] - kStops[below][k]);
  }
  return colour;
}

std::vector<Tick> ColourScale::ticks() const {
  if (is_constant()) return {{low_, three_digits(low_)}};
  return round_ticks(low_, high_, 5);
}

}  // namespace ndhull
