#include "client/tools/corner_tools.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "client/tools/action_source.hpp"
#include "client/tools/build_words.hpp"
#include "client/tools/clipboard_copies.hpp"
#include "common/sculpt/polygon.hpp"
#include "common/sculpt/tube.hpp"

namespace runstone {
namespace {

static_assert(kPolygonCornersMax >= kStrokePointsMax);

class CornerTool : public Tool {
 public:
  using Tool::Tool;
  std::size_t points_before() const final { return 1; }
  std::size_t points_before_max() const final { return kStrokePointsMax - 1; }
  bool completes(std::span<const VoxelPos> points, VoxelPos target) const override {
    return points.size() >= points_before_max() || (!points.empty() && points.back() == target);
  }
  std::string_view place_name(std::size_t) const final { return "corner"; }

 protected:
  /// Returns the corners of a click without those that repeat the one before.
  static std::vector<VoxelPos> corners_of(const ToolInput& input) {
    std::vector<VoxelPos> out(input.points.begin(), input.points.end());
    out.push_back(input.target);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }
  ToolEdits action_of(const Result<PlacedBuild>& placed, const ToolInput& input) const {
    if (!placed) return failure(std::string(placed.error().what));
    if (!is_in_world(placed->at, placed->build->sides()))
      return failure("the shape reaches outside the world there");
    return paste_of_build({placed->build, placed->at, mask(), EmptyCells::pasted},
                          input.replica.edit_limits());
  }
};

class PolygonTool final : public CornerTool {
 public:
  PolygonTool()
      : CornerTool("polygon", "a prism over corners; a corner again ends it",
                   {{"height", "voxels", 1, 256, 4, {}},
                    {"fill", "", 0, kSolidFillCount - 1, 0, {"solid", "hollow", "walls"}},
                    {"wall", "voxels", 1, 16, 1, {}},
                    mask_parameter()}) {}
  bool completes(std::span<const VoxelPos> points, VoxelPos target) const override {
    return CornerTool::completes(points, target) || (points.size() > 2 && points.front() == target);
  }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits PolygonTool::plan(const ToolInput& input) const {
  Prism prism;
  prism.height = value("height");
  prism.fill = static_cast<SolidFill>(value("fill"));
  prism.wall = value("wall");
  return action_of(polygon_build(prism, corners_of(input), material_of(input)), input);
}

/// Tubes that are thicker are costly.
constexpr std::int32_t kCheapThicknessMax = 8;

class CurveTool final : public CornerTool {
 public:
  CurveTool()
      : CornerTool("curve", "a bar through places; the last again ends it",
                   {{"thickness", "voxels", 1, kTubeThicknessMax, 1, {}},
                    {"bend", "", 0, 1, 0, {"curve", "straight"}},
                    mask_parameter()}) {}
  bool is_costly() const override { return value("thickness") > kCheapThicknessMax; }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits CurveTool::plan(const ToolInput& input) const {
  const auto places = corners_of(input);
  if (const auto ok = check_steps(places); !ok) return failure(ok.error());
  const Tube tube{value("thickness"), static_cast<TubeBend>(value("bend"))};
  return action_of(tube_build(tube, places, material_of(input)), input);
}

class ArrayTool final : public CornerTool {
 public:
  ArrayTool()
      : CornerTool("array", "copies of the clipboard along a curve",
                   {{"spacing", "voxels", 1, 256, 8, {}},
                    {"turn", "", 0, 1, 0, {"none", "along"}},
                    mask_parameter()}) {}
  ToolEdits plan(const ToolInput& input) const override;

 private:
  /// Returns places along the line that are `spacing` voxels apart, the first one at its begin.
  std::vector<CopySpot> spots_along(std::span<const CurvePoint> line) const;
};

/// Returns the quarter turns after which what ran along +x runs as a line does.
std::uint8_t quarters_along(const CurvePoint& from, const CurvePoint& to) {
  const double x = to.x - from.x, z = to.z - from.z;
  if (std::abs(x) >= std::abs(z)) return x < 0 ? 2 : 0;
  return z < 0 ? 1 : 3;
}

std::vector<CopySpot> ArrayTool::spots_along(std::span<const CurvePoint> line) const {
  std::vector<CopySpot> out;
  const double spacing = value("spacing");
  double way = spacing;  // since the last spot
  for (std::size_t i = 0; i < line.size(); ++i) {
    const CurvePoint& at = line[i];
    if (i > 0) way += std::hypot(at.x - line[i - 1].x, at.y - line[i - 1].y, at.z - line[i - 1].z);
    // The sum of many short ways is rounded.
    if (way < spacing - 1e-6) continue;
    way -= spacing;
    CopySpot spot{{static_cast<std::int32_t>(std::floor(at.x)),
                   static_cast<std::int32_t>(std::floor(at.y)),
                   static_cast<std::int32_t>(std::floor(at.z))}};
    if (value("turn") == 1 && line.size() > 1) {
      const std::size_t before = i == 0 ? 0 : i - 1;
      spot.quarters = quarters_along(line[before], line[before + 1]);
    }
    out.push_back(spot);
  }
  return out;
}

ToolEdits ArrayTool::plan(const ToolInput& input) const {
  if (input.button == ToolButton::clear) return failure("put copies down with the right button");
  if (const auto ok = check_copied(input.clipboard); !ok) return failure(ok.error());
  const auto places = corners_of(input);
  if (const auto ok = check_steps(places); !ok) return failure(ok.error());
  const auto spots = spots_along(tube_line({}, places));
  if (spots.size() > kCopiesMax)
    return failure("more than " + std::to_string(kCopiesMax) + " copies: choose a wider spacing");
  return copies_of_clipboard(input, spots, mask());
}

}  // namespace

std::unique_ptr<Tool> make_array_tool() { return std::make_unique<ArrayTool>(); }
std::unique_ptr<Tool> make_polygon_tool() { return std::make_unique<PolygonTool>(); }
std::unique_ptr<Tool> make_curve_tool() { return std::make_unique<CurveTool>(); }

}  // namespace runstone
