#include "tools/view/view_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/view/view_drawing.h"

namespace ndhull {
namespace {

// [px]
constexpr double kWidth = 960.0;
constexpr double kHeight = 640.0;
constexpr double kLegendLeft = 722.0;
constexpr double kLegendWidth = 232.0;
constexpr PageArea kDrawing{22.0, 66.0, 690.0, 566.0};

constexpr const char* kStyle = R"(<style>
text { font-family: "DejaVu Sans", "Helvetica Neue", Arial, sans-serif; fill: #333 }
.title { font-size: 20px; font-weight: 600; fill: #111 }
.fact { font-size: 13px; fill: #555 }
.legend { font-size: 12px }
.axis { font-size: 14px; font-weight: 600 }
.tick { font-size: 11px; fill: #666 }
.grid { stroke: #e3e0da; stroke-width: 1 }
.face { stroke: #0b2f55; stroke-opacity: .45; stroke-width: .6; stroke-linejoin: round }
.glass { fill: #8a8f98; fill-opacity: .10; stroke: #5d636e; stroke-opacity: .5; stroke-width: .8; stroke-linejoin: round }
.behind { fill: #8a8f98; fill-opacity: .05; stroke: #5d636e; stroke-opacity: .25; stroke-width: .6; stroke-linejoin: round }
.region { fill: #f4f1ea }
.side { stroke-width: 4; stroke-linecap: round }
.mark { fill: none; stroke: MARK; stroke-width: 2; stroke-linejoin: round; stroke-linecap: round }
.outline { stroke-width: 1.2; stroke-opacity: .8 }
.number { font-size: 12px; font-weight: 700; fill: MARK; stroke: #fff; stroke-width: 3; paint-order: stroke; text-anchor: middle }
</style>
)";

std::string style() {
  std::string text = kStyle;
  const std::string word = "MARK";
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word)) {
    text.replace(at, word.size(), kMarkColour);
  }
  return text;
}

/// Characters, not bytes: those of UTF-8 that only continue one are not counted.
std::size_t letters_in(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char letter) { return (letter & 0xC0) != 0x80; }));
}

/// The words of `text` in lines of at most `columns` letters.
std::vector<std::string> wrapped(const std::string& text, std::size_t columns) {
  std::vector<std::string> lines(1);
  std::size_t start = 0;
  while (start < text.size()) {
    std::size_t end = text.find(' ', start);
    if (end == std::string::npos) end = text.size();
    const std::string word = text.substr(start, end - start);
    if (!lines.back().empty() && letters_in(lines.back()) + 1 + letters_in(word) > columns)
      lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    start = end + 1;
  }
  return lines;
}

class Legend {
 public:
  Legend(const Scene& scene, double left, double top) : scene_(scene), left_(left), y_(top) {}

  std::string text() {
    draw_scale();
    const bool both = scene_.inner.has_value() && scene_.outer.has_value();
    const std::string& solid = scene_.inner.has_value() ? scene_.inner_text : scene_.outer_text;
    draw_entry(fmt::format("class=\"face\" fill=\"{}\"", hex(ColourScale::colour_at(0.4))), solid);
    if (both) draw_entry("class=\"glass\"", scene_.outer_text);
    if (!scene_.mark_text.empty()) draw_entry("class=\"mark\"", scene_.mark_text);
    y_ += 10.0;
    for (const SceneAxis& axis : scene_.axes) {
      if (axis.remark.empty()) continue;
      draw_lines(axis.name + " " + axis.remark, left_, 34);
    }
    if (!scene_.stretch_text.empty()) draw_lines(scene_.stretch_text, left_, 34);
    return text_;
  }
  double bottom() const { return y_; }

 private:
  static constexpr double kBarHeight = 180.0;

  void draw_scale() {
    draw_lines(scene_.scale.title(), left_, 34);
    const double top = y_ - 4.0;
    text_ += "<defs><linearGradient id=\"widths\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">\n";
    for (int stop = 0; stop <= 8; ++stop) {
      const Colour colour = ColourScale::colour_at(scene_.scale.is_constant() ? 0.5 : stop / 8.0);
      text_ += fmt::format("<stop offset=\"{}\" stop-color=\"{}\"/>\n", stop / 8.0, hex(colour));
    }
    text_ += fmt::format(
        "</linearGradient></defs>\n<rect x=\"{}\" y=\"{}\" width=\"16\" height=\"{}\" fill=\"url(#widths)\" "
        "stroke=\"#999\" stroke-width=\".5\"/>\n",
        left_, top, kBarHeight);
    for (const Tick& tick : scene_.scale.ticks()) {
      const double at = top + kBarHeight * (1.0 - scene_.scale.place_of(tick.value));
      text_ += fmt::format(
          "<line x1=\"{0}\" y1=\"{1:.1f}\" x2=\"{2}\" y2=\"{1:.1f}\" stroke=\"#666\"/><text class=\"legend\" "
          "x=\"{3}\" y=\"{4:.1f}\">{5}</text>\n",
          left_ + 16.0, at, left_ + 21.0, left_ + 26.0, at + 4.0, tick.label);
    }
    y_ = top + kBarHeight + 30.0;
  }

  void draw_entry(const std::string& look, const std::string& text) {
    text_ +=
        fmt::format("<rect {} x=\"{}\" y=\"{:.1f}\" width=\"16\" height=\"12\"/>\n", look, left_, y_ - 10.0);
    draw_lines(text, left_ + 26.0, 29);
    y_ += 5.0;
  }

  void draw_lines(const std::string& text, double x, std::size_t columns) {
    for (const std::string& line : wrapped(text, columns)) {
      text_ += fmt::format("<text class=\"legend\" x=\"{}\" y=\"{:.1f}\">{}</text>\n", x, y_, escaped(line));
      y_ += 16.0;
    }
  }

  const Scene& scene_;
  double left_, y_;
  std::string text_;
};

}  // namespace

std::string escaped(const std::string& text) {
  // The JSON library replaces what is no UTF-8.
  using Value = nlohmann::json;
  const auto sound =
      Value::parse(Value(text).dump(-1, ' ', false, Value::error_handler_t::replace)).get<std::string>();
  std::string result;
  for (const char letter : sound) {
    switch (letter) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      default: result += static_cast<unsigned char>(letter) < 0x20 ? ' ' : letter;
    }
  }
  return result;
}

std::string scene_legend_svg(const Scene& scene) {
  Legend legend(scene, 2.0, 16.0);
  const std::string text = legend.text();
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\">\n{2}{3}</svg>\n",
      kLegendWidth, legend.bottom(), style(), text);
}

std::string scene_svg(const Scene& scene) {
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">\n"
      "<title>{2}</title>\n",
      kWidth, kHeight, escaped(scene.title));
  text += style();
  text += fmt::format(
      "<rect width=\"{}\" height=\"{}\" fill=\"#fff\"/>\n<text class=\"title\" x=\"24\" y=\"34\">{}</text>\n",
      kWidth, kHeight, escaped(scene.title));
  double y = 56.0;
  for (const std::string& fact : scene.facts) {
    text += fmt::format("<text class=\"fact\" x=\"24\" y=\"{}\">{}</text>\n", y, escaped(fact));
    y += 18.0;
  }
  text += draw_scene(scene, kDrawing);
  text += Legend(scene, kLegendLeft, 96.0).text();
  return text + "</svg>\n";
}

}  // namespace ndhull
