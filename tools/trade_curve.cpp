#include "tools/trade_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "approx/work_end.h"
#include "core/error.h"
#include "tools/io/output_file.h"
#include "tools/view/point_extent.h"
#include "tools/view/view_scale.h"

namespace ndhull {
namespace {

constexpr double kFirstShare = 0.01, kLastShare = 0.64;  // of the largest extent
constexpr double kStep = 1.4142135623730951;

/// A logarithmic axis over the pixels from .. to.
class LogAxis {
 public:
  LogAxis(double low, double high, double from, double to)
      : low_(std::log10(low)), high_(std::log10(high)), from_(from), to_(to) {}
  double place_of(double value) const {
    return from_ + (to_ - from_) * (std::log10(value) - low_) / (high_ - low_);
  }
  /// 1, 2 and 5 times powers of ten; over more than three decades the powers alone; where fewer than two of
  /// them are on the axis, multiples of a finer step.
  std::vector<Tick> ticks() const {
    std::vector<Tick> ticks;
    for (double power = std::floor(low_); power <= high_; ++power) {
      for (const double digit : {1.0, 2.0, 5.0}) {
        if (digit > 1.0 && high_ - low_ > 3.0) continue;
        const double value = digit * std::pow(10.0, power), place = std::log10(value);
        if (place >= low_ - 1e-9 && place <= high_ + 1e-9) ticks.push_back({value, three_digits(value)});
      }
    }
    constexpr std::size_t kFineTicks = 6;  // then two are on any axis
    return ticks.size() >= 2 ? ticks : round_ticks(std::pow(10.0, low_), std::pow(10.0, high_), kFineTicks);
  }

