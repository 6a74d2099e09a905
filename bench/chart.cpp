#include "bench/chart.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>

#include "core/error.h"

namespace ndhull {
namespace {

/// A script of gnuplot in a file that goes with this object.
class Script {
 public:
  explicit Script(const std::string& text) {
    std::string name = (std::filesystem::temp_directory_path() / "ndhull-chart-XXXXXX").string();
    const int descriptor = mkstemp(name.data());
    if (descriptor < 0) throw Error(ErrorCode::kFileWrite, name + ": cannot be written");
    close(descriptor);
    path_ = name;
    if (!(std::ofstream(path_) << text)) throw Error(ErrorCode::kFileWrite, name + ": cannot be written");
  }
  Script(const Script&) = delete;
  Script& operator=(const Script&) = delete;
  ~Script() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// The marks that gnuplot defines in each picture get the picture's name, so that a page has each id once.
std::string with_own_ids(std::string svg, const std::string& name) {
  for (const char* before : {"id='", "id=\"", "href='#", "filter='url(#", "filter=\"url(#"}) {
    for (const char* mark : {"gpPt", "gpDot", "textbox", "greybox", "gnuplot_canvas"}) {
      const std::string found = std::string(before) + mark;
      for (std::size_t place = 0; (place = svg.find(found, place)) != std::string::npos;) {
        svg.insert(place + std::string_view(before).size(), name + "_");
        place += found.size() + name.size() + 1;
      }
    }
  }
  return svg;
}

std::string run_gnuplot(const std::string& text) {
  const Script script(text);
  std::FILE* pipe = popen(("gnuplot '" + script.path().string() + "'").c_str(), "r");
  if (pipe == nullptr) throw Error(ErrorCode::kUsage, "gnuplot cannot be started");
  std::string output;
  std::array<char, 4096> block;
  for (std::size_t count = 0; (count = fread(block.data(), 1, block.size(), pipe)) > 0;) {
    output.append(block.data(), count);
  }
  const int status = pclose(pipe);
  constexpr int kNotFound = 127;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotFound) {
    throw Error(
        ErrorCode::kUsage,
        "gnuplot, which draws the charts, is not installed: apt-get install gnuplot-nox, or --markdown");
  }
  const std::size_t begin = output.find("<svg"), end = output.rfind("</svg>");
  if (status != 0 || begin == std::string::npos || end == std::string::npos) {
    throw Error(ErrorCode::kUsage, fmt::format("gnuplot ended with status {} and no picture", status));
  }
  return output.substr(begin, end + 6 - begin) + "\n";
}

// In gnuplot's double quotes only the backslash and the quote mean something.
std::string gnuplot_string(const std::string& text) {
  std::string result = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') result += '\\';
    result += letter == '\n' ? ' ' : letter;
  }
  return result + "\"";
}

// Distinct for colour-blind eyes: Okabe, Ito. Color Universal Design, 2008.
constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                              "#e69f00", "#56b4e9", "#000000", "#999999"};

std::string preamble(const std::string& name, const std::string& title, const std::string& x_label,
                     const std::string& y_label) {
  return fmt::format(
      "set terminal svg noenhanced name {} size 760,400 dynamic font 'sans-serif,13' background rgb 'white'\n"
      "set title {}\nset xlabel {}\nset ylabel {}\nset grid lc rgb '#dddddd' lt 1\nset border lc rgb "
      "'#666666'\n"
      "set key outside right top vertical Left reverse samplen 2\nset format y '%g'\n",
      gnuplot_string(name), gnuplot_string(title), gnuplot_string(x_label), gnuplot_string(y_label));
}

std::pair<double, double> x_range(const Chart& chart) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Series& series : chart.series) {
    for (const auto& [x, y] : series.points) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }
  return {low, high};
}

}  // namespace

bool spans_a_decade(const Chart& chart) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const Series& series : chart.series) {
    for (const auto& [x, y] : series.points) {
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  return high > 10.0 * low;
}

std::string draw_svg(const Chart& chart, const std::string& name) {
  std::string script = preamble(name, chart.title, chart.x_label, chart.y_label);
  if (chart.log_x) script += "set logscale x\n";
  script += chart.log_y ? "set logscale y\n" : "set yrange [0:*]\n";
  if (chart.whole_x) {
    const auto [low, high] = x_range(chart);
    script += fmt::format("set xtics 1\nset xrange [{}:{}]\n", low - 0.3, high + 0.3);
  }
  std::string plot;
  std::size_t number = 0;
  for (const Series& series : chart.series) {
    if (series.points.empty()) continue;
    script += fmt::format("$series{} << END\n", number);
    for (const auto& [x, y] : series.points) script += fmt::format("{} {}\n", x, y);
    script += "END\n";
    plot += fmt::format("{} $series{} using 1:2 with linespoints lw 2 pt 7 ps 0.6 dt {} lc rgb '{}' title {}",
                        plot.empty() ? "plot" : ",", number, series.is_dashed ? 2 : 1,
                        kColours[series.colour % kColours.size()], gnuplot_string(series.name));
    ++number;
  }
  return with_own_ids(run_gnuplot(script + plot + "\n"), name);
}

std::string draw_svg(const BarChart& chart, const std::string& name) {
  std::string script = preamble(name, chart.title, chart.x_label, chart.y_label);
  script +=
      "set style data histograms\nset style histogram rowstacked\nset style fill solid 1 border -1\n"
      "set boxwidth 0.7\nset yrange [0:100]\n$bars << END\n";
  for (std::size_t category = 0; category < chart.categories.size(); ++category) {
    script += gnuplot_string(chart.categories[category]);
    for (const double value : chart.values[category]) script += fmt::format(" {}", value);
    script += "\n";
  }
  script += "END\n";
  std::string plot;
  for (std::size_t part = 0; part < chart.parts.size(); ++part) {
    plot += fmt::format("{} $bars using {}:xtic(1) lc rgb '{}' title {}", part == 0 ? "plot" : ",", part + 2,
                        kColours[part % kColours.size()], gnuplot_string(chart.parts[part]));
  }
  return with_own_ids(run_gnuplot(script + plot + "\n"), name);
}

}  // namespace ndhull
