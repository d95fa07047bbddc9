#include "client/tools/text_tool.hpp"

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "client/lettering/font_file.hpp"
#include "client/lettering/text_build.hpp"
#include "client/tools/action_source.hpp"
#include "client/tools/build_words.hpp"
#include "common/builds/build_transforms.hpp"
#include "common/formats/facing_words.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone {
namespace {

/// The directions of a text in the world: along it, up its letters, and towards its reader.
struct TextDirections {
  Direction along = Direction::pos_x, up = Direction::pos_y, out = Direction::pos_z;
};

/// Returns how a text lies that is written on this face.
TextDirections directions_of(Direction face, const LookDirection& look, bool is_lying) {
  const Direction ahead = horizontal_look(look);
  if (is_lying) return {right_of(ahead), ahead, Direction::pos_y};
  const Direction out = axis_of(face) == Axis::y ? opposite(ahead) : face;
  return {right_of(opposite(out)), Direction::pos_y, out};
}

/// Returns the orientation in which the axes x, y and z of a build have these directions.
Orientation orientation_of(const TextDirections& directions) {
  std::array<Axis, 3> along{};
  Orientation out;
  constexpr std::array<Axis, 3> kAxes = {Axis::x, Axis::y, Axis::z};
  const std::array<Direction, 3> ways = {directions.along, directions.up, directions.out};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(axis_of(ways[i]));
    along[axis] = kAxes[i];
    if (!is_positive(ways[i])) out.flips = static_cast<std::uint8_t>(out.flips | 1U << axis);
  }
  for (int order = 0; order < kAxisOrderCount; ++order) {
    const auto axes = static_cast<AxisOrder>(order);
    if (axes_of(axes) == along) out.axes = axes;
  }
  return out;
}

class TextTool final : public Tool {
 public:
  TextTool()
      : Tool("text", "a line of text, on a wall or on the ground",
             {{"height", "voxels", kTextHeightMin, kTextHeightMax, 16, {}},
              {"thickness", "voxels", kTextThicknessMin, kTextThicknessMax, 1, {}},
              {"place", "", 0, 1, 0, {"standing", "lying"}},
              mask_parameter()},
             {{"text", "a line of text", ToolText::Kind::plain, "Runstone"},
              {"font", "a family or a file", ToolText::Kind::plain, kDefaultFont}}) {}
  std::string_view place_name(std::size_t) const override { return "middle of the lowest row"; }
  ToolEdits plan(const ToolInput& input) const override;

 private:
  /// Returns what read_font() returns for the name of the font. It is called again only after the
  /// name has changed, also if it has failed: it lists the folders of fonts.
  const Result<FontPtr, std::string>& font() const;

  mutable std::optional<Result<FontPtr, std::string>> font_;
  mutable std::string font_name_;  // of font_
};

const Result<FontPtr, std::string>& TextTool::font() const {
  const std::string& name = text("font").text;
  if (!font_ || font_name_ != name) {
    font_ = read_font(name);
    font_name_ = name;
  }
  return *font_;
}

ToolEdits TextTool::plan(const ToolInput& input) const {
  if (const auto ok = check_text(text("text").text); !ok) return failure(ok.error());
  const Result<FontPtr, std::string>& bytes = font();
  if (!bytes) return failure(bytes.error());
  const auto upright = text_build(**bytes, text("text").text, {value("height"), value("thickness")},
                                  material_of(input));
  if (!upright) return failure(upright.error());
  const Direction face =
      input.aim.hit && input.aim.hit->face ? *input.aim.hit->face : Direction::pos_y;
  const TextDirections directions = directions_of(face, input.aim.look, value("place") == 1);
  const auto build = turned(**upright, orientation_of(directions));
  if (!build) return failure(words_of(build.error()));
  const VoxelPos sides = (*build)->sides();
  VoxelPos at = input.target;
  // Along each axis the build begins or ends at the target.
  const auto begin = [&](Direction way) {
    if (is_positive(way)) return;
    if (axis_of(way) == Axis::x) at.x -= sides.x - 1;
    if (axis_of(way) == Axis::y) at.y -= sides.y - 1;
    if (axis_of(way) == Axis::z) at.z -= sides.z - 1;
  };
  begin(directions.up);
  // A text that is removed is cut into the wall.
  begin(input.button == ToolButton::place ? directions.out : opposite(directions.out));
  if (axis_of(directions.along) == Axis::x) {
    at.x -= sides.x / 2;
  } else {
    at.z -= sides.z / 2;
  }
  if (!is_in_world(at, sides)) return failure("the text reaches outside the world there");
  return paste_of_build({*build, at, mask(), EmptyCells::pasted}, input.replica.edit_limits());
}

}  // namespace

std::unique_ptr<Tool> make_text_tool() { return std::make_unique<TextTool>(); }

}  // namespace runstone
