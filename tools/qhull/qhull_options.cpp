// One function a group of letters. What cannot be honoured is refused in one table, with the nearest thing
// that can be.
#include "tools/qhull/qhull_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "tools/io/text_source.h"
#include "tools/qhull/option_words.h"

namespace ndhull {
namespace {

/// The largest Q-digit option that Qhull has had.
constexpr std::size_t kLastDigitOption = 17;

struct Refusal {
  std::string_view option, nearest;
  std::string_view of_qhalf = {};  ///< nearest in qhalf, where that is another
};

constexpr std::string_view kLift =
    "lift the points instead (append the sum of squares as a last coordinate) and keep the lower facets with "
    "PDk:0 of that coordinate";
constexpr std::string_view kPictures = "use ndhull view for pictures";
constexpr std::string_view kFacetDump = "use Fv Fn n Fo Fa, or ndhull hull --report FILE --facet-list";
constexpr std::string_view kDual =
    "that is a format of the dual points; use Fp Fv Fn Fx FN i, or ndhull "
    "intersect --report for volume and area";
constexpr std::string_view kOfPoints =
    "that is about points; halfspaces are intersected as they are: leave it out";
constexpr std::string_view kOfPolytope =
    "use Fp Fv Fn Fx FN i, or ndhull intersect --report FILE --vertex-list";
constexpr std::string_view kOfHalfspace = "use FN, which lists the vertices of each halfspace";
constexpr std::string_view kTracing = "use TFn for progress, Ts for statistics, Tv for a check";
constexpr std::string_view kStopping = "use ndhull hull --max-facets N, or Wn for a coarser hull";

constexpr std::array kRefusals{
    Refusal{"d", kLift, kOfPoints},
    Refusal{"v", kLift, kOfPoints},
    Refusal{"u", kLift, kOfPoints},
    Refusal{"Qu", kLift, kOfPoints},
    Refusal{"Qz", kLift, kOfPoints},
    Refusal{"H", "use ndhull qhalf"},
    Refusal{"Fp", "use it with ndhull qhalf"},
    Refusal{"G", kPictures, kOfPolytope},
    Refusal{"m", kPictures, kOfPolytope},
    Refusal{"FM", kPictures, kOfPolytope},
    Refusal{"M", kPictures, kOfPolytope},
    Refusal{"f", kFacetDump, kOfPolytope},
    Refusal{"FF", kFacetDump, kOfPolytope},
    Refusal{"format of qhalf", kDual},
    Refusal{"FD of qhalf", "use ndhull intersect --vertices FILE.ext for points as cdd reads them"},
    Refusal{"R", "nothing is perturbed at random here; QJn joggles the input", kOfPoints},
    Refusal{"Qa", "correct the count in the input's header"},
    Refusal{"QR", "QR-n seeds the joggle; rotate the points before they are read", kOfPoints},
    Refusal{"QG", "remove the point from the input, and look at its distances with ndhull contains",
            kOfHalfspace},
    Refusal{"QV", "use Fv, or FN, which lists the facets of each vertex", kOfHalfspace},
    Refusal{"TA", kStopping, "use ndhull intersect --max-facets N"},
    Refusal{"TC", kStopping, "use ndhull intersect --max-facets N"},
    Refusal{"TV", kStopping, "use ndhull intersect --max-facets N"},
    Refusal{"TM", kTracing, "use Tv for a check"},
    Refusal{"TP", kTracing, "use Tv for a check"},
    Refusal{"TW", kTracing, "use Tv for a check"},
    Refusal{"Tn", kTracing, "use Tv for a check"},
};

class Parser {
 public:
  Parser(std::string_view options, QhullProgram program)
      : words_(options, program == QhullProgram::kQhalf ? "qhalf" : "qhull") {
    command_.program = program;
    command_.text = words_.joined();
  }

  QhullCommand parse() {
    while (words_.next_word()) {
      while (!words_.at_end_of_word()) read_option(words_.take());
    }
    complete();
    return std::move(command_);
  }

 private:
  [[noreturn]] void refuse(std::string_view option) const {
    const auto* const found = std::find_if(kRefusals.begin(), kRefusals.end(),
                                           [option](const Refusal& row) { return row.option == option; });
    if (found == kRefusals.end()) words_.fail("one of Qhull's options that is honoured");
    const std::string_view nearest =
        is_qhalf() && !found->of_qhalf.empty() ? found->of_qhalf : found->nearest;
    throw Error(ErrorCode::kUsage,
                fmt::format("{} options: found \"{}\", which is not supported, expected what is; {}",
                            is_qhalf() ? "qhalf" : "qhull", words_.word(), nearest));
  }

  bool is_qhalf() const { return command_.program == QhullProgram::kQhalf; }
  void format(const std::string& name, bool is_for_qhalf) {
    if (is_qhalf() && !is_for_qhalf) refuse("format of qhalf");
    // Qhull prints each format once, where it was first asked for; only the command line comes each time.
    const auto& known = command_.formats;
    const bool is_repeated = std::find(known.begin(), known.end(), name) != known.end();
    if (!is_repeated || name == "FQ") command_.formats.push_back(name);
  }

