#include "tools/qhull/option_words.h"

#include <fmt/format.h>

#include "core/error.h"
#include "tools/io/text_source.h"

namespace ndhull {
namespace {

std::string_view first_word(std::string_view text) { return text.substr(0, text.find_first_of(" \t\r\n")); }

}  // namespace

bool OptionWords::next_word() {
  for (;;) {
    while (!rest_.empty() && is_gap(rest_.front())) rest_.remove_prefix(1);
    take('-');
    word_ = first_word(rest_);
    if (!word_.starts_with('_')) return !word_.empty();
    rest_.remove_prefix(word_.size());
  }
}

std::string OptionWords::word() const { return printable(word_); }

void OptionWords::fail(std::string_view expected) const {
  throw Error(ErrorCode::kUsage,
              fmt::format("{0} options: found \"{1}\", expected {2}; see ndhull {0} --help", program_, word(),
                          expected));
}

bool OptionWords::at_digit() const { return !rest_.empty() && is_digit(rest_.front()); }

bool OptionWords::at_number() const {
  return at_digit() || (!rest_.empty() && (rest_.front() == '-' || rest_.front() == '.'));
}

char OptionWords::take() {
  const char letter = rest_.front();
  rest_.remove_prefix(1);
  return letter;
}

bool OptionWords::take(char letter) {
  if (rest_.empty() || rest_.front() != letter) return false;
  rest_.remove_prefix(1);
  return true;
}

double OptionWords::number(std::string_view expected) {
  double value = 0.0;
  const char* const end = parse_number(rest_.data(), rest_.data() + rest_.size(), value);
  if (end == nullptr) fail(expected);
  rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
  return value;
}

double OptionWords::length(std::string_view expected) {
  const double value = number(expected);
  if (value < 0.0) fail(expected);
  return value;
}

std::uint64_t OptionWords::count(std::string_view expected) {
  std::size_t value = 0;
  const char* const end = parse_count(rest_.data(), rest_.data() + rest_.size(), value);
  if (end == nullptr) fail(expected);
  rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
  return value;
}

std::string OptionWords::path() {
  while (!rest_.empty() && is_gap(rest_.front())) rest_.remove_prefix(1);
  if (rest_.empty()) fail("a file name behind it");
  const char quote = rest_.front();
  const bool is_quoted = quote == '\'' || quote == '"';
  if (is_quoted) rest_.remove_prefix(1);
  const std::size_t size = is_quoted ? rest_.find(quote) : first_word(rest_).size();
  if (size == std::string_view::npos) fail("a file name in quotes that end");
  std::string name(rest_.substr(0, size));
  if (name.empty()) fail("a file name that is not empty");
  rest_.remove_prefix(size + (is_quoted ? 1 : 0));
  return name;
}

std::string OptionWords::joined() const {
  std::string words;
  std::string_view rest = text_;
  for (;;) {
    while (!rest.empty() && is_gap(rest.front())) rest.remove_prefix(1);
    if (rest.empty()) return words;
    const std::string_view word = first_word(rest);
    words += (words.empty() ? "" : " ") + std::string(word);
    rest.remove_prefix(word.size());
  }
}

}  // namespace ndhull
