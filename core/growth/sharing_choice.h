// Whether it pays that threads share an insertion of growth.
#pragma once

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
      if (is_tried(classes_[smaller]) &&
          classes_[smaller].shared.least < kClear * classes_[smaller].alone.least)
        return true;
    Class& own = classes_[c];
    if (++own.asked % kTrustedFor == 0) own.shared = own.alone = {};  // the machine may have changed
    if (own.shared.count < kTrials) return true;
    if (own.alone.count < kTrials) return false;
    return own.shared.least <= own.alone.least;
  }

  /// That one had `ridges` ridges and took so long.
  void took(bool was_shared, std::size_t ridges, double seconds) {
    Class& own = classes_[class_of(ridges)];
    Trial& trial = was_shared ? own.shared : own.alone;
    const double of_ridge = seconds / static_cast<double>(ridges);
    ++trial.count;
    // The least of a few: others were held up, or waited for memory that the other way had used.
    if (trial.count <= kTrials && of_ridge < trial.least) trial.least = of_ridge;
  }

 private:
  static constexpr std::size_t kTrials = 3, kTrustedFor = 128, kClasses = 32;
  static constexpr double kClear = 0.8;

  struct Trial {
    std::size_t count = 0;
    double least = std::numeric_limits<double>::infinity();
  };
  struct Class {
    Trial shared, alone;
    std::size_t asked = 0;
  };

  static std::size_t class_of(std::size_t ridges) {
    const auto bits = static_cast<std::size_t>(std::bit_width(ridges));
    return bits < kClasses ? bits : kClasses - 1;
  }
  static bool is_tried(const Class& one) { return one.shared.count >= kTrials && one.alone.count >= kTrials; }

  std::array<Class, kClasses> classes_{};
};

}  // namespace ndhull
