#include "bench/option_set.h"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <cmath>
#include <sstream>
#include <string_view>

#include "core/error.h"

namespace ndhull {
namespace {

[[noreturn]] void refuse(const std::string& text, std::string_view word) {
  throw Error(ErrorCode::kUsage,
              fmt::format("options \"{}\": found \"{}\", expected exact, or of W0.1, C1%, A0.95, width 5%, "
                          "facets 500, thorough",
                          text, word));
}

double parse_number(const std::string& text, std::string_view word, std::string_view number) {
  double value = 0.0;
  const auto [end, error] = fast_float::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size() || !std::isfinite(value)) {
    refuse(text, word);
  }
  return value;
}

Length parse_length(const std::string& text, std::string_view word) {
  Length length;
  std::string_view number = word;
  if (!number.empty() && number.back() == '%') {
    length.is_percent = true;
    number.remove_suffix(1);
  }
  length.value = parse_number(text, word, number);
  if (length.value <= 0.0) refuse(text, word);
  return length;
}

double distance_of(const Length& length, double largest_extent) {
  return length.is_percent ? 0.01 * length.value * largest_extent : length.value;
}

}  // namespace

std::string OptionSet::qhull_options(double largest_extent) const {
  std::string options;
  if (accuracy.outside_width.is_set()) {
    options += fmt::format(" W{}", distance_of(accuracy.outside_width, largest_extent));
  }
  if (accuracy.centrum_radius.is_set()) {
    options += fmt::format(" C{}", distance_of(accuracy.centrum_radius, largest_extent));
  }
  if (accuracy.max_cosine <= 1.0) options += fmt::format(" A{}", accuracy.max_cosine);
  return options;
}

OptionSet parse_option_set(const std::string& text) {
  OptionSet set;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    set.text += (set.text.empty() ? "" : " ") + word;
    if (word == "exact") continue;
    if (word == "thorough") {
      set.accuracy.effort = Effort::kThorough;
      continue;
    }
    if (word == "width" || word == "facets") {
      std::string value;
      if (!(words >> value)) refuse(text, word);
      set.text += " " + value;
      if (word == "width") {
        set.accuracy.width = parse_length(text, value);
        continue;
      }
      const double count = parse_number(text, value, value);
      if (count < 1.0 || count > 1e15 || count != std::floor(count)) refuse(text, value);
      set.accuracy.facets = static_cast<std::uint64_t>(count);
      continue;
    }
    const std::string_view value = std::string_view(word).substr(1);
    switch (word.front()) {
      case 'W': set.accuracy.outside_width = parse_length(text, value); break;
      case 'C': set.accuracy.centrum_radius = parse_length(text, value); break;
      case 'A': {
        set.accuracy.max_cosine = parse_number(text, word, value);
        if (std::abs(set.accuracy.max_cosine) > 1.0) refuse(text, word);
        break;
      }
      default: refuse(text, word);
    }
  }
  if (set.text.empty()) refuse(text, "");
  return set;
}

std::vector<OptionSet> parse_option_sets(const std::string& text) {
  std::vector<OptionSet> sets;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) sets.push_back(parse_option_set(part));
  return sets;
}

}  // namespace ndhull
