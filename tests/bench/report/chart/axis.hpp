// Axis: the title of a scale, and how the scale is divided.
#pragma once
#include <string>

namespace runstone::bench::chart {

struct Axis {
  std::string title = {};  // with the unit: "time per chunk, us"
  bool is_log = false;
};

/// The width for which a chart is laid out. The narrow chart is laid out separately, not scaled
/// down, so that text stays readable on a phone.
enum class Width {
  wide,   // 720 units
  narrow  // 400 units
};

}  // namespace runstone::bench::chart
