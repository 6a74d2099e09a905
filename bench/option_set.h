// What a hull is made with, as a few words that ndhull and Qhull both understand.
#pragma once

#include <string>
#include <vector>

#include "approx/accuracy.h"

namespace ndhull {

/// How accurate a hull is asked for. The text names it in tables, in results and on command lines.
struct OptionSet {
  std::string text;  ///< "exact", "W0.1 C0.01", "A0.9", "width 5%", "facets 500", "width 5% thorough"
  Accuracy accuracy;

  /// A target is ndhull's alone.
  bool is_for_qhull() const { return !accuracy.width.is_set() && accuracy.facets == 0; }
  /// Qhull's options for the same; lengths in percent become those of `largest_extent` [distance].
  std::string qhull_options(double largest_extent) const;
};

/// "exact", or words from: W<length>, C<length>, A<cosine>, width <length>, facets <number>, thorough; a
/// length is a number, in percent of the largest extent with a % behind it. Throws Error kUsage on anything
/// else.
OptionSet parse_option_set(const std::string& text);

/// Several, parted by commas.
std::vector<OptionSet> parse_option_sets(const std::string& text);

}  // namespace ndhull
