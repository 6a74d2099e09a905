#include "tools/command_line/progress_line.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "tools/command_line/byte_count.h"

namespace ndhull {
namespace {

constexpr std::chrono::milliseconds kInterval{200};
constexpr std::size_t kUsualColumns = 80;

std::size_t terminal_columns() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kUsualColumns;
  return size.ws_col;
}

}  // namespace

ProgressRates rates_between(const Progress& before, const Progress& now) {
  ProgressRates rates;
  const double seconds = now.elapsed_seconds - before.elapsed_seconds;
  if (before.phase != now.phase || seconds <= 0.0) return rates;
  if (now.simplices > before.simplices)
    rates.simplices_per_second = static_cast<double>(now.simplices - before.simplices) / seconds;
  if (before.points_left > now.points_left)
    rates.seconds_left = static_cast<double>(now.points_left) * seconds /
                         static_cast<double>(before.points_left - now.points_left);
  return rates;
}

std::string describe(const Progress& progress, const ProgressRates& rates) {
  std::string text = fmt::format("{}: {} points left, {} simplices", to_string(progress.phase),
                                 progress.points_left, progress.simplices);
  if (rates.simplices_per_second > 0.0) text += fmt::format(" (+{:.2g}/s)", rates.simplices_per_second);
  text += fmt::format(", furthest {:.1e}, {:.1f} s", progress.furthest_gauge, progress.elapsed_seconds);
  if (rates.seconds_left > 0.0) text += fmt::format(" (about {:.2g} s left)", rates.seconds_left);
  return text + ", " + format_byte_count(progress.memory_bytes);
}

ProgressLine::ProgressLine(bool is_forced, bool is_quiet) : is_terminal_(::isatty(STDERR_FILENO) == 1) {
  is_shown_ = !is_quiet && (is_forced || is_terminal_);
}

bool ProgressLine::is_due(std::string_view phase) {
  if (!is_shown_) return false;
  const Clock::time_point now = Clock::now();
  if (phase == last_phase_ && now - last_shown_ < kInterval) return false;
  last_shown_ = now;
  last_phase_ = phase;
  return true;
}

void ProgressLine::show(const Progress& progress) {
  if (!is_due(to_string(progress.phase))) return;
  print(describe(progress, rates_between(before_, progress)));
  before_ = progress;
}

void ProgressLine::show_phase(std::string_view phase) {
  if (!is_due(phase)) return;
  const std::chrono::duration<double> elapsed = Clock::now() - start_;
  print(fmt::format("{}: {:.1f} s", phase, elapsed.count()));
}

void ProgressLine::print(std::string text) {
  if (!is_terminal_) {
    fmt::print(stderr, "{}\n", text);
    return;
  }
  // A line that wraps would not be rewritten but scroll.
  const std::size_t columns = terminal_columns();
  if (text.size() >= columns) text.resize(columns - 1);
  fmt::print(stderr, "\r{}\x1b[K", text);
  line_is_open_ = true;
}

void ProgressLine::clear() {
  if (!line_is_open_) return;
  fmt::print(stderr, "\r\x1b[K");
  line_is_open_ = false;
}

}  // namespace ndhull
