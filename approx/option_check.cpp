#include "approx/option_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>

#include "core/error.h"

namespace ndhull {
namespace {

class OptionCheck {
 public:
  OptionCheck(const HullOptions& options, OptionSpelling spelling) : options_(options), spelling_(spelling) {}

  void run() const {
    check_numbers();
    const Accuracy& accuracy = options_.accuracy;
    const bool has_target = accuracy.width.is_set() || accuracy.facets > 0;
    if (accuracy.width.is_set() && accuracy.facets > 0)
      refuse(name("width") + " with " + name("facets"),
             "one is the target, the other what comes out: give one of them");
    if (accuracy.merges_neighbours() && has_target)
      refuse(name("centrum_radius") + " or " + name("max_cosine") + " with a target",
             name("width") + " and " + name("facets") + " choose how to merge: leave it out");
    if (accuracy.effort == Effort::kThorough && (!has_target || accuracy.is_for_volume()))
      refuse(name("effort") + " thorough without a target width",
             "add " + name("width") + ", or " + name("facets") + " without " + name("objective") + " volume");
    if (accuracy.width_cap.is_set() && !accuracy.merges_neighbours())
      refuse(name("width_cap") + " without " + name("centrum_radius") + " or " + name("max_cosine"),
             "add one of these: a target needs no cap");
    if (options_.triangulate && (has_target || accuracy.merges_neighbours()))
      refuse(name("triangulate") + " with facets of several simplices, which have one plane",
             spelling_ == OptionSpelling::kProgram ? "leave it out, and print simplices with --format i"
                                                   : "leave it out, and ask for Hull::simplices");
  }

 private:
  std::string name(std::string_view field) const {
    if (spelling_ == OptionSpelling::kField) return std::string(field);
    std::string option = "--" + std::string(field);
    std::replace(option.begin(), option.end(), '_', '-');
    return option;
  }

  [[noreturn]] static void refuse(const std::string& found, const std::string& remedy) {
    throw Error(ErrorCode::kUsage, "found " + found + "; " + remedy);
  }

  void check_numbers() const {
    constexpr double kMostShift = 1e-6;
    const Accuracy& accuracy = options_.accuracy;
    check_length("width", accuracy.width);
    check_length("outside_width", accuracy.outside_width);
    check_length("centrum_radius", accuracy.centrum_radius);
    check_length("width_cap", accuracy.width_cap);
    if (!(accuracy.max_cosine >= -1.0)) refuse_number("max_cosine", accuracy.max_cosine, "-1 to 1");
    if (!(options_.shift >= 0.0 && options_.shift <= kMostShift))
      refuse_number("shift", options_.shift, "0 to 1e-6");
  }

  void check_length(std::string_view field, const Length& length) const {
    if (!(length.value >= 0.0 && std::isfinite(length.value)))
      refuse_number(field, length.value, "0 to what is finite");
  }

  [[noreturn]] void refuse_number(std::string_view field, double found, const std::string& range) const {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.9g", found);
    refuse(name(field) + " " + digits, "expected a number from " + range);
  }

  const HullOptions& options_;
  OptionSpelling spelling_;
};

}  // namespace

void check_options(const HullOptions& options, OptionSpelling spelling) {
  OptionCheck(options, spelling).run();
}

}  // namespace ndhull
