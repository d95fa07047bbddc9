#include "client/tools/terrain_tools.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "client/tools/action_source.hpp"
#include "client/tools/build_words.hpp"
#include "client/tools/clipboard_copies.hpp"
#include "client/tools/typed_pattern.hpp"
#include "client/tools/upright_chunks.hpp"
#include "common/patterns/column_patterns.hpp"
#include "common/sculpt/path_brush.hpp"
#include "common/sculpt/scatter.hpp"
#include "common/sculpt/terrain_brush.hpp"

namespace runstone {
namespace {

/// Returns the places of a stroke: those over which the button was held, or the target of a click.
/// Fails as check_steps() does.
Result<std::vector<VoxelPos>, std::string> stroke_of(const ToolInput& input) {
  if (input.points.empty()) return std::vector{input.target};
  if (const auto ok = check_steps(input.points); !ok) return failure(ok.error());
  return std::vector(input.points.begin(), input.points.end());
}

/// Reads the shown columns of a box, as high and as low as chunks are shown at `place`. Fails with
/// words for the player.
Result<GroundColumns, std::string> read_shown(const Replica& replica, VoxelBox box, VoxelPos place,
                                              UprightChunks& upright) {
  const std::int32_t edge = replica.chunk_edge();
  const ChunkCoord middle = chunk_of(place, edge);
  const auto is_shown = [&](std::int32_t y) {
    return replica.shown({0, {middle.x, y, middle.z}}) != nullptr;
  };
  if (!is_shown(middle.y)) return failure("the ground is not loaded here");
  std::int32_t low = middle.y, high = middle.y;
  while (low * edge > box.min.y && is_shown(low - 1)) --low;
  while ((high + 1) * edge < box.max.y && is_shown(high + 1)) ++high;
  box.min.y = std::max(box.min.y, low * edge);
  box.max.y = std::min(box.max.y, (high + 1) * edge);
  upright.begin_plan();
  auto columns = GroundColumns::read(box, edge, [&](ChunkCoord coord) {
    auto chunk = replica.shown({0, coord});
    return chunk ? upright.of(chunk) : chunk;
  });
  if (!columns)
    return failure(std::string(columns.error().what) +
                   ": make a shorter stroke, or choose a smaller radius or width");
  return *std::move(columns);
}

/// Brushes of the terrain tool with a larger radius are costly.
constexpr std::int32_t kCheapRadiusMax = 32;

/// A tool that works on the ground along a stroke, which is drawn while the button is held.
class GroundTool : public Tool {
 public:
  using Tool::Tool;
  void forget_plan() final { upright_.clear(); }
  bool is_drawn() const final { return true; }
  bool chooses_solid() const final { return true; }
  std::string_view place_name(std::size_t) const final { return "place"; }

 protected:
  static std::vector<ToolText> ground_texts() {
    return {{"where", "not is wood and below 60", ToolText::Kind::filter},
            {"material", "70% gravel, 30% dirt, or what you hold", ToolText::Kind::mix}};
  }
  /// Returns the material that the brush sets: kMixedMaterial if a mix is typed, otherwise the held
  /// one.
  Material ground_material(const ToolInput& input) const {
    return text("material").text.empty() ? input.aim.held : kMixedMaterial;
  }
  /// Returns the changes as an action: those that the typed filter lets through, with the materials
  /// of the typed mix. Distances are measured from the first place. Fails with words for the player
  /// if there are none.
  ToolEdits action_of(const GroundColumns& columns, ColumnChanges changes, VoxelPos first,
                      std::uint64_t seed, const ToolInput& input) const;

