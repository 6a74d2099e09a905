// Reading an option string of Qhull letter by letter.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ndhull {

/// The text of an option string and how far it is read. What fails throws Error kUsage, one line with the
/// word that was being read and what `expected` says.
class OptionWords {
 public:
  /// `program` is what messages call the options of: qhull or qhalf.
  OptionWords(std::string_view text, std::string_view program)
      : text_(text), rest_(text), program_(program) {}

  /// Moves to the next word; false at the end. A leading '-' is skipped, and so is a word that begins with
  /// '_': Qhull lists what it has set for itself so.
  bool next_word();
  /// The word that is being read, for messages: on one line, not too long.
  std::string word() const;
  [[noreturn]] void fail(std::string_view expected) const;

  bool at_end_of_word() const { return rest_.empty() || is_gap(rest_.front()); }
  bool at_digit() const;
  bool at_number() const;
  /// The next letter of the word.
  char take();
  /// Takes `letter` when it is the next.
  bool take(char letter);
  double number(std::string_view expected);
  /// A number of 0 or more.
  double length(std::string_view expected);
  std::uint64_t count(std::string_view expected);
  /// The next word, or what stands in quotes.
  std::string path();

  /// The words, joined by one blank.
  std::string joined() const;

 private:
  static bool is_gap(char letter) {
    return letter == ' ' || letter == '\t' || letter == '\r' || letter == '\n';
  }

  std::string_view text_, rest_, word_, program_;
};

}  // namespace ndhull
