// The form of numbers in the report's sentences. Charts use chart/format_value.hpp.
#pragma once
#include <string>

namespace runstone::bench {

/// Returns three digits behind the point, for ratios near 1. NaN is "not measured".
std::string ratio_text(double ratio);
/// Returns a whole number with commas: "1,195,306". NaN is "not measured".
std::string count_text(double count);
/// Returns a time in the unit that fits: "30.2 ns", "438 µs", "38.1 ms", "249 s". NaN is "not
/// measured".
std::string time_text(double ns);

}  // namespace runstone::bench
