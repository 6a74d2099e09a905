// Charts as SVG, drawn by gnuplot.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace ndhull {

/// One line of a chart: points in the order they are joined.
struct Series {
  std::string name;                               ///< in the legend
  std::vector<std::pair<double, double>> points;  ///< on a logarithmic axis all positive
  bool is_dashed = false;
  std::size_t colour = 0;  ///< equal numbers are equal colours in all charts
};

struct Chart {
  std::string title, x_label, y_label;  ///< labels with their units in brackets
  std::vector<Series> series;
  bool log_x = false, log_y = false;
  bool whole_x = false;  ///< ticks at whole numbers
};

/// Do the y of the points, all positive, differ by more than a factor of 10? Then a logarithmic axis shows
/// more; a linear one begins at 0.
bool spans_a_decade(const Chart& chart);

/// Bars of parts that make 100 %, one for each category.
struct BarChart {
  std::string title, x_label, y_label;
  std::vector<std::string> parts, categories;
  std::vector<std::vector<double>> values;  ///< categories x parts
};

/// A whole <svg> element without a prologue; ids in it start with `name`, so that several fit on one page.
/// Throws Error kUsage when gnuplot is not installed or fails; the message says which package has it.
/// Precondition: a series with a point; at least one bar.
std::string draw_svg(const Chart& chart, const std::string& name);
std::string draw_svg(const BarChart& chart, const std::string& name);

}  // namespace ndhull
