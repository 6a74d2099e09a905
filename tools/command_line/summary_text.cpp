#include "tools/command_line/summary_text.h"

#include <fmt/format.h>

namespace ndhull {

std::string grouped(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t place = digits.size(); place > 3; place -= 3) digits.insert(place - 3, 1, ',');
  return digits;
}

std::string power_of_unit(std::size_t power) {
  return power == 1 ? "[input]" : fmt::format("[input^{}]", power);
}

}  // namespace ndhull
