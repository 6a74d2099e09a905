// Reading an rbox command. Options stand in any order and nearly without grammar: a letter, for some a number
// behind it (blanks between them are skipped), then a blank. What rbox itself only tolerates is refused here
// when its result cannot be told beforehand: a wrong point set is worse than a message.

#include "tools/points/rbox_command.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>

#include "core/error.h"

namespace ndhull {
namespace {

constexpr std::size_t kMaxDimension = 200;      // rbox's own limit
constexpr std::size_t kMaxCommandLength = 180;  // rbox cuts and hashes only about 200 characters
constexpr double kIntegerBox = 1e6;             // six digits, the default box with 'z'
constexpr std::int64_t kMaxPoints = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t kSeedModulus = 2147483647;  // 2^31 - 1, of the generator

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorCode::kUsage, "rbox: " + message); }

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string join_words(std::string_view arguments) {
  std::string joined = "rbox";
  for (std::size_t at = 0; at < arguments.size(); ++at) {
    if (is_blank(arguments[at])) continue;
    if (at == 0 || is_blank(arguments[at - 1])) joined += ' ';
    joined += arguments[at];
  }
  return joined;
}

// The seed of a command without 't'. x and y hash alike so that both make the same points.
std::int32_t hash_of(const std::string& command) {
  std::uint32_t hash = 0;
  for (const char c : command) hash = 11 * hash + static_cast<unsigned char>(c == 'y' ? 'x' : c);
  return static_cast<std::int32_t>(hash);
}

class Reader {
 public:
  explicit Reader(const std::string& text) : text_(text), at_(std::string_view("rbox").size()) {}

  bool at_end() const { return at_ >= text_.size(); }
  char peek() const { return at_end() ? '\0' : text_[at_]; }
  bool at_gap() const { return at_end() || peek() == ' '; }
  void skip() { ++at_; }
  void skip_blanks() {
    while (!at_end() && peek() == ' ') ++at_;
  }
  bool skip_if(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }
  std::string rest() const { return text_.substr(std::min(at_, text_.size())); }

  // The next number, or nothing (and the place unchanged) when there is none.
  template <class Number>
  std::optional<Number> number() {
    const std::size_t start = at_;
    skip_blanks();
    std::size_t from = at_;
    if (from < text_.size() && text_[from] == '+') ++from;
    Number value{};
    const char* const begin = text_.data() + from;
    const auto [stop, status] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (status == std::errc::result_out_of_range) refuse("number out of range at '" + rest() + "'");
    if (status != std::errc{}) {
      at_ = start;
      return std::nullopt;
    }
    at_ = static_cast<std::size_t>(stop - text_.data());
    if constexpr (std::is_floating_point_v<Number>) {
      if (!std::isfinite(value)) refuse("a finite number is expected before '" + rest() + "'");
    }
    return value;
  }

 private:
  const std::string& text_;
  std::size_t at_;
};

// G, L and Z take their number only when a digit follows (blanks aside it is the next option otherwise).
std::optional<double> number_if_digit(Reader& reader) {
  return is_digit(reader.peek()) ? reader.number<double>() : std::nullopt;
}

// The G that may follow c and d; without it, `unset`. Size 0 stands for the box.
double solid_size(Reader& reader, double unset) {
  Reader ahead = reader;
  if (ahead.peek() == ' ') ahead.skip();
  if (!ahead.skip_if('G')) return unset;
  while (reader.peek() != 'G') reader.skip();
  reader.skip();
  return reader.number<double>().value_or(0.0);
}

void read_mesh(Reader& reader, RboxCommand& command) {
  command.is_mesh = true;
  const std::optional<double> first = reader.number<double>();
  if (!first) refuse("'M' without a number is not reproduced; 'M1,0' is the plain lattice");
  command.mesh[0] = *first;
  command.mesh[1] = 0.0;
  command.mesh[2] = 0.0;
  for (int k = 1; k < 3 && reader.skip_if(','); ++k) {
    const std::optional<double> value = reader.number<double>();
    if (!value) refuse("'Mn,m,r' with a comma but no number at '" + reader.rest() + "'");
    command.mesh[k] = *value;
  }
  // Without r the lattice is rotated as a whole.
  if (command.mesh[2] == 0.0)
    command.mesh[2] = std::sqrt(command.mesh[0] * command.mesh[0] + command.mesh[1] * command.mesh[1]);
}

void read_copies(Reader& reader, RboxCommand& command) {
  const std::int64_t copies = reader.number<std::int64_t>().value_or(0);
  double radius = command.copy_radius;
  auto points = static_cast<std::int64_t>(command.copied_points);
  if (reader.skip_if(',')) {
    radius = reader.number<double>().value_or(0.0);
    if (reader.skip_if(',')) points = reader.number<std::int64_t>().value_or(0);
  }
  if (copies <= 0 || radius < 0.0 || points < 0 || copies > kMaxPoints || points > kMaxPoints) {
    refuse("'Cn,r,m' wants n >= 1 copies, a radius r >= 0 and m >= 0 points");
  }
  command.copies = static_cast<std::size_t>(copies);
  command.copy_radius = radius;
  command.copied_points = static_cast<std::size_t>(points);
}

