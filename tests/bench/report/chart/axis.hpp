// Axis: what is written beside a scale, and how the scale is divided.
#pragma once
#include <string>

namespace runstone::bench::chart {

struct Axis {
  std::string title = {};  // with the unit: "time per chunk, us"
  bool is_log = false;
};

/// What a picture is laid out for. A narrow one is a picture of its own, not the wide one made small, so that text
/// stays readable on a phone.
enum class Width {
  wide,   // 720 units
  narrow  // 400 units
};

}  // namespace runstone::bench::chart
