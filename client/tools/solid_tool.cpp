#include "client/tools/solid_tool.hpp"

#include "client/tools/action_source.hpp"
#include "client/tools/build_words.hpp"
#include "common/sculpt/solid.hpp"

namespace runstone {
namespace {

class SolidTool final : public Tool {
 public:
  SolidTool()
      : Tool("solid", "a dome, cone, torus, ... between two clicks",
             {{"height", "voxels", 0, 256, 0, {}},
              {"kind",
               "",
               0,
               kSolidKindCount - 1,
               0,
               {"ellipsoid", "dome", "cylinder", "cone", "pyramid", "torus"}},
              {"fill", "", 0, kSolidFillCount - 1, 0, {"solid", "hollow", "walls"}},
              {"wall", "voxels", 1, 16, 1, {}},
              {"axis", "", 0, 2, 1, {"x", "y", "z"}},
              mask_parameter()}) {}
  std::size_t points_before() const override { return 1; }
  std::string_view place_name(std::size_t) const override { return "corner"; }
  bool spans_box() const override { return value("height") == 0; }
  ToolEdits plan(const ToolInput& input) const override;
};

ToolEdits SolidTool::plan(const ToolInput& input) const {
  const VoxelPos first = input.points.empty() ? input.target : input.points.front();
  VoxelBox box = box_between(first, input.target);
  if (value("height") > 0) box.max.y = box.min.y + value("height");
  const VoxelPos sides{box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
  if (!is_in_world(box.min, sides)) return failure("the solid reaches outside the world there");
  Solid solid;
  solid.kind = static_cast<SolidKind>(value("kind"));
  solid.fill = static_cast<SolidFill>(value("fill"));
  solid.wall = value("wall");
  solid.axis = static_cast<Axis>(value("axis"));
  const auto build = solid_build(solid, sides, material_of(input));
  if (!build) {
    if (build.error().code == ErrorCode::bad_value)
      return failure("no voxel's centre lies in so small a solid");
    return failure(words_of(build.error()));
  }
  return paste_of_build({*build, box.min, mask(), EmptyCells::pasted}, input.replica.edit_limits());
}

}  // namespace

std::unique_ptr<Tool> make_solid_tool() { return std::make_unique<SolidTool>(); }

}  // namespace runstone