std::vector<double> read_point(Reader& reader) {
  std::vector<double> point;
  if (reader.at_gap()) {  // the origin
    Reader ahead = reader;
    ahead.skip_blanks();
    const char next = ahead.peek();
    if (is_digit(next) || next == '.' || next == '-' || next == '+')
      refuse("'P' and a number with a blank between");
    return point;
  }
  do {
    const std::optional<double> value = reader.at_gap() ? std::nullopt : reader.number<double>();
    if (!value) refuse("'Pn,m,..' with text instead of a number at '" + reader.rest() + "'");
    point.push_back(*value);
  } while (reader.skip_if(','));
  return point;
}

// The number behind 't', or the time.
std::int64_t read_seed(Reader& reader, bool uses_time) {
  if (uses_time) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::seconds>(now).count();
  }
  const std::int64_t seed = reader.number<std::int64_t>().value_or(0);
  if (seed > kSeedModulus) refuse("the seed of 'tn' is above 2147483647");
  return seed;
}

// rbox tells the time it used: the word t becomes the seed, as last word.
void write_seed(RboxCommand& c, std::int64_t seed) {
  const std::string word = " t ";
  const std::string padded = c.text + ' ';
  const std::size_t at = padded.find(word);
  if (at == std::string::npos || padded.find(word, at + 1) != std::string::npos) {
    refuse("'t' without a seed must be a word of its own, once");
  }
  c.text.erase(at, 2);
  c.text += " t" + std::to_string(seed);
}

// How many random or regular points, when the command does not say.
void settle_counts(RboxCommand& c, bool is_l, bool is_x) {
  const bool names_family =
      c.is_sphere || is_x || c.is_regular || is_l || c.has_width || c.is_mesh || c.is_lens || c.is_axis;
  if (c.count == 0) {
    if (names_family && (is_x || !c.print_simplex)) refuse("the number of points is missing");
    // rbox's default, when nothing else is asked for: 50 points on the sphere.
    if (!c.print_simplex && !c.has_cube && !c.has_diamond && c.explicit_points.empty()) {
      c.count = 50;
      c.is_sphere = true;
    }
  }
  if (c.copies > 0) {
    if (c.copied_points == 0) c.copied_points = c.count;
    if (c.count == 0 || c.copied_points > c.count)
      refuse("'Cn,r,m' wants copies of more points than there are");
  }
  if (c.has_cube && c.dimension > 26) refuse("a cube ('c') of more than 2^26 corners is not reproduced");
}

// What cannot be combined, by rbox's rules and by ours.
void check_combination(const RboxCommand& c, bool is_l, bool is_x) {
  if (is_x && c.print_simplex) refuse("'x' and 'y' together are not reproduced");
  if (c.is_lens && c.is_axis) refuse("'Ln' cannot be combined with 'Zn'");
  const int kinds = int{c.is_mesh} + int{c.is_simplex} + int{is_l} + int{c.is_lens || c.is_sphere};
  if (kinds > 1) refuse("only one of 'l', 's', 'x', 'y', 'Ln' and 'Mn,m,r' can be given ('Ln s' can)");
  if (c.is_axis && (c.is_mesh || c.is_simplex || is_l))
    refuse("'Zn' is not reproduced with 'l', 'x', 'y' or 'Mn,m,r'");
  if (c.is_mesh && c.is_regular) refuse("'Mn,m,r' is not reproduced with 'r'");
  const bool is_shape = c.is_regular && !c.is_simplex;
  if (is_shape && c.dimension != 2 && c.dimension != 3)
    refuse("regular points ('r') exist in 2-d and 3-d only");
  if (c.is_regular && c.copies > 0) refuse("'Cn,r,m' does not exist for regular points ('r')");
  if (is_l && !is_shape && c.dimension != 3) refuse("the spiral ('l') exists in 3-d only");
  if (is_l && !is_shape && c.count == 1)
    refuse("a spiral ('l') of one point is not a number; ask for 2 or more");
  if (is_shape && c.dimension == 2 && c.is_lens && c.count == 1) refuse("a lens of one point does not exist");
  if (c.is_lens && c.lens_radius <= 1.0) refuse("the lens radius of 'Ln' must be above 1");
  if (c.is_lens && c.dimension == 1 && !c.is_sphere) refuse("'Ln' without 's' needs 2-d or more");
}

/// What the options say, before they are put together.
struct Options {
  std::int64_t seed, count = 0, dimension = 3;
  bool uses_time = false;  // for a seed
  bool is_l = false, is_x = false, has_box = false;
  std::vector<std::vector<double>> points;
};

