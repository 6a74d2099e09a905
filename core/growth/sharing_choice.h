// Whether it pays that threads share an insertion of growth.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>

namespace ndhull {

/// Chooses, insertion by insertion, between one thread and all, by what each took for a ridge. How far a line
/// of memory has to go from core to core differs by a factor of ten between machines, and another process may
/// keep a core busy: growth with two threads took 0.6 of one thread's time on one machine, 1.4 on
/// another. The choice changes no result. Insertions of about the same size are a class; one
/// after the other is about as large, so the last one tells the class of the next.
class SharingChoice {
 public:
  /// Is an insertion to be shared when the one before had so many ridges?
  bool shares(std::size_t ridges) {
    const std::size_t c = class_of(ridges);
    // What pays for smaller ones pays for larger ones.
    for (std::size_t smaller = 0; smaller < c; ++smaller)
      if (classes_[smaller].is_decided && classes_[smaller].ratio() < kClear) return true;
    Class& own = classes_[c];
    if (!own.is_decided) return own.alone.count >= kTrials;
    const bool is_shared = own.ratio() <= 1.0;
    if (own.asked++ < own.trusted_for) return is_shared;
    // The machine may have changed. To find again that sharing does not pay is to be rare.
    const std::size_t trusted_for = is_shared ? kTrustedFirst : std::min(2 * own.trusted_for, kTrustedMost);
    own = Class();
    own.trusted_for = trusted_for;
    return false;
  }

  /// That one had `ridges` ridges and took so long.
  void took(bool was_shared, std::size_t ridges, double seconds) {
    Class& own = classes_[class_of(ridges)];
    if (own.is_decided) return;
    Trial& trial = was_shared ? own.shared : own.alone;
    ++trial.count;
    // The least of a few: others were held up, or waited for memory that the other way had used.
    trial.least = std::min(trial.least, seconds / static_cast<double>(ridges));
    // Sharing that takes far longer shows early, and at once where it was so the last time.
    const bool is_far = own.ratio() > kFar;
    const std::size_t needed = is_far ? (was_far_ ? 1 : 2) : kTrials;
    own.is_decided = own.alone.count >= kTrials && own.shared.count >= needed;
    if (own.is_decided) was_far_ = is_far;
  }

 private:
  static constexpr std::size_t kTrials = 3, kTrustedFirst = 128, kTrustedMost = 2048, kClasses = 32;
  static constexpr double kClear = 0.8, kFar = 1.5;

  struct Trial {
    std::size_t count = 0;
    double least = std::numeric_limits<double>::infinity();
  };
  struct Class {
    Trial shared, alone;
    std::size_t asked = 0, trusted_for = kTrustedFirst;  // times, since it was decided
    bool is_decided = false;

    double ratio() const { return shared.least / alone.least; }
  };

  static std::size_t class_of(std::size_t ridges) {
    const auto bits = static_cast<std::size_t>(std::bit_width(ridges));
    return bits < kClasses ? bits : kClasses - 1;
  }
  std::array<Class, kClasses> classes_{};
  bool was_far_ = false;  // the last decision
};

}  // namespace ndhull
