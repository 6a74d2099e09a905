#include "bench/report_page.h"

#include <fmt/format.h>

#include "bench/chart.h"
#include "bench/table.h"

namespace ndhull {
namespace {

constexpr const char* kStyle =
    "body{font:15px/1.5 sans-serif;max-width:1340px;margin:2em auto;padding:0 1em;color:#222}"
    "h2{border-bottom:1px solid #ccc;margin-top:2em}"
    ".charts{display:flex;flex-wrap:wrap;gap:1em}figure{margin:0;flex:1 1 480px;max-width:660px}"
    "figure svg{width:100%;height:auto}"
    ".wide{overflow-x:auto}table{border-collapse:collapse;font-size:13px}"
    "th,td{padding:2px 8px;border-bottom:1px solid #e4e4e4;text-align:right;white-space:nowrap}"
    ".left{text-align:left}nav a{margin-right:1em}";

}  // namespace

std::string html_report(const std::vector<ReportSection>& sections, const std::set<std::string>& machines) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<title>ndhull benchmarks</title>\n<style>{}</style>\n</head>\n<body>\n<h1>ndhull benchmarks</h1>\n",
      kStyle);
  for (const std::string& machine : machines) html += fmt::format("<p>{}</p>\n", html_escaped(machine));
  html += "<nav>";
  for (std::size_t number = 0; number < sections.size(); ++number) {
    html += fmt::format("<a href=\"#section{}\">{}</a> ", number, html_escaped(sections[number].title));
  }
  html += "</nav>\n";
  std::size_t chart_number = 0;
  for (std::size_t number = 0; number < sections.size(); ++number) {
    const ReportSection& section = sections[number];
    html += fmt::format("<section id=\"section{}\">\n<h2>{}</h2>\n", number, html_escaped(section.title));
    if (!section.text.empty()) html += fmt::format("<p>{}</p>\n", html_escaped(section.text));
    html += "<div class=\"charts\">\n";
    for (const auto& any_chart : section.charts) {
      const std::string name = fmt::format("chart{}", chart_number++);
      html += std::visit(
          [&](const auto& chart) {
            return fmt::format("<figure role=\"img\" aria-label=\"{}\">\n{}</figure>\n",
                               html_escaped(section.title + ": " + chart.title), draw_svg(chart, name));
          },
          any_chart);
    }
    html += "</div>\n";
    for (const Table& table : section.tables) html += "<div class=\"wide\">\n" + table.as_html() + "</div>\n";
    html += "</section>\n";
  }
  return html + "</body>\n</html>\n";
}

std::string markdown_report(const std::vector<ReportSection>& sections,
                            const std::set<std::string>& machines) {
  std::string text = "# ndhull benchmarks\n";
  for (const std::string& machine : machines) text += "\n" + machine + "\n";
  for (const ReportSection& section : sections) {
    if (section.tables.empty()) continue;
    text += fmt::format("\n## {}\n", section.title);
    for (const Table& table : section.tables) text += "\n" + table.as_markdown();
  }
  return text;
}

}  // namespace ndhull
