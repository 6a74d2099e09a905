// Numbers that look random, the same on every machine: for hashes, keys and shifts.
#pragma once

#include <cstdint>

namespace ndhull {

inline constexpr std::uint64_t kScrambleStep = 0x9E37'79B9'7F4A'7C15u;

/// Another number for each. Adding kScrambleStep each time makes a stream of them.
/// Source  splitmix64. Steele, Lea, Flood. Fast splittable pseudorandom number generators. OOPSLA 2014.
constexpr std::uint64_t scramble(std::uint64_t x) {
  x += kScrambleStep;
  x = (x ^ (x >> 30)) * 0xBF58'476D'1CE4'E5B9u;
  x = (x ^ (x >> 27)) * 0x94D0'49BB'1331'11EBu;
  return x ^ (x >> 31);
}

}  // namespace ndhull
