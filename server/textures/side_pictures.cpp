#include "server/textures/side_pictures.hpp"

namespace runstone {

std::optional<Direction> direction_of_facing(std::string_view facing) {
  if (facing == "north") return Direction::neg_z;
  if (facing == "east") return Direction::pos_x;
  if (facing == "south") return Direction::pos_z;
  if (facing == "west") return Direction::neg_x;
  if (facing == "up") return Direction::pos_y;
  if (facing == "down") return Direction::neg_y;
  return std::nullopt;
}

Direction right_of(Direction d) {
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
