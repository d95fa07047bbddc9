// Numbers as the report's sentences say them; charts write theirs with chart/format_value.hpp.
#pragma once
#include <string>

namespace runstone::bench {

/// Three digits behind the point, for ratios near 1. NaN is "not measured".
std::string ratio_text(double ratio);
/// A whole number in full, with commas: "1,195,306". NaN is "not measured".
std::string count_text(double count);
/// In the unit that fits: "30.2 ns", "438 µs", "38.1 ms", "249 s". NaN is "not measured".
std::string time_text(double ns);

}  // namespace runstone::bench