 private:
  double low_, high_, from_, to_;
};

constexpr double kPictureWidth = 720, kPictureHeight = 460, kLeft = 84, kRight = 24, kTop = 56, kBottom = 64;

/// Points that a logarithmic axis can show: an exact hull's width is rounding.
std::vector<TradePoint> visible(const std::vector<TradePoint>& curve) {
  double widest = 0.0;
  for (const TradePoint& point : curve) widest = std::max(widest, point.width);
  std::vector<TradePoint> shown;
  std::copy_if(curve.begin(), curve.end(), std::back_inserter(shown),
               [&](const TradePoint& point) { return point.width > 1e-6 * widest; });
  return shown;
}

void write_axes(OutputFile& file, const LogAxis& across, const LogAxis& up, const std::string& unit) {
  const double right = kPictureWidth - kRight, bottom = kPictureHeight - kBottom;
  for (const auto& [value, label] : across.ticks()) {
    const double x = across.place_of(value);
    file.print("<path class=\"grid\" d=\"M{0:.1f} {1}V{2}\"/>\n", x, kTop, bottom);
    file.print("<text class=\"tick\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", x,
               bottom + 18, label);
  }
  for (const auto& [value, label] : up.ticks()) {
    if (value != std::round(value)) continue;  // there is no half facet
    const double y = up.place_of(value);
    file.print("<path class=\"grid\" d=\"M{} {:.1f}H{}\"/>\n", kLeft, y, right);
    file.print("<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:.0f}</text>\n", kLeft - 8,
               y + 4, value);
  }
  file.print(
      "<text class=\"axis\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">facet width [{}], certified</text>\n",
      0.5 * (kLeft + right), kPictureHeight - 20, unit);
  file.print(
      "<text class=\"axis\" transform=\"translate(22 {}) rotate(-90)\" "
      "text-anchor=\"middle\">facets</text>\n",
      0.5 * (kTop + bottom));
}

void write_picture(const std::string& path, const std::vector<TradePoint>& curve, const std::string& unit) {
  const std::vector<TradePoint> shown = visible(curve);
  OutputFile file(path);
  file.print(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n"
      "<style>text {{ font-family: sans-serif; font-size: 12px; fill: #333 }} .title {{ font-size: 18px }}\n"
      ".axis {{ font-size: 14px }} .grid {{ stroke: #e3e0da; fill: none }}\n"
      ".curve {{ stroke: #0b2f55; stroke-width: 2; fill: none }} circle {{ fill: #0b2f55 }}</style>\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n"
      "<text class=\"title\" x=\"{2}\" y=\"32\">Facets against facet width</text>\n",
      kPictureWidth, kPictureHeight, kLeft);
  if (!shown.empty()) {
    double narrow = HUGE_VAL, wide = 0.0, few = HUGE_VAL, many = 0.0;
    for (const TradePoint& point : shown) {
      narrow = std::min(narrow, point.width), wide = std::max(wide, point.width);
      few = std::min(few, static_cast<double>(point.facets));
      many = std::max(many, static_cast<double>(point.facets));
    }
    const LogAxis across(narrow / 1.2, wide * 1.2, kLeft, kPictureWidth - kRight);
    const LogAxis up(few / 1.4, many * 1.4, kPictureHeight - kBottom, kTop);
    write_axes(file, across, up, unit);
    file.write("<path class=\"curve\" d=\"");
    for (std::size_t i = 0; i < shown.size(); ++i)
      file.print("{}{:.1f} {:.1f}", i == 0 ? 'M' : 'L', across.place_of(shown[i].width),
                 up.place_of(static_cast<double>(shown[i].facets)));
    file.write("\"/>\n");
    for (const TradePoint& point : shown)
      file.print(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"><title>{} facets, width {}, {:.2f} "
          "s</title></circle>\n",
          across.place_of(point.width), up.place_of(static_cast<double>(point.facets)), point.facets,
          three_digits(point.width), point.seconds);
  }
  file.write("</svg>\n");
  file.commit();
}

}  // namespace

std::vector<TradePoint> trade_curve(const PointView& points, const HullOptions& options, const Hull& first,
                                    double seconds) {
  std::vector<TradePoint> curve{{first.facet_count(), first.max_facet_width, seconds}};
  const double extent = options.unit_cube ? 1.0 : largest_extent(points);
  const WorkEnd end(options.limits.max_seconds, options.stop);
  double width = std::max(kStep * first.max_facet_width, kFirstShare * extent);
  for (; width <= kLastShare * extent && curve.back().facets > first.rank + 1; width *= kStep) {
    HullOptions coarser = options;
    coarser.accuracy = Accuracy{};
    coarser.accuracy.width = {width, false};
    coarser.accuracy.effort = options.accuracy.effort;
    coarser.triangulate = false;
    coarser.limits.max_seconds = end.seconds_left();
    const Hull hull = convex_hull(points, coarser);
    if (hull.status != HullStatus::kComplete) break;
    const auto& spent = hull.statistics.seconds;
    double total = 0.0;
    for (const double part : spent) total += part;
    if (hull.facet_count() >= curve.back().facets) continue;
    // What a wider target gives can be narrower: then it takes the place of those before.
    while (curve.size() > 1 && curve.back().width >= hull.max_facet_width) curve.pop_back();
    curve.push_back({hull.facet_count(), hull.max_facet_width, total});
  }
  return curve;
}

CurvePaths curve_paths(const std::string& path) {
  if (path == "-") {
    throw Error(ErrorCode::kUsage,
                "--curve: found -, expected the name of a file; the picture is written beside it");
  }
  const std::filesystem::path name(path);
  const std::string extension = name.extension().string();
  const std::string stem =
      extension == ".csv" || extension == ".svg" ? (name.parent_path() / name.stem()).string() : path;
  return {stem + ".csv", stem + ".svg"};
}

void write_trade_curve(const CurvePaths& paths, const std::vector<TradePoint>& curve,
                       const std::string& unit) {
  OutputFile table(paths.table);
  table.write("facets,width,seconds\n");
  for (const TradePoint& point : curve)
    table.print("{},{:.17g},{:.6g}\n", point.facets, point.width, point.seconds);
  table.commit();
  write_picture(paths.picture, curve, unit);
}

}  // namespace ndhull
