#include "client/tools/tool.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"
#include "common/patterns/pattern_parser.hpp"

namespace runstone {
namespace {

/// Sets the chips of a text, or its error.
template <class T>
void take_parsed(const Result<T, PatternError>& parsed, ToolText& text) {
  if (parsed) {
    text.chips = chips_of(*parsed);
  } else {
    text.error = parsed.error().message();
  }
}

}  // namespace

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

Result<void, std::string> Tool::set_text(std::string_view name, std::string text) {
  const auto it =
      std::find_if(texts_.begin(), texts_.end(), [&](const ToolText& t) { return t.name == name; });
  if (it == texts_.end())
    return failure("the tool " + std::string(name_) + " has no text " + std::string(name));
  if (text.size() > kToolTextBytesMax)
    return failure(it->name + " has at most " + std::to_string(kToolTextBytesMax) + " bytes");
  if (!is_printable_utf8(text))
    return failure(it->name + " must be in UTF-8 without control characters");
  it->text = std::move(text);
  it->error.clear();
  it->chips.clear();
  if (it->text.empty()) return {};
  switch (it->kind) {
    case ToolText::Kind::plain:
      break;
    case ToolText::Kind::pattern:
      take_parsed(parse_pattern(it->text), *it);
      break;
    case ToolText::Kind::mix:
      take_parsed(parse_mix(it->text), *it);
      break;
    case ToolText::Kind::filter:
      take_parsed(parse_filter(it->text), *it);
      break;
  }
  return {};
}

const ToolText& Tool::text(std::string_view name) const {
  const auto it =
      std::find_if(texts_.begin(), texts_.end(), [&](const ToolText& t) { return t.name == name; });
  RUNSTONE_ASSERT(it != texts_.end());
  return *it;
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
