// Random numbers and the few functions generators need, with the same bits on every machine.
//
// The standard fixes the engine std::mt19937_64 but neither its distributions nor the last digits of log, sin
// and cos. All here is built from IEEE additions, multiplications, divisions and square roots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace ndhull {

/// One stream of random numbers.
class PortableRandom {
 public:
  explicit PortableRandom(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1), a multiple of 2^-53.
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// Uniform in [-1, 1).
  double symmetric() { return 2.0 * unit() - 1.0; }
  /// Uniform in 0 .. count - 1. Precondition: count >= 1.
  std::size_t below(std::size_t count);
  /// Normal with mean 0 and variance 1.
  /// Source  Marsaglia, Bray. A convenient method for generating normal variables. SIAM Review 6(3), 1964.
  double normal();
  /// Exponential with mean 1.
  double exponential();
  bool coin() { return (engine_() >> 63) != 0; }

 private:
  std::mt19937_64 engine_;
  double spare_normal_ = 0.0;
  bool has_spare_ = false;
};

/// Natural logarithm of a normal positive number, relative error of a few 2^-53.
double portable_log(double value);

/// A point of the unit circle.
struct CirclePoint {
  double cosine = 1.0;
  double sine = 0.0;
};
/// The point at the angle 2 pi numerator / denominator, error of a few 2^-53. Multiples of a quarter turn are
/// exact, and so is the symmetry between octants. Precondition: 1 <= denominator < 2^60.
CirclePoint portable_circle(std::uint64_t numerator, std::uint64_t denominator);

}  // namespace ndhull
