#include "common/formats/file_build_turn.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/builds/build_transforms.hpp"
#include "common/core/assert.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_states.hpp"
#include "common/formats/named_build.hpp"
#include "common/formats/shape_names.hpp"
#include "common/formats/turned_names.hpp"
#include "common/runs/axis_order.hpp"
#include "common/shapes/shape_faces.hpp"
#include "common/shapes/shape_states.hpp"
#include "common/shapes/turned_shape.hpp"

namespace runstone {
namespace {

/// How a build lies.
struct Lie {
  std::array<Axis, 3> along;
  std::uint8_t flips;

  std::optional<std::string> name(std::string_view before) const {
    return turned_material_name(before, along, flips);
  }
};

/// Returns the states of a turned block in which those that were written before are written, and of
/// the others those that are not the default.
std::string written_states(const ForeignBlock& turned_block, std::string_view before) {
  const auto written = split_states(before);
  const auto states = split_states(turned_block.states);
  if (!written || !states) return turned_block.states;
  const auto has = [&](std::string_view key) {
    return std::any_of(written->begin(), written->end(),
                       [&](const auto& state) { return state.first == key; });
  };
  const ForeignBlock usual = with_default_states({turned_block.name, ""});
  const ShapeStates defaults(usual.states);
  StateList out;
  for (const auto& [key, value] : *states) {
    if (has(key) || !defaults.is(key, value)) out.emplace_back(key, value);
  }
  return join_states(out);
}

/// Turns a block of Minecraft. Returns false if no state says how it lies.
bool turn_block(const ForeignBlock& named, const Lie& lie, BuildMaterial& material) {
  const bool is_written = !material.states.empty();
  const ForeignBlock block =
      with_default_states({named.name, is_written ? material.states : named.states});
  const std::string before = minecraft_material_name(block);
  const auto after = lie.name(before);
  const auto turned_block = after ? block_of_minecraft_material(*after) : std::nullopt;
  if (!turned_block) return false;
  // The name of a material that somebody has renamed says nothing of its states.
  if (material.row.name == before) material.row.name = *after;
  if (is_written) material.states = written_states(*turned_block, material.states);
  return true;
}

/// Turns a node of Luanti, whose states may be in its name, too.
bool turn_node(const Lie& lie, BuildMaterial& material) {
  const std::string node = material.row.name.substr(0, material.row.name.find('['));
  // A node with param2 0 has no states. It gets them as a reader of files gives them.
  const bool is_written = !material.states.empty() || material.row.name == node;
  const auto after =
      lie.name(material.states.empty() ? material.row.name : node + '[' + material.states + ']');
  if (!after || (!is_written && after->size() > kMaterialNameBytesMax)) return false;
  const std::string states(states_in_name(*after));
  material.row.name = is_written ? node_material_name(node, states) : *after;
  if (is_written) material.states = states;
  return true;
}

/// Returns true if a node of Luanti looks the same when it is turned: no rule says what its param2
/// means, so it keeps it.
bool stays_node(const Lie& lie, const BuildMaterial& material) {
  const std::string node = material.row.name.substr(0, material.row.name.find('['));
  return lie.name(node + "[param2=0]").has_value();
}

/// Turns a material of no other program.
bool turn_named(const Lie& lie, BuildMaterial& material) {
  const bool has_states = states_in_name(material.row.name) == material.states;
  const auto after = lie.name(material.row.name);
  if (!after) return false;
  material.row.name = *after;
  if (has_states && !material.states.empty()) material.states = states_in_name(*after);
  return true;
}

}  // namespace

std::optional<BuildMaterial> turned_build_material(const BuildMaterial& material,
                                                   std::array<Axis, 3> along, std::uint8_t flips) {
  if (material.row.visibility == Visibility::empty) return material;
  const Lie lie{along, flips};
  const std::string& name = material.row.name;
  BuildMaterial out = material;
  const bool is_node = turned_node_name(name, {Axis::x, Axis::y, Axis::z}, 0).has_value();
  const bool is_other_node = !is_node && is_luanti_node(name, material.states);
  const auto block = is_node || is_other_node ? std::nullopt : block_of_minecraft_material(name);
  const bool is_turned = is_node         ? turn_node(lie, out)
                         : is_other_node ? stays_node(lie, out)
                         : block         ? turn_block(*block, lie, out)
                                         : turn_named(lie, out);
  if (!is_turned) return std::nullopt;
  if (!material.row.shape.is_cube()) {
    const bool is_of_name = material.row.shape == shape_of_material_name(name);
    const auto of_name = is_of_name ? shape_of_material_name(out.row.name) : std::nullopt;
    out.row.shape = of_name ? *of_name : turned(material.row.shape, along, flips);
    // Rectangles are joined along one axis first, so a turned shape may have more of them.
    if (!check_shape(out.row.shape)) return std::nullopt;
  }
  return out;
}

Result<TurnedFileBuild> turned_file_build(const FileBuild& build, const Orientation& orientation,
                                          std::size_t bytes_max) {
  RUNSTONE_ASSERT(build.materials.size() == build.build->palette().size());
  if (orientation == Orientation{}) return TurnedFileBuild{build, 0};
  auto cells = turned(*build.build, orientation, bytes_max);
  if (!cells) return failure(cells.error());
  // The palette of a turned build has the order of the palette before.
  RUNSTONE_ASSERT((*cells)->palette() == build.build->palette());
  const std::array<Axis, 3> along = {orientation.along(Axis::x), orientation.along(Axis::y),
                                     orientation.along(Axis::z)};
  std::size_t stuck = 0;
  std::vector<BuildMaterial> materials;
  for (const BuildMaterial& material : build.materials) {
    auto now = turned_build_material(material, along, orientation.flips);
    if (!now) ++stuck;
    materials.push_back(now ? *std::move(now) : material);
  }
  BuildInfo info = build.info;
  const VoxelPos sides = (*cells)->sides();
  info.sides = {static_cast<std::uint32_t>(sides.x), static_cast<std::uint32_t>(sides.y),
                static_cast<std::uint32_t>(sides.z)};
  auto made = named_build(info, **cells, std::move(materials), bytes_max);
  if (!made) return failure(made.error());
  return TurnedFileBuild{*std::move(made), stuck};
}

}  // namespace runstone
