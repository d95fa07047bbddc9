// The words of directions in states of blocks, such as facing=north.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "common/core/coords.hpp"

namespace runstone {

/// The words in the order of Direction: west is -x, down is -y, north is -z.
inline constexpr std::array<std::string_view, kDirectionCount> kFacingWords = {
    "west", "east", "down", "up", "north", "south"};

/// Returns the word of a direction.
constexpr std::string_view facing_word(Direction d) {
  return kFacingWords[static_cast<std::size_t>(d)];
}

/// Returns the direction that a word names, or nullopt if it names none.
constexpr std::optional<Direction> direction_of_facing(std::string_view word) {
  const auto found = std::find(kFacingWords.begin(), kFacingWords.end(), word);
  if (found == kFacingWords.end()) return std::nullopt;
  return static_cast<Direction>(found - kFacingWords.begin());
}

/// Returns the direction to the right of somebody who looks along a horizontal one: east of north.
/// Up and down stay.
constexpr Direction right_of(Direction d) {
  switch (d) {
    case Direction::neg_z:
      return Direction::pos_x;
    case Direction::pos_x:
      return Direction::pos_z;
    case Direction::pos_z:
      return Direction::neg_x;
    case Direction::neg_x:
      return Direction::neg_z;
    default:
      return d;
  }
}

}  // namespace runstone
