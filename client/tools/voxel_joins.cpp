#include "client/tools/voxel_joins.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "client/tools/aim.hpp"
#include "client/tools/cell_list.hpp"
#include "common/formats/material_family.hpp"
#include "common/shapes/shape_faces.hpp"

namespace runstone {
namespace {

enum class JoinKind : std::uint8_t { none, fence, pane, wall };

constexpr std::array<std::pair<Direction, std::string_view>, 4> kJoinSides = {
    {{Direction::neg_z, "north"},
     {Direction::pos_x, "east"},
     {Direction::pos_z, "south"},
     {Direction::neg_x, "west"}}};

bool ends_with_word(std::string_view path, std::string_view word) {
  return path.ends_with(word) &&
         (path.size() == word.size() || path[path.size() - word.size() - 1] == '_');
}

JoinKind join_kind(std::string_view path) {
  if (ends_with_word(path, "fence")) return JoinKind::fence;
  if (ends_with_word(path, "pane") || ends_with_word(path, "bars")) return JoinKind::pane;
  return ends_with_word(path, "wall") ? JoinKind::wall : JoinKind::none;
}

/// The kind of a material. Nodes of Luanti have no states by which they join.
JoinKind join_kind_of(Material material, const MaterialTable& table) {
  if (material == kEmpty || !table.knows(material)) return JoinKind::none;
  const std::string_view name = table[material].name;
  const std::string_view family = name.substr(0, name.find_first_of("[{~"));
  const JoinKind kind = join_kind(family.substr(family.find(':') + 1));
  return kind != JoinKind::none && is_shaped_node(name) ? JoinKind::none : kind;
}

bool is_of_nether_brick(std::string_view name) {
  return name.find("nether_brick") != std::string_view::npos;
}

/// Returns true if a material joins its neighbour in this direction.
bool joins(Material material, std::optional<Material> neighbour, Direction to,
           const MaterialTable& table) {
  if (!neighbour || *neighbour == kEmpty || !table.knows(*neighbour)) return false;
  const MaterialInfo& info = table[*neighbour];
  const JoinKind kind = join_kind_of(material, table), other = join_kind_of(*neighbour, table);
  if (other != JoinKind::none) {
    if (kind != JoinKind::fence) return other != JoinKind::fence;
    return other == kind &&
           is_of_nether_brick(table[material].name) == is_of_nether_brick(info.name);
  }
  const MaterialStates states = states_of_material(info.name);
  if (ends_with_word(states.path(), "fence_gate")) {
    const bool is_along_x = states.get("facing") == "north" || states.get("facing") == "south";
    return kind != JoinKind::pane && is_along_x == (axis_of(to) == Axis::x);
  }
  if (info.body != MaterialBody::solid || info.visibility == Visibility::empty) return false;
  if (info.shape.is_cube()) return !states.path().ends_with("leaves");
  return ShapeFaces(info.shape).side(opposite(to)).all();
}

/// Sets the state of one side.
void set_side(MaterialStates& states, JoinKind kind, std::string_view side, bool is_joined) {
  std::string& value = states.states[std::string(side)];
  if (kind != JoinKind::wall) {
    value = is_joined ? "true" : "false";
  } else if (!is_joined) {
    value = "none";
  } else if (value != "tall") {
    value = "low";
  }
}

/// A wall that goes straight on has no post.
void set_post(MaterialStates& states) {
  const auto is_joined = [&](std::string_view side) {
    return states.get(side) != "none" && states.get(side) != "false";
  };
  const bool north = is_joined("north"), south = is_joined("south"), east = is_joined("east"),
             west = is_joined("west");
  const bool is_straight = north == south && east == west && north != east;
  states.states["up"] = is_straight ? "false" : "true";
}

Material member_with(Material material, const MaterialStates& states, const MaterialTable& table) {
  const MaterialStates before = states_of_material(table[material].name);
  if (before.states == states.states) return material;
  return nearest_member(table, states).value_or(material);
}

/// The materials beside a voxel in the order of kJoinSides.
using SideMaterials = std::array<std::optional<Material>, kJoinSides.size()>;

SideMaterials materials_beside(VoxelPos at, const VoxelReader& voxels) {
  SideMaterials out;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = voxels(moved(at, kJoinSides[i].first, 1));
  return out;
}

/// Returns the member that a voxel becomes after voxels beside it were set. `set_to` has the new
/// materials of its neighbours, or nullopt if a neighbour was not set; then the join towards it
/// does not change.
Material rejoined(Material material, const MaterialTable& table, const SideMaterials& set_to) {
  const JoinKind kind = join_kind_of(material, table);
  if (kind == JoinKind::none) return material;
  MaterialStates states = states_of_material(table[material].name);
  for (std::size_t i = 0; i < set_to.size(); ++i) {
    const auto& [direction, side] = kJoinSides[i];
    if (set_to[i]) set_side(states, kind, side, joins(material, set_to[i], direction, table));
  }
  if (kind == JoinKind::wall) set_post(states);
  return member_with(material, states, table);
}

bool is_thin(const VoxelBox& box) {
  const std::array<std::int64_t, 3> sides = {std::int64_t{box.max.x} - box.min.x,
                                             std::int64_t{box.max.y} - box.min.y,
                                             std::int64_t{box.max.z} - box.min.z};
  std::uint64_t volume = 1;
  for (const std::int64_t side : sides) {
    if (side < 1 || side > std::int64_t{kSideMax}) return false;
    volume *= static_cast<std::uint64_t>(side);
  }
  return (sides[0] == 1 || sides[2] == 1) && volume <= kJoinedBoxVoxelsMax;
}

/// The fill of a thin box, and what it does to the voxels of the box and beside it.
class BoxJoins {
 public:
  BoxJoins(const EditDescriptor& fill, const MaterialTable& table, const VoxelReader& voxels)
      : fill_(fill),
        box_(std::get<FillBox>(fill.shape).box),
        table_(table),
        voxels_(voxels),
        joins_(join_kind_of(fill.material, table) != JoinKind::none) {}

