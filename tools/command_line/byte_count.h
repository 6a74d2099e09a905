// Amounts of memory as people write them.
#pragma once

#include <cstdint>
#include <string>

namespace ndhull {

/// "4G", "512M", "1.5g", "2GiB", "65536": [bytes]. K, M, G and T are powers of 1024.
/// Throws Error kUsage: not an amount above 0; `option` names the option in the message.
std::uint64_t parse_byte_count(const std::string& text, const std::string& option);

/// "512 B", "3.4 MB", "12 GB": two or three digits, powers of 1024.
std::string format_byte_count(std::uint64_t bytes);

}  // namespace ndhull
