// ToolParameter: a number of a tool that the player sets. A window or a script shows and sets all
// parameters in the same way.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace runstone {

struct ToolParameter {
  std::string name;  // one word, lower case
  std::string unit;  // "voxels", or empty
  std::int32_t low = 0, high = 0;
  std::int32_t value = 0;
  /// The names of the values low .. high. Empty if the parameter is a plain number.
  std::vector<std::string> choices;
};

}  // namespace runstone
