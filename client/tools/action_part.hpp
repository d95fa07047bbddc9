// ActionPart: the place of an edit in an action. The edits of an action are undone and redone as
// one.
#pragma once
#include <cstddef>
#include <cstdint>

namespace runstone {

enum class ActionPart : std::uint8_t {
  alone,  // the only edit
  first,
  next,  // an edit after the first one
};

/// Returns the part of edit i of an action with `count` edits.
constexpr ActionPart part_of_action(std::size_t i, std::size_t count) {
  if (count == 1) return ActionPart::alone;
  return i == 0 ? ActionPart::first : ActionPart::next;
}

}  // namespace runstone
