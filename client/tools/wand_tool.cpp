#include "client/tools/wand_tool.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/tools/action_source.hpp"
#include "client/tools/build_words.hpp"
#include "common/builds/build_transforms.hpp"
#include "common/sculpt/wand.hpp"

namespace runstone {
namespace {

/// The steps by which a set of voxels grows or shrinks, at most.
constexpr std::int32_t kGrowMax = 16;

class WandTool final : public Tool {
 public:
  WandTool()
      : Tool("wand", "copies or selects connected voxels",
             {{"grow", "voxels", -kGrowMax, kGrowMax, 0, {}},
              {"reach", "", 0, 1, 0, {"connected", "selection"}},
              {"material", "", 0, 1, 0, {"same", "any"}},
              {"result", "", 0, kSelectModeCount, 0, {"copy", "select", "add", "remove"}},
              {"voxels", "voxels", 1, 4'000'000, 1'000'000, {}}}) {}
  bool chooses_solid() const override { return true; }
  bool is_costly() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;

 private:
  Result<VoxelRows, std::string> found(const ToolInput& input, const ChunkLookup& chunk_at) const;
};

Result<VoxelRows, std::string> WandTool::found(const ToolInput& input,
                                               const ChunkLookup& chunk_at) const {
  WandSearch search;
  if (value("material") == 0) search.material = input.aim.hit->material;
  search.voxels_max = static_cast<std::uint64_t>(value("voxels"));
  const std::int32_t edge = input.replica.chunk_edge();
  const bool is_connected = value("reach") == 0;
  if (!is_connected && input.selection.empty()) return failure("nothing is selected");
  auto rows = is_connected ? connected_voxels(search, input.target, edge, chunk_at)
                           : voxels_of_boxes(search, input.selection, edge, chunk_at);
  if (rows && !is_connected && input.selected) {
    rows = common(*rows, *input.selected);
    if (rows->empty()) return failure("there is no such voxel");
  }
  if (rows) return *std::move(rows);
  switch (rows.error()) {
    case FloodFault::blocked:
      return failure("there is no such voxel");
    case FloodFault::missing_chunk:
      return failure("the voxels reach ground that is not loaded");
    case FloodFault::too_many_voxels:
      break;
  }
  return failure("there are more than " + std::to_string(search.voxels_max) +
                 " voxels: choose one material or a higher limit");
}

ToolEdits WandTool::plan(const ToolInput& input) const {
  const ChunkLookup chunk_at = [&](ChunkCoord at) { return input.replica.shown({0, at}); };
  auto rows = found(input, chunk_at);
  if (!rows) return failure(rows.error());
  const std::int32_t grow = value("grow");
  if (grow > 0) rows = grown(*rows, grow);
  if (grow < 0) rows = shrunk(*rows, -grow);
  const auto placed = build_of_voxels(*rows, input.replica.chunk_edge(), chunk_at);
  if (!placed) return failure(words_of(placed.error()));
  ToolAction out;
  if (value("result") != 0) {
    out.chosen = std::make_shared<const VoxelRows>(*std::move(rows));
    out.chosen_mode = input.button == ToolButton::clear
                          ? SelectMode::remove
                          : static_cast<SelectMode>(value("result") - 1);
  } else if (input.button == ToolButton::clear) {
    const std::vector<std::optional<Material>> nothing(placed->build->palette().size(), kEmpty);
    auto cleared = with_materials(*placed->build, nothing);
    if (!cleared) return failure(words_of(cleared.error()));
    out = paste_of_build({*std::move(cleared), placed->at, {}, EmptyCells::pasted},
                         input.replica.edit_limits());
  }
  out.copied = BuildPaste{placed->build, placed->at, {}, EmptyCells::skipped};
  return out;
}

}  // namespace

std::unique_ptr<Tool> make_wand_tool() { return std::make_unique<WandTool>(); }

}  // namespace runstone
