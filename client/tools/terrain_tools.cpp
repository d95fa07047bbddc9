#include "client/tools/terrain_tools.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "client/tools/clipboard_copies.hpp"
#include "client/tools/ground_stroke.hpp"
#include "client/tools/upright_chunks.hpp"
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
  /// Returns a stroke over the places, or over the target of a click, with the texts and the mask of
  /// the tool.
  BrushStroke ground_stroke(Material held, std::span<const VoxelPos> points, VoxelPos target) const;
  /// Returns the edits of the stroke. Fails with words for the player.
  ToolEdits edits_of(const ToolInput& input) const;

  mutable UprightChunks upright_;  // of the last plan; they change no result
};

BrushStroke GroundTool::ground_stroke(Material held, std::span<const VoxelPos> points,
                                      VoxelPos target) const {
  BrushStroke out;
  out.material = held;
  out.mask = mask();
  out.where = text("where").text;
  out.mix = text("material").text;
  out.places.assign(points.begin(), points.end());
  if (out.places.empty()) out.places.push_back(target);
  return out;
}

ToolEdits GroundTool::edits_of(const ToolInput& input) const {
  if (const auto ok = check_steps(input.points); !ok) return failure(ok.error());
  const auto made = stroke(input.aim.held, input.button, input.points, input.target);
  return edits_of_stroke(*made, input.replica, input.materials, upright_);
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
  std::optional<BrushStroke> stroke(Material held, ToolButton button,
                                    std::span<const VoxelPos> points,
                                    VoxelPos target) const override;
  ToolEdits plan(const ToolInput& input) const override;
};

std::optional<BrushStroke> TerrainTool::stroke(Material held, ToolButton button,
                                               std::span<const VoxelPos> points,
                                               VoxelPos target) const {
  BrushStroke out = ground_stroke(held, points, target);
  out.brush = BrushKind::terrain;
  out.mode = static_cast<std::uint8_t>(value("mode"));
  out.size = static_cast<std::uint16_t>(value("radius"));
  out.falloff = static_cast<std::uint8_t>(value("falloff"));
  out.strength = static_cast<std::uint16_t>(value("strength"));
  out.lowers = button == ToolButton::clear;
  out.seed = static_cast<std::uint32_t>(value("seed"));
  return out;
}

ToolEdits TerrainTool::plan(const ToolInput& input) const {
  if (static_cast<BrushMode>(value("mode")) == BrushMode::overlay) {
    if (input.button == ToolButton::clear) return failure("overlay with the right button");
    if (text("material").text.empty() && input.aim.held == kEmpty)
      return failure("hold a material to overlay");
  }
  return edits_of(input);
}

class PathTool final : public GroundTool {
 public:
  PathTool()
      : GroundTool("path", "a way along a curve, as long as the button is held",
                   {{"width", "voxels", 1, kPathWidthMax, 3, {}},
                    {"height", "", 0, 1, 0, {"ground", "even"}},
                    mask_parameter()},
                   ground_texts()) {}
  std::optional<BrushStroke> stroke(Material held, ToolButton button,
                                    std::span<const VoxelPos> points,
                                    VoxelPos target) const override;
  ToolEdits plan(const ToolInput& input) const override;
};

std::optional<BrushStroke> PathTool::stroke(Material held, ToolButton /*button*/,
                                            std::span<const VoxelPos> points,
                                            VoxelPos target) const {
  BrushStroke out = ground_stroke(held, points, target);
  out.brush = BrushKind::path;
  out.mode = static_cast<std::uint8_t>(value("height"));
  out.size = static_cast<std::uint16_t>(value("width"));
  return out;
}

ToolEdits PathTool::plan(const ToolInput& input) const {
  if (input.button == ToolButton::clear) return failure("lay a way with the right button");
  if (text("material").text.empty() && input.aim.held == kEmpty)
    return failure("hold a material for the way");
  return edits_of(input);
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
      read_shown_ground(input.replica, scatter_box(scattering, *places), places->front(), upright_);
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
