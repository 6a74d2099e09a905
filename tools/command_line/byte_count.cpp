#include "tools/command_line/byte_count.h"

#include <fmt/format.h>

#include <cctype>
#include <string_view>

#include "core/error.h"
#include "tools/io/text_source.h"

namespace ndhull {
namespace {

constexpr std::string_view kUnits = "BKMGT";  // 1024^0, 1024^1, ..
constexpr double kUnit = 1024.0;

/// The power of 1024 that the end of an amount names, or -1.
int exponent_of(std::string_view suffix) {
  if (suffix.empty()) return 0;
  std::string upper;
  for (const char letter : suffix) {
    upper += static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  }
  const std::size_t exponent = kUnits.find(upper[0]);
  if (exponent == std::string_view::npos) return -1;
  const std::string_view rest = std::string_view(upper).substr(1);
  const bool is_known = rest.empty() || (exponent > 0 && (rest == "B" || rest == "IB"));
  return is_known ? static_cast<int>(exponent) : -1;
}

}  // namespace

std::uint64_t parse_byte_count(const std::string& text, const std::string& option) {
  double amount = 0.0;
  const char* const end = text.data() + text.size();
  const char* const rest = parse_number(text.data(), end, amount);
  const int exponent = rest == nullptr ? -1 : exponent_of({rest, static_cast<std::size_t>(end - rest)});
  for (int k = 0; k < exponent; ++k) amount *= kUnit;
  // Above 2^63 it is no amount of memory.
  if (exponent < 0 || !(amount >= 1.0) || amount >= 0x1p63) {
    throw Error(ErrorCode::kUsage,
                fmt::format("{}: found \"{}\", expected an amount of memory above 0; write it "
                            "like 4G, 512M or 65536",
                            option, printable(text)));
  }
  return static_cast<std::uint64_t>(amount);
}

std::string format_byte_count(std::uint64_t bytes) {
  auto amount = static_cast<double>(bytes);
  std::size_t unit = 0;
  // 999.5 would be printed as 1e+03.
  while (amount >= 999.5 && unit + 1 < kUnits.size()) {
    amount /= kUnit;
    ++unit;
  }
  return fmt::format("{:.3g} {}{}", amount, kUnits[unit], unit == 0 ? "" : "B");
}

}  // namespace ndhull
