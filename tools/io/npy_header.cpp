// The header is a Python dictionary literal with three known keys. Only what NumPy writes is understood:
// quoted strings, True and False, and a tuple of integers.
#include "tools/io/npy_header.h"

#include <fmt/format.h>

#include <charconv>

#include "core/error.h"
#include "tools/io/text_source.h"

namespace ndhull {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kAlignment = 64;  // of the data, since NumPy 1.14

/// Walks over the dictionary; every mismatch is a kBadHeader.
class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  NpyHeader read() {
    NpyHeader header;
    bool has_type = false;
    bool has_order = false;
    bool has_shape = false;
    expect('{');
    while (!accept('}')) {
      const std::string key = string();
      expect(':');
      if (key == "descr") {
        header.type = peek() == '[' ? record() : string();
        has_type = true;
      } else if (key == "fortran_order") {
        header.fortran_order = boolean();
        has_order = true;
      } else if (key == "shape") {
        header.shape = tuple();
        has_shape = true;
      } else {
        fail("key '" + printable(key) + "'");
      }
      if (!accept(',') && peek() != '}') fail("text after the value of " + key);
    }
    if (!has_type || !has_order || !has_shape) fail("a header without descr, fortran_order or shape");
    return header;
  }

 private:
  [[noreturn]] void fail(const std::string& found) const {
    throw Error(
        ErrorCode::kBadHeader,
        fmt::format("{}, header, byte {}: found {}, expected what numpy.save writes; save the array again",
                    name_, at_, found));
  }
  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }
  char peek() {
    skip();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool accept(char letter) {
    if (peek() != letter) return false;
    ++at_;
    return true;
  }
  void expect(char letter) {
    if (!accept(letter)) fail(fmt::format("no '{}'", letter));
  }
  std::string string() {
    const char quote = peek();
    if (quote != '\'' && quote != '"') fail("no quoted string");
    const std::size_t close = text_.find(quote, at_ + 1);
    if (close == std::string_view::npos) fail("a string without end");
    std::string value(text_.substr(at_ + 1, close - at_ - 1));
    at_ = close + 1;
    return value;
  }
  // Record types are lists of tuples; they are named in the error message and not read.
  std::string record() {
    const std::size_t start = at_;
    std::size_t depth = 0;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '[') ++depth;
      if (text_[at_] == ']' && --depth == 0) return std::string(text_.substr(start, ++at_ - start));
    }
    fail("a list without end");
  }
  bool boolean() {
    skip();
    for (const bool value : {false, true}) {
      const std::string_view word = value ? "True" : "False";
      if (text_.substr(at_).starts_with(word)) {
        at_ += word.size();
        return value;
      }
    }
    fail("neither True nor False");
  }
  std::vector<std::size_t> tuple() {
    std::vector<std::size_t> values;
    expect('(');
    while (!accept(')')) {
      skip();
      std::size_t value = 0;
      const char* const first = text_.data() + at_;
      const auto [stop, error] = std::from_chars(first, text_.data() + text_.size(), value);
      if (error != std::errc{}) fail("no size in the shape");
      at_ += static_cast<std::size_t>(stop - first);
      values.push_back(value);
      if (!accept(',') && peek() != ')') fail("text in the shape");
    }
    return values;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

std::size_t byte_at(std::string_view bytes, std::size_t index) {
  return static_cast<unsigned char>(bytes[index]);
}

}  // namespace

bool looks_like_npy(std::string_view bytes) { return bytes.starts_with(kMagic); }

NpyHeader read_npy_header(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) {
    throw Error(ErrorCode::kEmptyInput,
                fmt::format("{}: found an empty file, expected an array; save it again", name));
  }
  if (!looks_like_npy(bytes.substr(0, kMagic.size()))) {
    throw Error(
        ErrorCode::kBadHeader,
        fmt::format("{}, byte 0: found no \\x93NUMPY, expected a .npy file; save the array with numpy.save",
                    name));
  }
  const auto need = [&](std::size_t size) {
    if (bytes.size() >= size) return;
    throw Error(ErrorCode::kTruncated,
                fmt::format("{}: found {} bytes, expected a header of {}; save the array again", name,
                            bytes.size(), size));
  };
  need(10);
  const std::size_t version = byte_at(bytes, 6);
  if (version < 1 || version > 3) {
    throw Error(ErrorCode::kBadHeader, fmt::format("{}, byte 6: found format version {}, expected 1, 2 or 3; "
                                                   "save the array with a current numpy.save",
                                                   name, version));
  }
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  const std::size_t start = 8 + length_bytes;
  need(start);
  std::size_t length = 0;
  for (std::size_t k = length_bytes; k-- > 0;) length = length << 8 | byte_at(bytes, 8 + k);
  need(start + length);
  NpyHeader header = Reader(bytes.substr(start, length), name).read();
  header.data_offset = start + length;
  return header;
}

std::string make_npy_header(std::string_view type, const std::vector<std::size_t>& shape) {
  std::string sizes;
  for (const std::size_t size : shape) sizes += fmt::format("{}, ", size);
  // (n,) needs its comma, (n, m) takes none.
  sizes.resize(sizes.size() - (shape.size() == 1 ? 1 : 2));
  std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, sizes);
  constexpr std::size_t kPrefix = 10;  // magic, version, 16-bit length
  const std::size_t used = kPrefix + text.size() + 1;
  text.append((kAlignment - used % kAlignment) % kAlignment, ' ');
  text += '\n';
  std::string header(kMagic);
  header += '\x01';
  header += '\x00';
  header += static_cast<char>(text.size() & 0xFF);
  header += static_cast<char>(text.size() >> 8 & 0xFF);
  return header + text;
}

}  // namespace ndhull