  void read_option(char letter) {
    switch (letter) {
      case 'A': return read_cosine();
      case 'C': return read_radius();
      case 'E':
        words_.length("E and a distance, like E1e-12");
        return;  // rounding is proven here, not stated
      case 'U': command_.coplanar_depth = words_.length("U and a distance, like U1e-3"); return;
      case 'V': visible_ = words_.length("V and a distance, like V1e-3"); return;
      case 'W': command_.outside_width = words_.length("W and a distance, like W1e-2"); return;
      case 'F': return read_group(&Parser::read_format);
      case 'P': return read_group(&Parser::read_print);
      case 'Q': return read_group(&Parser::read_control);
      case 'T': return read_group(&Parser::read_trace);
      case 'H': return read_interior_point();
      case 'i': return format("i", true);
      case 'n': return format("n", false);
      case 'o': return format("o", false);
      case 'p': return format("p", false);
      case 's': command_.has_summary = true; return;
      default: refuse(std::string(1, letter));
    }
  }

  void read_group(void (Parser::*read)(char)) {
    if (words_.at_end_of_word()) words_.fail("a letter behind it");
    while (!words_.at_end_of_word()) (this->*read)(words_.take());
  }

  void read_cosine() {
    words_.take('-');  // A-n is for merging while building: here all merging comes at the end
    const double cosine = words_.number("A and a cosine, like A0.95 or A-0.95");
    if (!(std::abs(cosine) <= 1.0)) words_.fail("a cosine from -1 to 1");
    command_.max_cosine = std::min(command_.max_cosine, cosine);
  }

  void read_radius() {
    words_.take('-');
    has_radius_ = true;
    command_.centrum_radius =
        std::max(command_.centrum_radius, words_.length("C and a distance, like C1e-2 or C-1e-2"));
  }

  void read_format(char letter) {
    const std::string name{'F', letter};
    switch (letter) {
      case 'v':
      case 'n':
      case 'x':
      case 'N':
      case 's':
      case 'Q': return format(name, true);
      case 'o':
      case 'i':
      case 'V':
      case 'c':
      case 't':
      case 'a':
      case 'C':
      case 'I':
      case 'm':
      case 'P':
      case 'S': return format(name, false);
      case 'p':
        if (!is_qhalf()) refuse(name);
        return format(name, true);
      case 'A':
        if (is_qhalf()) refuse("format of qhalf");
        command_.has_size = true;
        return;
      case 'd': command_.is_cdd = true; return;
      case 'D':
        if (is_qhalf()) refuse("FD of qhalf");
        command_.writes_cdd = true;
        return;
      case 'O': command_.lists_options = true; return;
      default: refuse(name);
    }
  }

  void read_print(char letter) {
    const std::string name{'P', letter};
    SelectionOptions& selection = command_.selection;
    const bool selects = letter == 'A' || letter == 'F' || letter == 'M';
    if (selects || letter == 'd' || letter == 'D') {
      if (is_qhalf()) refuse("format of qhalf");
      command_.keeps_closest = command_.keeps_closest || selects;
    }
    switch (letter) {
      case 'A': selection.largest = positive_count("PA and a number of facets, like PA10"); return;
      case 'M': selection.most_merged = positive_count("PM and a number of facets, like PM10"); return;
      case 'F': selection.min_area = words_.length("PF and an area, like PF0.1"); return;
      case 'd':
      case 'D': return read_normal_bound(letter == 'd');
      case 'g': command_.keeps_closest = command_.prints_kept = true; return;
      case 'G': command_.prints_neighbours = true; return;
      case 'p': command_.hides_warnings = true; return;
      case 'o': return;  // output although precision is lost: there always is one
      default: refuse(name);
    }
  }

  std::uint64_t positive_count(std::string_view expected) {
    const std::uint64_t value = words_.count(expected);
    if (value == 0) words_.fail(expected);
    return value;
  }

  void read_normal_bound(bool is_least) {
    constexpr std::string_view kExpected = "a coordinate and a bound from -1 to 1, like Pd0:0.5";
    NormalBound bound{words_.count(kExpected), is_least, 0.0};
    if (words_.take(':')) bound.value = words_.number(kExpected);
    if (!(std::abs(bound.value) <= 1.0)) words_.fail(kExpected);
    command_.normal_bounds.push_back(bound);
  }

  void read_control(char letter) {
    const std::string name{'Q', letter};
    switch (letter) {
      case 'b':
      case 'B': return read_scaling(letter == 'B');
      case 'c': command_.keep_coplanar = true; return;
      case 'i': command_.keep_interior = true; return;
      case 't': command_.triangulate = true; return;
      case 'J':
        command_.joggle = words_.at_number() ? words_.length("QJ and a distance, like QJ1e-9") : 0.0;
        return;
      case 'R': return read_seed();
      // How Qhull merges, partitions, searches and warns. Here all coplanar merging is delayed (Qx).
      case 'x':
      case 'f':
      case 'g':
      case 'm':
      case 'r':
      case 's':
      case 'v':
      case 'w': return;
      default: break;
    }
    if (!is_digit(letter)) refuse(name);
    std::size_t digits = static_cast<std::size_t>(letter - '0');
    if (words_.at_digit()) digits = 10 * digits + static_cast<std::size_t>(words_.take() - '0');
    if (digits > kLastDigitOption || words_.at_digit()) words_.fail("one of Q0 to Q17");
    is_unmerged_ = is_unmerged_ || digits == 0;
  }

