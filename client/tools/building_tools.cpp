#include "client/tools/building_tools.hpp"

#include <algorithm>
#include <cmath>

#include "client/tools/build_words.hpp"
#include "client/tools/cell_list.hpp"
#include "client/tools/corner_tools.hpp"
#include "client/tools/flood_tool.hpp"
#include "client/tools/mix_tool.hpp"
#include "client/tools/placed_material.hpp"
#include "client/tools/selected_voxels.hpp"
#include "client/tools/shown_voxels.hpp"
#include "client/tools/solid_tool.hpp"
#include "client/tools/surface_flood.hpp"
#include "client/tools/terrain_tools.hpp"
#include "client/tools/text_tool.hpp"
#include "client/tools/voxel_joins.hpp"
#include "client/tools/wand_tool.hpp"

namespace runstone {
namespace {

/// Returns an edit with the joins of its voxels (joined_action()).
ToolAction joined(const ToolInput& input, const EditDescriptor& edit) {
  ShownVoxels shown(input.replica);
  ToolAction out = joined_action(edit, input.materials, [&](VoxelPos at) { return shown.at(at); });
  // On the other side of a symmetry other voxels would join.
  if (input.has_copies) {
    out.edits.resize(1);
    out.has_followers = false;
  }
  return out;
}

/// Sets or removes one voxel. It lies as the click means, and joins its neighbours.
class VoxelTool final : public Tool {
 public:
  VoxelTool() : Tool("voxel", "one voxel; hold the button for more", {}) {}
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits VoxelTool::plan(const ToolInput& input) const {
  Material material = material_of(input);
  const auto& hit = input.aim.hit;
  // A place that is typed was not clicked.
  if (hit && hit->face && moved(hit->voxel, *hit->face, 1) == input.target)
    material = placed_material(material, click_of(input.aim), input.materials);
  return joined(input, {SetVoxel{input.target}, {}, material});
}

/// The voxels of a box that the box tool fills. The values equal the values of its parameter.
enum class BoxFill : std::uint8_t { solid, hollow, walls };

/// Returns boxes that do not overlap and together are a box, its shell of some thickness, or the
/// four upright sides of that shell.
std::vector<VoxelBox> parts_of_box(const VoxelBox& box, BoxFill fill, std::int32_t wall) {
  const VoxelPos sides = sides_of(box);
  const bool has_ends = fill == BoxFill::hollow;
  const std::int32_t thinnest = std::min(sides.x, sides.z);
  if (fill == BoxFill::solid || 2 * wall >= (has_ends ? std::min(thinnest, sides.y) : thinnest))
    return {box};
  std::vector<VoxelBox> out;
  VoxelBox inner = box;
  const auto cut = [&](std::int32_t VoxelPos::* along) {
    VoxelBox low = inner, high = inner;
    low.max.*along = inner.min.*along += wall;
    high.min.*along = inner.max.*along -= wall;
    out.push_back(low);
    out.push_back(high);
  };
  if (has_ends) cut(&VoxelPos::y);
  cut(&VoxelPos::x);
  cut(&VoxelPos::z);
  return out;
}

/// Fills or clears the box between two corners.
class BoxTool final : public Tool {
 public:
  BoxTool()
      : Tool("box", "the box between two clicks",
             {{"wall", "voxels", 1, 16, 1, {}},
              {"fill", "", 0, 2, 0, {"solid", "hollow", "walls"}},
              mask_parameter()}) {}
  std::size_t points_before() const override { return 1; }
  std::string_view place_name(std::size_t) const override { return "corner"; }
  bool spans_box() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits BoxTool::plan(const ToolInput& input) const {
  const VoxelPos first = input.points.empty() ? input.target : input.points.front();
  const VoxelBox box = box_between(first, input.target);
  const auto parts = parts_of_box(box, static_cast<BoxFill>(value("fill")), value("wall"));
  if (parts.size() == 1) return joined(input, {FillBox{box}, mask(), material_of(input)});
  std::vector<EditDescriptor> edits;
  for (const VoxelBox& part : parts) edits.push_back({FillBox{part}, mask(), material_of(input)});
  return edits;
}

/// Fills or clears a sphere. Its radius is the parameter; with radius 0 the first click chooses the
/// centre, and the second one a voxel of the surface.
class SphereTool final : public Tool {
 public:
  SphereTool()
      : Tool("sphere", "a ball; with radius 0 a second click gives its size",
             {{"radius", "voxels", 0, 64, 4, {}}, mask_parameter()}) {}
  std::size_t points_before() const override { return value("radius") == 0 ? 1 : 0; }
  std::string_view place_name(std::size_t i) const override {
    return i == 0 ? "centre" : "place on the surface";
  }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits SphereTool::plan(const ToolInput& input) const {
  VoxelPos centre = input.target;
  std::int32_t radius = value("radius");
  if (radius == 0 && !input.points.empty()) {
    centre = input.points.front();
    const auto square = [](std::int32_t a, std::int32_t b) {
      const double d = static_cast<double>(a) - b;
      return d * d;
    };
    const double distance =
        std::sqrt(square(input.target.x, centre.x) + square(input.target.y, centre.y) +
                  square(input.target.z, centre.z));
    radius = static_cast<std::int32_t>(
        std::lround(std::min(distance, static_cast<double>(kEditRadiusMax))));
  }
  return std::vector{EditDescriptor{FillSphere{centre, static_cast<std::uint16_t>(radius)}, mask(),
                                    material_of(input)}};
}

/// Draws a line as thick as a sphere of its radius along the places over which the player moves the
/// aim while the button is held. The whole line is one edit.
class StrokeTool final : public Tool {
 public:
  StrokeTool()
      : Tool("stroke", "a line, as long as the button is held",
             {{"radius", "voxels", 1, 32, 2, {}}, mask_parameter()}) {}
  bool is_drawn() const override { return true; }
  std::string_view place_name(std::size_t) const override { return "place"; }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits StrokeTool::plan(const ToolInput& input) const {
  const auto radius = static_cast<std::uint16_t>(value("radius"));
  if (input.points.size() < 2) {
    const VoxelPos centre = input.points.empty() ? input.target : input.points.front();
    return std::vector{EditDescriptor{FillSphere{centre, radius}, mask(), material_of(input)}};
  }
  FillStroke stroke{{input.points.begin(), input.points.end()}, radius};
  return std::vector{EditDescriptor{std::move(stroke), mask(), material_of(input)}};
}

/// Replaces or removes the connected surface of one material on the side that the player looks at.
class FillTool final : public Tool {
 public:
  FillTool()
      : Tool("fill", "the connected surface of one material",
             {{"voxels", "voxels", 1, 16384, 4096, {}}}) {}
  bool chooses_solid() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits FillTool::plan(const ToolInput& input) const {
  SurfaceFlood flood;
  flood.face = *input.aim.hit->face;
  flood.follows_steps = true;
  flood.voxels_max = static_cast<std::size_t>(value("voxels"));
  std::vector<Cell> cells;
  for (const VoxelPos at : flood_surface(input.replica, input.target, flood))
    cells.push_back({at, material_of(input)});
  return paste_of(std::move(cells), {});
}

/// Replaces the material that the player looks at, in a sphere or a cube around it or in the
/// selection.
class ReplaceTool final : public Tool {
 public:
  ReplaceTool()
      : Tool("replace", "the material in sight by the one in the hand",
             {{"where", "", 0, 2, 0, {"sphere", "cube", "selection"}},
              {"radius", "voxels", 1, 64, 8, {}}}) {}
  bool chooses_solid() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits ReplaceTool::plan(const ToolInput& input) const {
  const Mask mask{MaskKind::only_material, input.aim.hit->material};
  const Material material = material_of(input);
  if (material == mask.material) return failure("you hold the material that you look at");
  const std::int32_t radius = value("radius");
  switch (value("where")) {
    case 1: {
      const VoxelPos c = input.target;
      const VoxelBox cube = box_between({c.x - radius, c.y - radius, c.z - radius},
                                        {c.x + radius, c.y + radius, c.z + radius});
      return std::vector{EditDescriptor{FillBox{cube}, mask, material}};
    }
    case 2: {
      if (input.selection.empty()) return failure("nothing is selected");
      if (input.selected) return refilled(input.replica, *input.selected, mask.material, material);
      std::vector<EditDescriptor> edits;
      for (const VoxelBox& box : input.selection) edits.push_back({FillBox{box}, mask, material});
      return edits;
    }
    default:
      return std::vector{EditDescriptor{
          FillSphere{input.target, static_cast<std::uint16_t>(radius)}, mask, material}};
  }
}

/// Returns true if a voxel beside this one is empty.
bool is_exposed(ShownVoxels& voxels, VoxelPos at) {
  for (int d = 0; d < kDirectionCount; ++d) {
    if (voxels.at(moved(at, static_cast<Direction>(d), 1)) == std::optional<Material>(kEmpty))
      return true;
  }
  return false;
}

/// Changes the material of the surface voxels in a sphere. Empty voxels stay empty.
class PaintTool final : public Tool {
 public:
  PaintTool()
      : Tool("paint", "the surface around the aim, not the air",
             {{"radius", "voxels", 0, 12, 3, {}}}) {}
  bool chooses_solid() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits PaintTool::plan(const ToolInput& input) const {
  if (input.button == ToolButton::clear) return failure("paint with the right button");
  const std::int32_t radius = value("radius");
  ShownVoxels voxels(input.replica);
  std::vector<Cell> cells;
  for (std::int32_t z = -radius; z <= radius; ++z) {
    for (std::int32_t y = -radius; y <= radius; ++y) {
      for (std::int32_t x = -radius; x <= radius; ++x) {
        if (x * x + y * y + z * z > radius * radius + radius) continue;
        const VoxelPos at{input.target.x + x, input.target.y + y, input.target.z + z};
        const auto material = voxels.at(at);
        if (!material || *material == kEmpty || *material == input.aim.held) continue;
        if (is_exposed(voxels, at)) cells.push_back({at, input.aim.held});
      }
    }
  }
  // Another player may clear a voxel before the edit is ordered: then the voxel stays empty.
  return paste_of(std::move(cells), {MaskKind::only_solid, kEmpty});
}

/// Bounds the work while the player moves the aim.
constexpr std::size_t kCellsMax = 65'536;

/// Moves the connected flat face that the player looks at outward or inward.
class ExtrudeTool final : public Tool {
 public:
  ExtrudeTool()
      : Tool("extrude", "pushes a flat face out, or in",
             {{"depth", "voxels", 1, 64, 1, {}},
              {"voxels", "voxels", 1, 16384, 4096, {}},
              {"material", "", 0, 1, 0, {"any", "same"}}}) {}
  bool chooses_solid() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits ExtrudeTool::plan(const ToolInput& input) const {
  const Direction face = *input.aim.hit->face;
  const std::int32_t depth = value("depth");
  SurfaceFlood flood;
  flood.face = face;
  flood.same_material = value("material") == 1;
  flood.voxels_max = static_cast<std::size_t>(value("voxels"));
  const bool is_outward = input.button == ToolButton::place;
  const std::vector<VoxelPos> surface = flood_surface(input.replica, input.target, flood);
  if (surface.size() * static_cast<std::size_t>(depth) > kCellsMax)
    return failure("the change has more than 65,536 voxels");
  ShownVoxels voxels(input.replica);
  std::vector<Cell> cells;
  for (const VoxelPos at : surface) {
    const Material material = is_outward ? voxels.at(at).value_or(kEmpty) : kEmpty;
    for (std::int32_t i = 0; i < depth; ++i)
      cells.push_back({moved(at, face, is_outward ? i + 1 : -i), material});
  }
  const Mask mask = is_outward ? Mask{MaskKind::only_empty, kEmpty} : Mask{};
  return paste_of(std::move(cells), mask);
}

/// Chooses the box between two voxels as the selection.
class SelectTool final : public Tool {
 public:
  SelectTool()
      : Tool("select", "two corners choose a box",
             {{"mode", "", 0, kSelectModeCount - 1, 0, {"new", "add", "remove"}}}) {}
  std::size_t points_before() const override { return 1; }
  bool chooses_solid() const override { return true; }
  bool selects() const override { return true; }
  SelectMode select_mode() const override { return static_cast<SelectMode>(value("mode")); }
  std::string_view place_name(std::size_t) const override { return "corner"; }
  bool spans_box() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits SelectTool::plan(const ToolInput&) const { return std::vector<EditDescriptor>{}; }

/// Pastes the clipboard at the place that the player looks at. The place is the middle of the
/// lowest layer.
class PasteTool final : public Tool {
 public:
  PasteTool() : Tool("paste", "puts the clipboard down", {mask_parameter()}) {}
  std::string_view place_name(std::size_t) const override { return "middle of the lowest layer"; }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits PasteTool::plan(const ToolInput& input) const {
  const ToolClipboard& clipboard = input.clipboard;
  if (!clipboard.build) return failure("nothing was copied");
  if (input.button == ToolButton::clear) return failure("paste with the right button");
  const VoxelPos sides = clipboard.build->sides();
  const VoxelPos at{input.target.x - sides.x / 2, input.target.y, input.target.z - sides.z / 2};
  if (!is_in_world(at, sides)) return failure("the clipboard reaches outside the world there");
  const auto& whole = clipboard.whole;
  if (whole && whole->touched() <= input.replica.edit_limits().volume_max)
    return std::vector{EditDescriptor{Paste{at, whole, {}}, mask(), kEmpty}};
  ToolAction out;
  out.pastes.push_back({clipboard.build, at, mask(), clipboard.empty});
  return out;
}

}  // namespace

std::vector<std::unique_ptr<Tool>> make_tools() {
  std::vector<std::unique_ptr<Tool>> out;
  out.push_back(std::make_unique<VoxelTool>());
  out.push_back(std::make_unique<BoxTool>());
  out.push_back(std::make_unique<SphereTool>());
  out.push_back(std::make_unique<StrokeTool>());
  out.push_back(std::make_unique<FillTool>());
  out.push_back(std::make_unique<ReplaceTool>());
  out.push_back(std::make_unique<PaintTool>());
  out.push_back(std::make_unique<ExtrudeTool>());
  out.push_back(std::make_unique<SelectTool>());
  out.push_back(std::make_unique<PasteTool>());
  out.push_back(make_flood_tool());
  out.push_back(make_solid_tool());
  out.push_back(make_mix_tool());
  out.push_back(make_terrain_tool());
  out.push_back(make_path_tool());
  out.push_back(make_scatter_tool());
  out.push_back(make_text_tool());
  out.push_back(make_polygon_tool());
  out.push_back(make_curve_tool());
  out.push_back(make_wand_tool());
  out.push_back(make_array_tool());
  return out;
}

}  // namespace runstone
