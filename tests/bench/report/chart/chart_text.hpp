// Text in a picture: escaped, measured and cut to a width, without a font at hand.
#pragma once
#include <string>
#include <string_view>

namespace runstone::bench::chart {

// In units of the picture; chart_css() says the same.
constexpr double kTextSize = 12;
constexpr double kTickSize = 11;
constexpr double kStrong = 1.14;  // how much wider bold text is

/// Text for XML, between tags and in attributes alike. Bytes that are no UTF-8, and characters that XML forbids,
/// become U+FFFD.
std::string escaped(std::string_view text);

/// About how wide the text is; rather too much than too little (DejaVu Sans, the widest of the usual fonts).
double width_of(std::string_view text, double size);

/// The text, or as much of its beginning as fits into `width` with an ellipsis.
std::string shortened(std::string_view text, double size, double width);

}  // namespace runstone::bench::chart
