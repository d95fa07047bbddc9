#include "client/tools/flood_tool.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "client/tools/action_source.hpp"
#include "common/builds/basin_flood.hpp"
#include "common/materials/liquids.hpp"

namespace runstone {
namespace {

/// Fills a hollow from the place that the player chooses up to a level, as a liquid would.
class FloodTool final : public Tool {
 public:
  FloodTool()
      : Tool("flood", "fills a hollow up to a level",
             {{"depth", "voxels", 0, 64, 4, {}},
              {"voxels", "voxels", 1, 4'000'000, 1'000'000, {}}}) {}
  std::size_t points_before() const override { return value("depth") == 0 ? 1 : 0; }
  std::string_view place_name(std::size_t i) const override {
    return i == 0 ? "place in the hollow" : "place at the level";
  }
  bool is_costly() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits FloodTool::plan(const ToolInput& input) const {
  if (input.button == ToolButton::clear) return failure("flood with the right button");
  BasinFlood flood;
  flood.start = input.points.empty() ? input.target : input.points.front();
  flood.level =
      input.points.empty() ? flood.start.y + std::max(value("depth"), 1) - 1 : input.target.y;
  flood.material = input.aim.held;
  if (flood.material == kEmpty) return failure("you hold nothing to flood with");
  flood.voxels_max = static_cast<std::uint64_t>(value("voxels"));
  flood.passes = liquids(input.materials);
  if (flood.passes.size() <= flood.material) flood.passes.resize(std::size_t{flood.material} + 1);
  flood.passes[flood.material] = true;
  auto basin = flood_basin(flood, input.replica.chunk_edge(),
                           [&](ChunkCoord at) { return input.replica.shown({0, at}); });
  if (basin) {
    // Another player may build there before the edit is ordered: then those voxels stay.
    return paste_of_build(
        {std::move(basin->build), basin->at, {MaskKind::only_empty, kEmpty}, EmptyCells::skipped},
        input.replica.edit_limits());
  }
  switch (basin.error()) {
    case BasinFault::above_level:
      return failure("the level lies below the first place");
    case BasinFault::blocked:
      return failure("that place is not empty");
    case BasinFault::missing_chunk:
      return failure("the hollow reaches ground that is not loaded");
    case BasinFault::too_many_voxels:
      return failure("up to that level the hollow has more than " +
                     std::to_string(flood.voxels_max) +
                     " voxels: it may be open to a side, or needs a higher limit");
    case BasinFault::full:
      break;
  }
  return failure("the hollow is full up to that level");
}

}  // namespace

std::unique_ptr<Tool> make_flood_tool() { return std::make_unique<FloodTool>(); }

}  // namespace runstone
