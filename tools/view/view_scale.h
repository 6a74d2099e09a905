// Scales of a picture: round tick values and how they are written, colours of widths.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ndhull {

/// A place on a scale, and the text beside it.
struct Tick {
  double value = 0.0;
  std::string label;
};

/// About `count` multiples of 1, 2 or 5 times a power of ten in low .. high; low alone where both are the
/// same but for rounding.
std::vector<Tick> round_ticks(double low, double high, std::size_t count);

/// A number for people: three digits, and powers of ten as in 1.2e-14.
std::string three_digits(double value);

/// Red, green, blue in 0 .. 1.
using Colour = std::array<double, 3>;
std::string hex(const Colour& colour);
/// `colour` under a light of `brightness` 0 .. 1.
Colour lit(const Colour& colour, double brightness);

/// Values as colours, from sand over blue to navy: lightness falls evenly, so it reads in grey, too.
class ColourScale {
 public:
  ColourScale() = default;
  /// Linear from the least to the largest of `values`: what is asked of widths is where the large ones are.
  /// Without values, or when all are equal but for rounding, everything has the colour of the middle. What is
  /// infinite has that of the end.
  ColourScale(std::span<const double> values, std::string_view title);

  const std::string& title() const { return title_; }
  bool is_constant() const;
  /// 0 .. 1: where the value is on the scale.
  double place_of(double value) const;
  Colour colour_of(double value) const { return colour_at(place_of(value)); }
  static Colour colour_at(double place);
  std::vector<Tick> ticks() const;

 private:
  std::string title_;
  double low_ = 0.0, high_ = 0.0;
};

}  // namespace ndhull
