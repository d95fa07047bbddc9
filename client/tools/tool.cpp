#include "client/tools/tool.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"

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

Result<void, std::string> Tool::set_text(std::string_view name, std::string_view value) {
  const auto it = std::find_if(texts_.begin(), texts_.end(),
                               [&](const ToolText& text) { return text.name == name; });
  if (it == texts_.end())
    return failure("the tool " + std::string(name_) + " has no text " + std::string(name));
  if (value.size() > it->bytes_max)
    return failure(it->name + " has at most " + std::to_string(it->bytes_max) + " bytes");
  if (!is_printable_utf8(value))
    return failure(it->name + " must be in UTF-8 without control characters");
  it->value = value;
  return {};
}

const std::string& Tool::text(std::string_view name) const {
  const auto it = std::find_if(texts_.begin(), texts_.end(),
                               [&](const ToolText& text) { return text.name == name; });
  RUNSTONE_ASSERT(it != texts_.end());
  return it->value;
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