void check_text(const std::string& text) {
  if (text == "rbox D4") refuse("'D4' alone starts a self-test of the program rbox; add a count, 'D4 50'");
  if (text.size() > kMaxCommandLength) refuse("a command of more than 180 characters is not reproduced");
  if (text.find_first_of("\"'\\") != std::string::npos) refuse("quoted words are not reproduced");
}

/// One option, from its letter on.
void read_option(Reader& reader, RboxCommand& c, Options& options) {
  const std::string place = reader.rest();
  const char letter = reader.peek();
  reader.skip();
  switch (letter) {
    case 'c':
      c.has_cube = true;
      c.cube_size = solid_size(reader, c.cube_size);
      break;
    case 'd':
      c.has_diamond = true;
      c.diamond_size = solid_size(reader, c.diamond_size);
      break;
    case 'h': c.is_homogeneous = true; break;
    case 'l': options.is_l = true; break;
    case 'n': c.hides_command = true; break;
    case 'r': c.is_regular = true; break;
    case 's': c.is_sphere = true; break;
    case 't':
      options.uses_time = !is_digit(reader.peek());
      options.seed = read_seed(reader, options.uses_time);
      break;
    case 'x': options.is_x = true; break;
    case 'y': c.print_simplex = true; break;
    case 'z': c.is_integer = true; break;
    case 'B':
      options.has_box = true;
      c.box = reader.number<double>().value_or(0.0);
      break;
    case 'C': read_copies(reader, c); break;
    case 'D': options.dimension = reader.number<std::int64_t>().value_or(0); break;
    case 'G':
      c.has_gap = true;
      c.gap = number_if_digit(reader).value_or(c.gap);
      break;
    case 'L':
      c.is_lens = true;
      c.lens_radius = number_if_digit(reader).value_or(c.lens_radius);
      break;
    case 'M': read_mesh(reader, c); break;
    case 'O': c.offset = reader.number<double>().value_or(0.0); break;
    case 'P': options.points.push_back(read_point(reader)); break;
    case 'W':
      c.has_width = true;
      c.width = reader.number<double>().value_or(0.0);
      break;
    case 'Z':
      c.is_axis = true;
      c.axis_radius = number_if_digit(reader).value_or(c.axis_radius);
      break;
    default: refuse("unknown argument '" + place + "'; see 'ndhull rbox --help'");
  }
  if (!reader.at_gap()) refuse("a blank is missing between arguments at '" + reader.rest() + "'");
}

Options read_options(const std::string& text, RboxCommand& c) {
  Options options{.seed = hash_of(text), .points = {}};
  Reader reader(text);
  for (reader.skip_blanks(); !reader.at_end(); reader.skip_blanks()) {
    if (reader.skip_if('-')) continue;  // rbox takes -s for s
    if (is_digit(reader.peek())) {      // an option may follow at once
      options.count = reader.number<std::int64_t>().value_or(0);
      if (options.count > kMaxPoints) refuse("more than 2147483647 points");
    } else {
      read_option(reader, c, options);
    }
  }
  return options;
}

void settle_numbers(RboxCommand& c, const Options& options) {
  if (options.dimension < 1 || options.dimension > static_cast<std::int64_t>(kMaxDimension))
    refuse("dimension " + std::to_string(options.dimension) + " of 'D' is outside 1 .. 200");
  c.dimension = static_cast<std::size_t>(options.dimension);
  c.count = static_cast<std::size_t>(options.count);
  c.seed = static_cast<std::int32_t>(std::clamp<std::int64_t>(options.seed, 1, kSeedModulus - 1));
  if (options.uses_time) write_seed(c, options.seed);
  for (const std::vector<double>& point : options.points) {
    if (point.size() > c.dimension)
      refuse("'Pn,m,..' has more than " + std::to_string(c.dimension) + " coordinates");
    c.explicit_points.insert(c.explicit_points.end(), point.begin(), point.end());
    c.explicit_points.resize(c.explicit_points.size() + c.dimension - point.size(), 0.0);
  }
  if (c.is_integer && !options.has_box) c.box = kIntegerBox;
  if (c.cube_size == 0.0) c.cube_size = c.box;
  if (c.diamond_size == 0.0) c.diamond_size = c.box;
}

}  // namespace

RboxCommand parse_rbox(std::string_view arguments) {
  RboxCommand c;
  c.text = join_words(arguments);
  check_text(c.text);
  const Options options = read_options(std::string(c.text), c);
  settle_numbers(c, options);
  c.is_simplex = options.is_x || c.print_simplex;
  check_combination(c, options.is_l, options.is_x);
  settle_counts(c, options.is_l, options.is_x);
  c.is_spiral = options.is_l && !c.is_regular;
  c.print_simplex = c.print_simplex && !options.is_x;
  return c;
}

}  // namespace ndhull
