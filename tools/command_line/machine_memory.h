// What memory a run may take where nobody has said so.
#pragma once

#include <cstdint>
#include <filesystem>

namespace ndhull {

/// [bytes] that processes can still take: of the machine, and of each control group that this process is in;
/// pages of files count as free. 0: not known. `root`: where /proc and /sys are looked for.
std::uint64_t available_memory_bytes(const std::filesystem::path& root = "/");

/// [bytes] that a run takes at most when its user has set no limit: growth ends before the machine has no
/// memory left, since a system that runs out of it ends the program without an answer. 0: not known.
std::uint64_t memory_of_machine();

}  // namespace ndhull
