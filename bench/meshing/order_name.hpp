#pragma once
#include <string>

#include "common/runs/axis_order.hpp"

namespace runstone::bench {

/// Returns the axes of an order, fastest first: "zyx".
inline std::string name_of(AxisOrder order) {
  std::string out;
  for (const Axis axis : axes_of(order)) out += "xyz"[static_cast<std::size_t>(axis)];
  return out;
}

}  // namespace runstone::bench
