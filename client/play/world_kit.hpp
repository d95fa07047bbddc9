// WorldKit: what a player holds in a world: the slots of the hotbar, the chosen one, and the tool.
// The client remembers it for each world. Pure.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "client/input/action.hpp"
#include "common/core/ids.hpp"

namespace runstone {

struct WorldKit {
  std::array<Material, kSlotCount> slots{};
  std::size_t slot = 0;  // the chosen one
  std::string tool;      // its name
  friend bool operator==(const WorldKit&, const WorldKit&) = default;
};

/// Texts of kits are no longer than this.
inline constexpr std::size_t kKitBytesMax = 128;

/// Returns the kit as one line: the tool, the chosen slot, and the material of each slot.
std::string to_text(const WorldKit& kit);
/// Parses the text of to_text(). Returns nullopt if words are missing, left over or out of range.
std::optional<WorldKit> parse_kit(std::string_view text);

}  // namespace runstone
