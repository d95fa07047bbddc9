#include "server/textures/named_pictures.hpp"

#include <algorithm>
#include <utility>

#include "common/formats/facing_words.hpp"
#include "common/shapes/shape_states.hpp"

namespace runstone {
namespace {

/// The order in which the sides of a material that looks north, with its top up, are turned.
SidePictures looking(const SidePictures& north, Direction facing) {
  SidePictures out = north;
  if (facing == Direction::pos_y || facing == Direction::neg_y) {
    // The front looks up or down, and the top towards the south or north.
    const bool is_up = facing == Direction::pos_y;
    out[facing] = north[Direction::neg_z];
    out[opposite(facing)] = north[Direction::pos_z];
    out[is_up ? Direction::pos_z : Direction::neg_z] = north[Direction::pos_y];
    out[is_up ? Direction::neg_z : Direction::pos_z] = north[Direction::neg_y];
    return out;
  }
  Direction from = Direction::neg_z, to = facing;
  for (int quarter = 0; quarter < 4; ++quarter) {
    out[to] = north[from];
    from = right_of(from);
    to = right_of(to);
  }
  return out;
}

/// Turns a material whose ends are up and down, so that they lie along an axis.
SidePictures along(const SidePictures& upright, std::string_view axis) {
  SidePictures out = upright;
  if (axis == "x") {
    std::swap(out[Direction::pos_x], out[Direction::pos_y]);
    std::swap(out[Direction::neg_x], out[Direction::neg_y]);
  } else if (axis == "z") {
    std::swap(out[Direction::pos_z], out[Direction::pos_y]);
    std::swap(out[Direction::neg_z], out[Direction::neg_y]);
  }
  return out;
}

}  // namespace

SidePicture NamedPictures::first_of(const std::string& stem,
                                    std::initializer_list<const char*> parts) const {
  for (const std::string part : parts) {
    const auto found = files_.find(part.empty() ? stem : stem + "_" + part);
    if (found != files_.end()) return {{found->second}, false};
  }
  return {};
}

SidePictures NamedPictures::upright(const std::string& stem) const {
  SidePictures out;
  out[Direction::pos_y] = first_of(stem, {"top", ""});
  out[Direction::neg_y] = first_of(stem, {"bottom", "top", ""});
  out[Direction::neg_z] = first_of(stem, {"front", "side", ""});
  out[Direction::pos_z] = first_of(stem, {"back", "side", ""});
  // Left and right are those of somebody who looks at the front.
  out[Direction::pos_x] = first_of(stem, {"left", "side", ""});
  out[Direction::neg_x] = first_of(stem, {"right", "side", ""});
  return out;
}

SidePictures NamedPictures::pictures_of(const MaterialInfo& material) {
  const std::string_view name = material.name;
  std::string base(name.substr(0, name.find('[')));
  std::ranges::replace(base, ' ', '_');
  std::ranges::replace(base, '/', '_');
  std::string whole = base;
  std::ranges::replace(whole, ':', '_');
  SidePictures out = upright(whole);
  if (out.empty() && base.find(':') != std::string::npos)
    out = upright(base.substr(base.find(':') + 1));
  const ShapeStates states(states_in_name(name));
  if (const auto facing = direction_of_facing(states.get("facing"))) return looking(out, *facing);
  return along(out, states.get("axis"));
}

}  // namespace runstone
