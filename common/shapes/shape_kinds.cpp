// The boxes of the kinds are dimensions of the blocks of Minecraft, rounded to sixteenths. Kinds
// that have a facing are written for north and turned.
#include "common/shapes/shape_kinds.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "common/shapes/shape_states.hpp"
#include "common/shapes/turned_shape.hpp"

namespace runstone {
namespace {

constexpr std::array<std::string_view, 4> kFacings = {"north", "east", "south", "west"};

bool is_top(const ShapeStates& states) { return states.is("half", "top"); }

/// Adds what lies north to each of the four sides whose state is `value`.
Shape with_arms(Shape shape, const Shape& north, const ShapeStates& states,
                std::string_view value = "true") {
  for (const std::string_view side : kFacings) {
    if (states.is(side, value)) shape = with_boxes(std::move(shape), faced(north, side));
  }
  return shape;
}

/// Returns the quarter turns about y of a standing sign with a rotation of 0 .. 15, modulo two, or
/// nullopt if it lies on a diagonal.
std::optional<unsigned> quarters_of_rotation(const ShapeStates& states) {
  const unsigned eighth = states.number("rotation", 0) % 8;
  if (eighth == 2 || eighth == 6) return std::nullopt;
  return eighth > 2 && eighth < 6 ? 1U : 0U;
}

/// Returns a board that spans x, as a standing sign has it by its rotation. On a diagonal it is a
/// block of the same height.
Shape rotated_board(const ShapeBox& board, const ShapeStates& states) {
  if (const auto quarters = quarters_of_rotation(states))
    return turned_about_y(shape_of_boxes({board}), *quarters);
  return shape_of_boxes({shape_box(4, board.min[1], 4, 12, board.max[1], 12)});
}

Shape slab_kind(const ShapeStates& states) {
  const std::string_view type = states.get("type", states.get("half", "bottom"));
  if (type == "double") return {};
  return type == "top" ? shape_of_boxes({shape_box(0, 8, 0, 16, 16, 16)})
                       : shape_of_boxes({shape_box(0, 0, 0, 16, 8, 16)});
}

Shape stairs_kind(const ShapeStates& states) {
  const std::string_view bend = states.get("shape", "straight");
  Shape out = shape_of_boxes({shape_box(0, 0, 0, 16, 8, 16)});
  if (bend == "outer_left") {
    out.boxes.push_back(shape_box(0, 8, 0, 8, 16, 8));
  } else if (bend == "outer_right") {
    out.boxes.push_back(shape_box(8, 8, 0, 16, 16, 8));
  } else {
    out.boxes.push_back(shape_box(0, 8, 0, 16, 16, 8));
    if (bend == "inner_left") out.boxes.push_back(shape_box(0, 8, 8, 8, 16, 16));
    if (bend == "inner_right") out.boxes.push_back(shape_box(8, 8, 8, 16, 16, 16));
  }
  out = faced(out, states.get("facing"));
  return is_top(states) ? upside_down(out) : out;
}

Shape fence_kind(const ShapeStates& states) {
  return with_arms(shape_of_boxes({shape_box(6, 0, 6, 10, 16, 10)}),
                   shape_of_boxes({shape_box(7, 6, 0, 9, 9, 6), shape_box(7, 12, 0, 9, 15, 6)}),
                   states);
}

Shape pane_kind(const ShapeStates& states) {
  return with_arms(shape_of_boxes({shape_box(7, 0, 7, 9, 16, 9)}),
                   shape_of_boxes({shape_box(7, 0, 0, 9, 16, 7)}), states);
}

Shape wall_kind(const ShapeStates& states) {
  const Shape low = shape_of_boxes({shape_box(5, 0, 0, 11, 14, 8)});
  Shape out;
  if (states.get("up", "true") == "true") out = shape_of_boxes({shape_box(4, 0, 4, 12, 16, 12)});
  out = with_arms(with_arms(out, low, states, "low"), low, states, "true");
  out = with_arms(out, shape_of_boxes({shape_box(5, 0, 0, 11, 16, 8)}), states, "tall");
  return out.is_cube() ? shape_of_boxes({shape_box(5, 0, 5, 11, 14, 11)}) : out;
}

Shape fence_gate_kind(const ShapeStates& states) {
  Shape out = shape_of_boxes({shape_box(0, 5, 7, 2, 16, 9), shape_box(14, 5, 7, 16, 16, 9)});
  if (states.is_true("open")) {
    for (const unsigned x : {0U, 14U}) {
      out.boxes.push_back(shape_box(x, 6, 1, x + 2, 15, 3));
      out.boxes.push_back(shape_box(x, 6, 3, x + 2, 9, 7));
      out.boxes.push_back(shape_box(x, 12, 3, x + 2, 15, 7));
    }
  } else {
    out = with_boxes(out,
                     shape_of_boxes({shape_box(2, 6, 7, 14, 9, 9), shape_box(2, 12, 7, 14, 15, 9),
                                     shape_box(6, 9, 7, 10, 12, 9)}));
  }
  if (states.is_true("in_wall")) {
    for (ShapeBox& box : out.boxes) {
      box.min[1] = static_cast<std::uint8_t>(box.min[1] - 3);
      box.max[1] = static_cast<std::uint8_t>(box.max[1] - 3);
    }
  }
  return faced(out, states.get("facing"));
}

Shape door_kind(const ShapeStates& states) {
  Shape out = shape_of_boxes({shape_box(0, 0, 13, 16, 16, 16)});
  if (states.is_true("open")) {
    out = states.is("hinge", "right") ? shape_of_boxes({shape_box(13, 0, 0, 16, 16, 16)})
                                      : shape_of_boxes({shape_box(0, 0, 0, 3, 16, 16)});
  }
  return faced(out, states.get("facing"));
}

Shape trapdoor_kind(const ShapeStates& states) {
  if (states.is_true("open"))
    return faced(shape_of_boxes({shape_box(0, 0, 13, 16, 16, 16)}), states.get("facing"));
  const Shape closed = shape_of_boxes({shape_box(0, 0, 0, 16, 3, 16)});
  return is_top(states) ? upside_down(closed) : closed;
}

Shape carpet_kind(const ShapeStates&) { return shape_of_boxes({shape_box(0, 0, 0, 16, 1, 16)}); }

Shape plate_kind(const ShapeStates&) { return shape_of_boxes({shape_box(1, 0, 1, 15, 1, 15)}); }

/// Places what lies on the floor, or on a wall that is south, by the states face and facing.
Shape on_face(const Shape& floor, const Shape& wall, const ShapeStates& states) {
  const std::string_view face = states.get("face", "wall"), facing = states.get("facing");
  if (face == "floor") return faced(floor, facing);
  return faced(face == "ceiling" ? upside_down(floor) : wall, facing);
}

Shape button_kind(const ShapeStates& states) {
  const unsigned depth = states.is_true("powered") ? 1 : 2;
  return on_face(shape_of_boxes({shape_box(5, 0, 6, 11, depth, 10)}),
                 shape_of_boxes({shape_box(5, 6, 16 - depth, 11, 10, 16)}), states);
}

Shape lever_kind(const ShapeStates& states) {
  return on_face(shape_of_boxes({shape_box(5, 0, 4, 11, 3, 12), shape_box(7, 3, 7, 9, 11, 9)}),
                 shape_of_boxes({shape_box(5, 4, 13, 11, 12, 16), shape_box(7, 7, 5, 9, 9, 13)}),
                 states);
}

Shape ladder_kind(const ShapeStates& states) {
  Shape out = shape_of_boxes({shape_box(1, 0, 15, 3, 16, 16), shape_box(13, 0, 15, 15, 16, 16)});
  for (const unsigned y : {1U, 5U, 9U, 13U})
    out.boxes.push_back(shape_box(0, y, 15, 16, y + 2, 16));
  return faced(out, states.get("facing"));
}

Shape vine_kind(const ShapeStates& states) {
  Shape out = with_arms({}, shape_of_boxes({shape_box(0, 0, 0, 16, 16, 1)}), states);
  if (states.is_true("up")) out.boxes.push_back(shape_box(0, 15, 0, 16, 16, 16));
  if (states.is_true("down") || out.is_cube()) out.boxes.push_back(shape_box(0, 0, 0, 16, 1, 16));
  return out;
}

Shape torch_kind(const ShapeStates&) { return shape_of_boxes({shape_box(7, 0, 7, 9, 10, 9)}); }

Shape wall_torch_kind(const ShapeStates& states) {
  return faced(shape_of_boxes({shape_box(7, 3, 14, 9, 8, 16), shape_box(7, 6, 12, 9, 13, 14)}),
               states.get("facing"));
}

Shape lantern_kind(const ShapeStates& states) {
  if (states.is_true("hanging")) {
    return shape_of_boxes({shape_box(5, 1, 5, 11, 8, 11), shape_box(6, 8, 6, 10, 10, 10),
                           shape_box(7, 10, 7, 9, 16, 9)});
  }
  return shape_of_boxes({shape_box(5, 0, 5, 11, 7, 11), shape_box(6, 7, 6, 10, 9, 10)});
}

Shape chain_kind(const ShapeStates& states) {
  const std::string_view axis = states.get("axis", "y");
  if (axis == "x") return shape_of_boxes({shape_box(0, 7, 7, 16, 9, 9)});
  if (axis == "z") return shape_of_boxes({shape_box(7, 7, 0, 9, 9, 16)});
  return shape_of_boxes({shape_box(7, 0, 7, 9, 16, 9)});
}

Shape rod_kind(const ShapeStates& states) {
  return upended(shape_of_boxes({shape_box(6, 0, 6, 10, 1, 10), shape_box(7, 1, 7, 9, 16, 9)}),
                 states.get("facing", "up"));
}

Shape snow_kind(const ShapeStates& states) {
  const unsigned layers = std::clamp(states.number("layers", 1), 1U, 8U);
  if (layers == 8) return {};
  return shape_of_boxes({shape_box(0, 0, 0, 16, 2 * layers, 16)});
}

Shape cactus_kind(const ShapeStates&) { return shape_of_boxes({shape_box(1, 0, 1, 15, 16, 15)}); }

Shape bed_kind(const ShapeStates& states) {
  const unsigned z = states.is("part", "head") ? 0 : 13;
  return faced(shape_of_boxes({shape_box(0, 3, 0, 16, 9, 16), shape_box(0, 0, z, 3, 3, z + 3),
                               shape_box(13, 0, z, 16, 3, z + 3)}),
               states.get("facing"));
}

Shape chest_kind(const ShapeStates& states) {
  const std::string_view type = states.get("type");
  return faced(
      shape_of_boxes({shape_box(type == "right" ? 0 : 1, 0, 1, type == "left" ? 16 : 15, 14, 15)}),
      states.get("facing"));
}

Shape anvil_kind(const ShapeStates& states) {
  return faced(shape_of_boxes({shape_box(2, 0, 2, 14, 4, 14), shape_box(4, 4, 3, 12, 5, 13),
                               shape_box(6, 5, 4, 10, 10, 12), shape_box(3, 10, 0, 13, 16, 16)}),
               states.get("facing"));
}

Shape candle_kind(const ShapeStates& states) {
  const unsigned count = states.number("candles", states.number("pickles", 1));
  const Shape one = shape_of_boxes({shape_box(7, 0, 7, 9, 6, 9)});
  if (count <= 1) return one;
  const Shape four =
      shape_of_boxes({shape_box(4, 0, 4, 6, 5, 6), shape_box(10, 0, 4, 12, 5, 6),
                      shape_box(4, 0, 10, 6, 5, 12), shape_box(10, 0, 10, 12, 5, 12)});
  // Two and three would lie askew, and no state says how.
  if (count == 2) return shape_of_boxes({shape_box(6, 0, 6, 10, 6, 10)});
  return count == 3 ? four : with_boxes(four, one);
}

Shape head_kind(const ShapeStates&) { return shape_of_boxes({shape_box(4, 0, 4, 12, 8, 12)}); }

Shape wall_head_kind(const ShapeStates& states) {
  return faced(shape_of_boxes({shape_box(4, 4, 8, 12, 12, 16)}), states.get("facing"));
}

Shape sign_kind(const ShapeStates& states) {
  return with_boxes(shape_of_boxes({shape_box(7, 0, 7, 9, 8, 9)}),
                    rotated_board(shape_box(0, 8, 7, 16, 16, 9), states));
}

Shape wall_sign_kind(const ShapeStates& states) {
  return faced(shape_of_boxes({shape_box(0, 4, 14, 16, 12, 16)}), states.get("facing"));
}

Shape hanging_sign_kind(const ShapeStates& states) {
  return with_boxes(shape_of_boxes({shape_box(7, 10, 7, 9, 16, 9)}),
                    rotated_board(shape_box(1, 0, 7, 15, 10, 9), states));
}

Shape wall_hanging_sign_kind(const ShapeStates& states) {
  return faced(shape_of_boxes({shape_box(0, 14, 6, 16, 16, 10), shape_box(3, 10, 7, 5, 14, 9),
                               shape_box(11, 10, 7, 13, 14, 9), shape_box(1, 0, 7, 15, 10, 9)}),
               states.get("facing"));
}

Shape banner_kind(const ShapeStates& states) {
  return rotated_board(shape_box(1, 0, 7, 15, 16, 9), states);
}

Shape wall_banner_kind(const ShapeStates& states) {
  return faced(shape_of_boxes({shape_box(1, 0, 15, 15, 13, 16)}), states.get("facing"));
}

Shape rail_kind(const ShapeStates& states) {
  const std::string_view shape = states.get("shape", "north_south");
  constexpr std::string_view kRising = "ascending_";
  if (shape.starts_with(kRising)) {
    return faced(shape_of_boxes({shape_box(1, 0, 12, 15, 4, 16), shape_box(1, 4, 8, 15, 8, 12),
                                 shape_box(1, 8, 4, 15, 12, 8), shape_box(1, 12, 0, 15, 16, 4)}),
                 shape.substr(kRising.size()));
  }
  // A bend joins two sides. It is written for north and east.
  constexpr std::array<std::string_view, 4> kBends = {"north_east", "south_east", "south_west",
                                                      "north_west"};
  const auto bend = std::find(kBends.begin(), kBends.end(), shape);
  if (bend != kBends.end()) {
    return turned_about_y(
        shape_of_boxes({shape_box(1, 0, 0, 15, 1, 15), shape_box(15, 0, 1, 16, 1, 15)}),
        static_cast<unsigned>(bend - kBends.begin()));
  }
  Shape out = shape_of_boxes({shape_box(2, 0, 0, 4, 2, 16), shape_box(12, 0, 0, 14, 2, 16)});
  for (const unsigned z : {1U, 5U, 9U, 13U}) out.boxes.push_back(shape_box(0, 0, z, 16, 1, z + 2));
  return turned_about_y(out, shape == "east_west" ? 1 : 0);
}

Shape path_kind(const ShapeStates&) { return shape_of_boxes({shape_box(0, 0, 0, 16, 15, 16)}); }

Shape plant_kind(const ShapeStates&) { return plant_shape(13); }

Shape flower_kind(const ShapeStates&) { return plant_shape(10, 3); }

struct ShapeKind {
  std::string_view name;
  Shape (*make)(const ShapeStates&);
};

constexpr ShapeKind kKinds[] = {
    {"anvil", anvil_kind},
    {"banner", banner_kind},
    {"bed", bed_kind},
    {"button", button_kind},
    {"cactus", cactus_kind},
    {"candle", candle_kind},
    {"carpet", carpet_kind},
    {"chain", chain_kind},
    {"chest", chest_kind},
    {"door", door_kind},
    {"fence", fence_kind},
    {"fence_gate", fence_gate_kind},
    {"flower", flower_kind},
    {"hanging_sign", hanging_sign_kind},
    {"head", head_kind},
    {"ladder", ladder_kind},
    {"lantern", lantern_kind},
    {"lever", lever_kind},
    {"pane", pane_kind},
    {"path", path_kind},
    {"plant", plant_kind},
    {"pressure_plate", plate_kind},
    {"rail", rail_kind},
    {"rod", rod_kind},
    {"sign", sign_kind},
    {"slab", slab_kind},
    {"snow", snow_kind},
    {"stairs", stairs_kind},
    {"torch", torch_kind},
    {"trapdoor", trapdoor_kind},
    {"vine", vine_kind},
    {"wall", wall_kind},
    {"wall_banner", wall_banner_kind},
    {"wall_hanging_sign", wall_hanging_sign_kind},
    {"wall_head", wall_head_kind},
    {"wall_sign", wall_sign_kind},
    {"wall_torch", wall_torch_kind},
};

}  // namespace

std::span<const std::string_view> shape_kinds() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> out;
    for (const ShapeKind& kind : kKinds) out.push_back(kind.name);
    return out;
  }();
  return names;
}

std::optional<Shape> shape_of_kind(std::string_view kind, std::string_view states) {
  const auto* found = std::find_if(std::begin(kKinds), std::end(kKinds),
                                   [&](const ShapeKind& k) { return k.name == kind; });
  if (found == std::end(kKinds)) return std::nullopt;
  return found->make(ShapeStates(states));
}

}  // namespace runstone