  ToolAction action() {
    for (std::int32_t z = box_.min.z; z < box_.max.z; ++z) {
      for (std::int32_t y = box_.min.y; y < box_.max.y; ++y) {
        for (std::int32_t x = box_.min.x; x < box_.max.x; ++x) visit({x, y, z});
      }
    }
    ToolAction out(std::vector{filled()});
    for (auto& [before, cells] : followers_) {
      const Mask mask{MaskKind::only_material, before};
      if (cells.size() == 1) {
        out.edits.push_back({SetVoxel{cells.front().at}, mask, cells.front().material});
      } else if (auto paste = paste_of(std::move(cells), mask)) {
        out.edits.push_back(std::move(paste->edits.front()));
      }
    }
    out.has_followers = out.edits.size() > 1;
    return out;
  }

 private:
  /// Returns what the fill sets a voxel to, or nullopt if it does not set it.
  std::optional<Material> set_to(VoxelPos at) const {
    if (!box_.contains(at)) return std::nullopt;
    const auto before = voxels_(at);
    if (before && !fill_.mask.admits(*before)) return std::nullopt;
    return fill_.material;
  }
  std::optional<Material> after(VoxelPos at) const {
    const auto set = set_to(at);
    return set ? set : voxels_(at);
  }

  void visit(VoxelPos at) {
    if (!set_to(at)) return;
    if (joins_) cells_.push_back({at, joined(at)});
    for (const auto& [direction, side] : kJoinSides) {
      const VoxelPos beside = moved(at, direction, 1);
      if (set_to(beside)) continue;
      const auto before = voxels_(beside);
      if (!before || *before == kEmpty || !visited_.insert(beside).second) continue;
      const Material now = follower(beside, *before);
      if (now != *before) followers_[*before].push_back({beside, now});
    }
  }