  void read_scaling(bool is_upper) {
    if (!is_upper && words_.take('B')) {
      command_.unit_cube = true;
    } else if (!is_upper && words_.take('b')) {
      command_.scale_last = true;
    } else {
      constexpr std::string_view kExpected = "QbB, Qbb, or a coordinate and a bound like Qb0:-1B0:1";
      ColumnBound bound{words_.count(kExpected), is_upper, is_upper ? 0.5 : -0.5};
      if (words_.take(':')) bound.value = words_.number(kExpected);
      command_.column_bounds.push_back(bound);
    }
  }

  void read_seed() {
    const bool is_seed = words_.take('-');
    const std::uint64_t seed = words_.count("QR-n, a seed of the joggle");
    if (!is_seed || seed < 2) refuse("QR");
    command_.seed = seed;
  }

  void read_trace(char letter) {
    const std::string name{'T', letter};
    switch (letter) {
      case 'F': command_.progress_facets = positive_count("TF and a number of facets, like TF2000"); return;
      case 'R': command_.reruns = positive_count("TR and a number of runs, like TR100"); return;
      case 'I': command_.input_path = words_.path(); return;
      case 'O': command_.output_path = words_.path(); return;
      case 'v': command_.verify = true; return;
      case 's': command_.has_statistics = true; return;
      case 'z': command_.diagnostics_to_stdout = true; return;
      case 'a':
      case 'c':
      case 'f': return;  // codes in messages, checks while building, flushing
      default: break;
    }
    refuse(is_digit(letter) || letter == '-' ? "Tn" : name);
  }

  void read_interior_point() {
    if (!is_qhalf()) refuse("H");
    while (!words_.at_end_of_word()) {
      command_.interior_point.push_back(words_.number("H and an interior point, like H0,0.5"));
      if (!words_.at_end_of_word() && !words_.take(',')) words_.fail("H and an interior point, like H0,0.5");
    }
  }

  /// What an intersection of halfspaces has no counterpart of.
  void check_qhalf() const {
    const auto fail_at = [](std::string_view found, std::string_view remedy) {
      throw Error(ErrorCode::kUsage,
                  fmt::format("qhalf options: found {}, which is not supported; {}", found, remedy));
    };
    if (command_.outside_width.value_or(0.0) > 0.0 || command_.centrum_radius > 0.0 ||
        command_.max_cosine <= 1.0)
      fail_at("W, V, C or A",
              "approximate the hull whose planes are intersected: ndhull qhull \"W0.1 C0.01 Fo\"");
    if (command_.joggle || command_.triangulate)
      fail_at("QJ or Qt", "vertices that coincide are one vertex, and Fv lists all its halfspaces");
    if (command_.unit_cube || command_.scale_last || !command_.column_bounds.empty())
      fail_at("QbB, Qbb, Qbk or QBk", "scale the halfspaces before they are read");
    if (command_.prints_neighbours) fail_at("PG", "all vertices are printed");
  }

  void complete() {
    const bool merges = has_radius_ || command_.max_cosine <= 1.0;
    command_.is_merged = merges || !(is_unmerged_ || command_.joggle);
    // Points that are no vertices are printed: the coplanar ones, unless Qi says which.
    const auto lists_points = [](const std::string& format) { return format == "Fc" || format == "FP"; };
    if (!command_.keep_interior && std::ranges::any_of(command_.formats, lists_points))
      command_.keep_coplanar = true;
    // Qhull takes what is less than twice V outside for coplanar, unless W says otherwise.
    if (visible_ && !command_.outside_width) command_.outside_width = 2.0 * *visible_;
    if (command_.reruns > 0 && !command_.joggle) {
      throw Error(
          ErrorCode::kUsage,
          "qhull options: found TR without QJ, expected both: it measures how often joggled input has "
          "a precision problem; add QJn");
    }
    if (command_.triangulate && (command_.centrum_radius > 0.0 || command_.max_cosine <= 1.0)) {
      throw Error(
          ErrorCode::kUsage,
          "qhull options: found Qt with C or A, which is not supported: facets that were merged have one "
          "plane; use Ft or i, which print their simplices");
    }
    if (is_qhalf()) check_qhalf();
  }

  QhullCommand command_;
  OptionWords words_;
  bool is_unmerged_ = false, has_radius_ = false;
  std::optional<double> visible_;
};

}  // namespace

QhullCommand parse_qhull_command(std::string_view options, QhullProgram program) {
  return Parser(options, program).parse();
}

}  // namespace ndhull
