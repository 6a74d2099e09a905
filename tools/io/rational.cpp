#include "tools/io/rational.h"

#include <gmp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace ndhull {
namespace {

/// A number of GMP's.
class Whole {
 public:
  Whole() { mpz_init(number_); }
  Whole(const Whole&) = delete;
  Whole& operator=(const Whole&) = delete;
  ~Whole() { mpz_clear(number_); }

  /// False when the text is no whole number.
  bool read(std::string_view text) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    const std::string_view digits = text.substr(!text.empty() && text.front() == '-' ? 1 : 0);
    const auto is_digit = [](char letter) { return letter >= '0' && letter <= '9'; };
    if (digits.empty() || !std::all_of(digits.begin(), digits.end(), is_digit)) return false;
    return mpz_set_str(number_, std::string(text).c_str(), 10) == 0;
  }
  mpz_ptr get() { return number_; }
  int sign() const { return mpz_sgn(number_); }
  /// Bits of its size.
  long length() const { return static_cast<long>(mpz_sizeinbase(number_, 2)); }

 private:
  mpz_t number_;
};

}  // namespace

std::optional<double> nearest_quotient(std::string_view p, std::string_view q) {
  Whole numerator, denominator, quotient, rest;
  if (!numerator.read(p) || !denominator.read(q) || denominator.sign() == 0) return std::nullopt;
  if (numerator.sign() == 0) return 0.0;
  const bool is_negative = numerator.sign() != denominator.sign();
  mpz_abs(numerator.get(), numerator.get());
  mpz_abs(denominator.get(), denominator.get());
  // A quotient of 62 or 63 bits; that something is left of it makes it odd, so that it is rounded once only.
  constexpr long kBits = 62;
  const long shift = kBits - (numerator.length() - denominator.length());
  const auto distance = static_cast<mp_bitcnt_t>(std::abs(shift));
  mpz_ptr scaled = shift > 0 ? numerator.get() : denominator.get();
  mpz_mul_2exp(scaled, scaled, distance);
  mpz_tdiv_qr(quotient.get(), rest.get(), numerator.get(), denominator.get());
  std::uint64_t bits = mpz_get_ui(quotient.get());
  if (rest.sign() != 0) bits |= 1;
  const long exponent = std::clamp(-shift, -100'000L, 100'000L);
  const double size = std::ldexp(static_cast<double>(bits), static_cast<int>(exponent));
  return is_negative ? -size : size;
}

}  // namespace ndhull