  mutable UprightChunks upright_;  // of the last plan; they change no result
};

ToolEdits GroundTool::action_of(const GroundColumns& columns, ColumnChanges changes, VoxelPos first,
                                std::uint64_t seed, const ToolInput& input) const {
  const PatternFrame frame{seed, {2 * first.x, 2 * first.y, 2 * first.z}};
  auto where = typed_pattern(text("where"), input.materials, frame);
  if (!where) return failure(where.error());
  auto material = typed_pattern(text("material"), input.materials, frame);
  if (!material) return failure(material.error());
  if (where->filter) changes = filtered(columns, changes, *where->filter);
  if (material->mix) changes = mixed(columns, changes, *material->mix);
  const auto placed = build_of_changes(columns, changes);
  if (!placed) return failure(words_of(placed.error()));
  if (!placed->build) return failure("there is no ground to change here");
  const bool is_difference = mask().kind == MaskKind::everything;
  return paste_of_build({placed->build, placed->at, mask(), EmptyCells::pasted, is_difference},
                        input.replica.edit_limits());
}

class TerrainTool final : public GroundTool {
 public:
  TerrainTool()
      : GroundTool(
            "terrain", "shapes the ground, as long as the button is held",
            {{"radius", "voxels", 1, kBrushRadiusMax, 8, {}},
             {"mode",
              "",
              0,
              kBrushModeCount - 1,
              0,
              {"raise", "flatten", "smooth", "erode", "noise", "naturalise", "overlay"}},
             {"strength", "", 1, kBrushStrengthMax, 4, {}},
             {"falloff", "", 0, kBrushFalloffCount - 1, 0, {"smooth", "linear", "round", "none"}},
             {"seed", "", 0, 9999, 1, {}},
             mask_parameter()},
            ground_texts()) {}
  bool is_costly() const override { return value("radius") > kCheapRadiusMax; }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits TerrainTool::plan(const ToolInput& input) const {
  TerrainBrush brush;
  brush.mode = static_cast<BrushMode>(value("mode"));
  brush.falloff = static_cast<BrushFalloff>(value("falloff"));
  brush.radius = value("radius");
  brush.strength = value("strength");
  brush.lowers = input.button == ToolButton::clear;
  brush.material = ground_material(input);
  brush.seed = static_cast<std::uint64_t>(value("seed"));
  if (brush.mode == BrushMode::overlay) {
    if (brush.lowers) return failure("overlay with the right button");
    if (brush.material == kEmpty) return failure("hold a material to overlay");
  }
  const auto places = stroke_of(input);
  if (!places) return failure(places.error());
  const auto columns =
      read_shown(input.replica, brush_box(brush, *places), places->front(), upright_);
  if (!columns) return failure(columns.error());
  const GroundMaterials materials = GroundMaterials::of(input.materials);
  return action_of(*columns, brush_changes(*columns, materials, brush, *places), places->front(),
                   brush.seed, input);
}

class PathTool final : public GroundTool {
 public:
  PathTool()
      : GroundTool("path", "a way along a curve, as long as the button is held",
                   {{"width", "voxels", 1, kPathWidthMax, 3, {}},
                    {"height", "", 0, 1, 0, {"ground", "even"}},
                    mask_parameter()},
                   ground_texts()) {}
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits PathTool::plan(const ToolInput& input) const {
  if (input.button == ToolButton::clear) return failure("lay a way with the right button");
  PathBrush brush;
  brush.width = value("width");
  brush.height = static_cast<PathHeight>(value("height"));
  brush.material = ground_material(input);
  if (brush.material == kEmpty) return failure("hold a material for the way");
  const auto places = stroke_of(input);
  if (!places) return failure(places.error());
  const auto curve = curve_through(*places);
  const auto columns = read_shown(input.replica, path_box(brush, curve), places->front(), upright_);
  if (!columns) return failure(columns.error());
  const GroundMaterials materials = GroundMaterials::of(input.materials);
  return action_of(*columns, path_changes(*columns, materials, brush, curve), places->front(), 1,
                   input);
}

class ScatterTool final : public GroundTool {
 public:
  ScatterTool()
      : GroundTool("scatter", "puts copies of the clipboard on the ground",
                   {{"radius", "voxels", 1, kBrushRadiusMax, 16, {}},
                    {"spacing", "voxels", 1, 128, 6, {}},
                    {"turn", "", 0, 1, 1, {"none", "random"}},
                    {"seed", "", 0, 9999, 1, {}},
                    mask_parameter()}) {}
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits ScatterTool::plan(const ToolInput& input) const {
  if (!input.clipboard.build) return failure("copy what to scatter first");
  if (input.button == ToolButton::clear) return failure("scatter with the right button");
  if (const auto ok = check_copied(input.clipboard); !ok) return failure(ok.error());
  Scattering scattering;
  scattering.radius = value("radius");
  scattering.spacing = value("spacing");
  scattering.seed = static_cast<std::uint64_t>(value("seed"));
  const auto places = stroke_of(input);
  if (!places) return failure(places.error());
  const auto columns =
      read_shown(input.replica, scatter_box(scattering, *places), places->front(), upright_);
  if (!columns) return failure(columns.error());
  const auto spots =
      scattered_spots(*columns, GroundMaterials::of(input.materials), scattering, *places);
  if (spots.empty()) return failure("there is no ground for a copy here");
  if (spots.size() > kScatteredMax)
    return failure("more than " + std::to_string(kScatteredMax) +
                   " copies: choose a wider spacing or a smaller radius");
  std::vector<CopySpot> copies;
  for (const ScatteredSpot& spot : spots) {
    const std::uint8_t quarters = value("turn") == 1 ? spot.quarters : std::uint8_t{0};
    copies.push_back({{spot.ground.x, spot.ground.y + 1, spot.ground.z}, quarters});
  }
  return copies_of_clipboard(input, copies, mask());
}

}  // namespace

std::unique_ptr<Tool> make_terrain_tool() { return std::make_unique<TerrainTool>(); }
std::unique_ptr<Tool> make_path_tool() { return std::make_unique<PathTool>(); }
std::unique_ptr<Tool> make_scatter_tool() { return std::make_unique<ScatterTool>(); }

}  // namespace runstone
