// Numbers as the summaries of commands print them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace ndhull {

/// 53940 as 53,940.
std::string grouped(std::uint64_t count);
/// The unit of a volume: [input], [input^2], ..
std::string power_of_unit(std::size_t power);

}  // namespace ndhull