  /// Equal neighbours give equal members.
  Material joined(VoxelPos at) {
    const VoxelReader reader = [this](VoxelPos place) { return after(place); };
    const auto [member, is_new] = members_.try_emplace(materials_beside(at, reader), kEmpty);
    if (is_new) member->second = joined_material(at, fill_.material, table_, reader);
    return member->second;
  }

  /// Returns what a voxel beside the fill becomes. Equal voxels with equal neighbours become equal
  /// members.
  Material follower(VoxelPos at, Material before) {
    const SideMaterials beside =
        materials_beside(at, [this](VoxelPos place) { return set_to(place); });
    const auto [member, is_new] = rejoined_.try_emplace({before, beside}, kEmpty);
    if (is_new) member->second = rejoined(before, table_, beside);
    return member->second;
  }

  EditDescriptor filled() {
    const bool is_plain = std::all_of(cells_.begin(), cells_.end(), [this](const Cell& cell) {
      return cell.material == fill_.material;
    });
    if (is_plain) return fill_;
    // The paste has only the voxels that the mask admits now. It carries the mask, because voxels
    // may change before the edit is ordered.
    auto paste = paste_of(std::move(cells_), fill_.mask);
    return paste ? std::move(paste->edits.front()) : fill_;
  }

  const EditDescriptor& fill_;
  const VoxelBox box_;
  const MaterialTable& table_;
  const VoxelReader& voxels_;
  const bool joins_;  // the material of the fill
  std::vector<Cell> cells_;
  std::map<SideMaterials, Material> members_;
  std::map<std::pair<Material, SideMaterials>, Material> rejoined_;
  std::set<VoxelPos> visited_;
  std::map<Material, std::vector<Cell>> followers_;  // by what they are now
};

}  // namespace

Material joined_material(VoxelPos at, Material material, const MaterialTable& table,
                         const VoxelReader& voxels) {
  const JoinKind kind = join_kind_of(material, table);
  if (kind == JoinKind::none) return material;
  MaterialStates states = states_of_material(table[material].name);
  for (const auto& [direction, side] : kJoinSides) {
    const auto neighbour = voxels(moved(at, direction, 1));
    set_side(states, kind, side, joins(material, neighbour, direction, table));
  }
  if (kind == JoinKind::wall) set_post(states);
  return member_with(material, states, table);
}

std::vector<EditDescriptor> joined_edits(VoxelPos at, Material material, const MaterialTable& table,
                                         const VoxelReader& voxels) {
  const Material placed = joined_material(at, material, table, voxels);
  std::vector<EditDescriptor> out = {{SetVoxel{at}, {}, placed}};
  for (const auto& [direction, side] : kJoinSides) {
    const VoxelPos place = moved(at, direction, 1);
    const auto neighbour = voxels(place);
    if (!neighbour) continue;
    const VoxelReader set_to = [&](VoxelPos beside) -> std::optional<Material> {
      if (beside != at) return std::nullopt;
      return placed;
    };
    const Material now = rejoined(*neighbour, table, materials_beside(place, set_to));
    if (now != *neighbour)
      out.push_back({SetVoxel{place}, {MaskKind::only_material, *neighbour}, now});
  }
  return out;
}

ToolAction joined_box(const EditDescriptor& fill, const MaterialTable& table,
                      const VoxelReader& voxels) {
  if (!is_thin(std::get<FillBox>(fill.shape).box)) return ToolAction(std::vector{fill});
  return BoxJoins(fill, table, voxels).action();
}

ToolAction joined_action(const EditDescriptor& edit, const MaterialTable& table,
                         const VoxelReader& voxels) {
  if (std::holds_alternative<FillBox>(edit.shape)) return joined_box(edit, table, voxels);
  const auto* const voxel = std::get_if<SetVoxel>(&edit.shape);
  if (voxel == nullptr) return ToolAction(std::vector{edit});
  ToolAction out(joined_edits(voxel->at, edit.material, table, voxels));
  out.edits.front().mask = edit.mask;
  out.has_followers = out.edits.size() > 1;
  return out;
}

}  // namespace runstone
