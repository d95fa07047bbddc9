#include "client/tools/mix_tool.hpp"

#include <cstdint>
#include <utility>
#include <vector>

#include "client/tools/action_source.hpp"
#include "client/tools/build_words.hpp"
#include "client/tools/pattern_work.hpp"
#include "client/tools/typed_pattern.hpp"
#include "common/patterns/replaced.hpp"

namespace runstone {
namespace {

/// The voxels of a box that is worked out at the click. A larger one, and several boxes, are worked
/// out in steps.
constexpr std::uint64_t kAtOnceVoxelsMax = std::uint64_t{1} << 18;

bool is_worked_out_at_once(const VoxelPos& sides) {
  const auto area = static_cast<std::uint64_t>(sides.x) * static_cast<std::uint64_t>(sides.z);
  return area <= kAtOnceVoxelsMax && area * static_cast<std::uint64_t>(sides.y) <= kAtOnceVoxelsMax;
}

class MixTool final : public Tool {
 public:
  MixTool()
      : Tool("mix", "a box by a typed pattern of materials",
             {{"seed", "", 0, 9999, 1, {}}, {"region", "", 0, 1, 0, {"clicks", "selection"}}},
             {{"pattern", "70% stone, 30% moss where is dirt and exposed",
               ToolText::Kind::pattern}}) {}
  std::size_t points_before() const override { return is_selected() ? 0 : 1; }
  bool chooses_solid() const override { return true; }
  bool reaches_air() const override { return true; }
  std::string_view place_name(std::size_t) const override {
    return is_selected() ? "any place" : "corner";
  }
  bool spans_box() const override { return !is_selected(); }
  bool is_costly() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;

 private:
  bool is_selected() const { return value("region") == 1; }
};

ToolEdits MixTool::plan(const ToolInput& input) const {
  std::vector<VoxelBox> boxes(input.selection.begin(), input.selection.end());
  if (!is_selected()) {
    boxes = {box_between(input.points.empty() ? input.target : input.points.front(), input.target)};
  }
  if (boxes.empty()) return failure("nothing is selected");
  VoxelBox around;
  for (const VoxelBox& box : boxes) around = bounding_box(around, box);
  if (!is_in_world(around.min, sides_of(around)))
    return failure("the box reaches outside the world there");
  const PatternFrame frame{static_cast<std::uint64_t>(value("seed")), middle2_of(around)};
  auto typed = typed_pattern(text("pattern"), input.materials, frame);
  if (!typed) return failure(typed.error());
  if (!typed->mix) return failure("type a pattern first, such as 70% stone, 30% gravel");
  BoundMix mix = input.button == ToolButton::clear ? BoundMix::of(kEmpty) : *std::move(typed->mix);
  ToolAction out;
  const VoxelRowsPtr only = is_selected() ? input.selected : nullptr;
  if (boxes.size() > 1 || only || !is_worked_out_at_once(sides_of(around))) {
    auto work = pattern_work(input.replica, std::move(boxes), std::move(mix),
                             std::move(typed->filter), only);
    if (!work) return failure(work.error());
    out.pattern = *std::move(work);
    return out;
  }
  const auto placed =
      replaced(around, mix, typed->filter ? &*typed->filter : nullptr, input.replica.chunk_edge(),
               [&](ChunkCoord at) { return input.replica.shown({0, at}); });
  if (!placed) return failure(pattern_failure(placed.error()));
  if (!placed->build) return failure("the pattern changes no voxel there");
  return paste_of_build({placed->build, placed->at, {}, EmptyCells::pasted, true},
                        input.replica.edit_limits());
}

}  // namespace

std::unique_ptr<Tool> make_mix_tool() { return std::make_unique<MixTool>(); }

}  // namespace runstone
