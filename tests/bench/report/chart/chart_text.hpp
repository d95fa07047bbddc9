// Text in a chart: escaped, measured and cut to a width, without a font.
#pragma once
#include <string>
#include <string_view>

namespace runstone::bench::chart {

// The size of text in units of the chart. chart_css() has the same size.
constexpr double kTextSize = 12;
constexpr double kTickSize = 11;
constexpr double kStrong = 1.14;  // how much wider bold text is

/// Returns text for XML, valid between tags and in attributes. Bytes that are no UTF-8, and
/// characters that XML forbids, become U+FFFD.
std::string escaped(std::string_view text);

/// Returns an estimate of the text's width, from above (DejaVu Sans, the widest of the usual
/// fonts).
double width_of(std::string_view text, double size);

/// Returns the text, or as much of its beginning as fits into `width` with an ellipsis.
std::string shortened(std::string_view text, double size, double width);

}  // namespace runstone::bench::chart
