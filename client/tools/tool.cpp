#include "client/tools/tool.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {

Result<void, std::string> Tool::set(std::string_view parameter, std::int32_t value) {
  const auto it = std::find_if(parameters_.begin(), parameters_.end(),
                               [&](const ToolParameter& p) { return p.name == parameter; });
  if (it == parameters_.end()) {
    return failure("the tool " + std::string(name_) + " has no parameter " +
                   std::string(parameter));
  }
  if (value < it->low || value > it->high) {
    return failure(it->name + " must be from " + std::to_string(it->low) + " to " +
                   std::to_string(it->high));
  }
  it->value = value;
  return {};
}

std::int32_t Tool::value(std::string_view parameter) const {
  const auto it = std::find_if(parameters_.begin(), parameters_.end(),
                               [&](const ToolParameter& p) { return p.name == parameter; });
  RUNSTONE_ASSERT(it != parameters_.end());
  return it->value;
}

ToolParameter Tool::mask_parameter() {
  return {"mask", "", 0, 2, 0, {"everything", "empty", "solid"}};
}

Mask Tool::mask() const {
  switch (value("mask")) {
    case 1:
      return {MaskKind::only_empty, kEmpty};
    case 2:
      return {MaskKind::only_solid, kEmpty};
    default:
      return {};
  }
}

}  // namespace runstone
