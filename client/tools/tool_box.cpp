#include "client/tools/tool_box.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "client/replica/copy_box.hpp"
#include "client/tools/merge_edits.hpp"
#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/materials/material_lookup.hpp"

namespace runstone {
namespace {

/// Bounds the work of one stack.
constexpr std::int32_t kStackMax = 64;
/// Bounds the steps of one move or growth.
constexpr std::int32_t kStepsMax = 4096;
/// A preview that is refused is planned again after so many calls.
constexpr unsigned kPlanAgainCalls = 32;

std::int32_t side_along(const VoxelBox& box, Axis axis) {
  switch (axis) {
    case Axis::x:
      return box.max.x - box.min.x;
    case Axis::y:
      return box.max.y - box.min.y;
    case Axis::z:
      break;
  }
  return box.max.z - box.min.z;
}

/// The parts of a box that moves along an axis. `entering` moves out of the box, `staying` moves
/// onto other voxels of it, and `left` is what the box leaves. A part may be empty.
struct MoveParts {
  VoxelBox entering, staying, left;
};

/// Requires 0 < steps.
MoveParts parts_of_move(const VoxelBox& box, Direction direction, std::int32_t steps) {
  const Axis axis = axis_of(direction);
  std::int32_t VoxelPos::* const at = axis == Axis::x   ? &VoxelPos::x
                                      : axis == Axis::y ? &VoxelPos::y
                                                        : &VoxelPos::z;
  const std::int32_t depth = std::min(steps, side_along(box, axis));
  MoveParts out{box, box, box};
  if (is_positive(direction)) {
    out.entering.min.*at = out.staying.max.*at = box.max.*at - depth;
    out.left.max.*at = box.min.*at + depth;
  } else {
    out.entering.max.*at = out.staying.min.*at = box.min.*at + depth;
    out.left.min.*at = box.max.*at - depth;
  }
  return out;
}

CopyEmpty copy_empty(bool is_solid) {
  return is_solid ? CopyEmpty::as_untouched : CopyEmpty::as_empty;
}

Unexpected<std::string> cannot_copy(const Error& error) {
  if (error.code == ErrorCode::bad_value) return failure("the selection is empty");
  return failure(std::string("cannot copy: ") + error.what);
}

/// Returns the clipboard with other materials. A cell of a palette entry without a new material
/// becomes untouched. Returns null if no cell is left.
std::shared_ptr<const Clipboard> with_materials(const Clipboard& clipboard,
                                                std::span<const std::optional<Material>> palette) {
  const RunChunk& cells = clipboard.cells();
  ClipboardBuilder out(cells.extent, cells.order);
  for (std::size_t i = 0; i < cells.runs.size(); ++i) {
    const Run run = cells.runs[i];
    std::optional<Material> material;
    if (run.material != 0) material = palette[run.material - 1U];
    out.append(run.end - out.filled(), material);
  }
  auto made = out.finish();
  return made ? *std::move(made) : nullptr;
}

}  // namespace

Result<void, std::string> ToolBox::choose(std::string_view name) {
  const auto it = std::find_if(tools_.begin(), tools_.end(),
                               [&](const auto& tool) { return tool->name() == name; });
  if (it == tools_.end()) return failure("there is no tool " + std::string(name));
  chosen_ = static_cast<std::size_t>(it - tools_.begin());
  points_.clear();
  ++revision_;
  return {};
}

Result<void, std::string> ToolBox::set_parameter(std::string_view name, std::int32_t value) {
  ++revision_;
  return tools_[chosen_]->set(name, value);
}

void ToolBox::change_size(std::int32_t steps) {
  if (tool().parameters().empty()) return;
  const ToolParameter first = tool().parameters().front();
  const std::int64_t value =
      std::clamp<std::int64_t>(std::int64_t{first.value} + steps, first.low, first.high);
  static_cast<void>(set_parameter(first.name, static_cast<std::int32_t>(value)));
}

Result<VoxelPos, std::string> ToolBox::target_of(const Aim& aim, ToolButton button) const {
  if (!aim.hit) {
    const bool may_float = !points_.empty() && (tool().selects() || !tool().chooses_solid());
    if (!may_float) return failure("nothing is in reach");
    // The next place in the air lies as far away as the one before.
    return voxel_on_ray(aim, distance_to(aim, points_.back()));
  }
  const bool needs_face =
      !tool().selects() && (tool().chooses_solid() || button == ToolButton::place);
  if (needs_face && !aim.hit->face) return failure("you stand there: step back first");
  if (tool().chooses_solid() || button == ToolButton::clear) return aim.hit->voxel;
  return moved(aim.hit->voxel, *aim.hit->face, 1);
}

ToolEdits ToolBox::plan(const Replica& replica, const Aim& aim, ToolButton button,
                        std::span<const VoxelPos> points, VoxelPos target) const {
  auto edits = tool().plan({replica, aim, button, points, target, selection_, clipboard_});
  if (!edits) return edits;
  for (const EditDescriptor& edit : *edits) {
    if (const auto ok = validate(edit); !ok) return failure(ok.error().what);
  }
  return with_copies(*std::move(edits), symmetry_);
}

ToolEdits ToolBox::press(const Replica& replica, const Aim& aim, ToolButton button) {
  ++revision_;
  if (!points_.empty() && button != button_) {
    points_.clear();
    return std::vector<EditDescriptor>{};
  }
  const auto target = target_of(aim, button);
  if (!target) return failure(target.error());
  if (tool().is_drawn() || points_.size() < tool().points_before()) {
    button_ = button;
    points_.push_back(*target);
    return std::vector<EditDescriptor>{};
  }
  auto edits = plan(replica, aim, button, points_, *target);
  if (tool().selects() && !points_.empty()) selection_ = box_between(points_.front(), *target);
  points_.clear();
  return edits;
}

void ToolBox::drag(const Aim& aim) {
  if (!tool().is_drawn() || points_.empty() || points_.size() >= kStrokePointsMax) return;
  const auto target = target_of(aim, button_);
  if (!target || *target == points_.back()) return;
  const VoxelPos last = points_.back();
  const std::int32_t step = std::max(
      {std::abs(target->x - last.x), std::abs(target->y - last.y), std::abs(target->z - last.z)});
  if (step > kStrokeStepMax) return;
  points_.push_back(*target);
  ++revision_;
}

ToolEdits ToolBox::release(const Replica& replica, const Aim& aim) {
  if (!tool().is_drawn() || points_.empty()) return std::vector<EditDescriptor>{};
  drag(aim);
  ++revision_;
  auto edits = plan(replica, aim, button_, points_, points_.back());
  points_.clear();
  return edits;
}

void ToolBox::type_places(std::optional<TypedPlaces> typed) {
  typed_ = std::move(typed);
  ++revision_;
}

std::array<std::size_t, 2> ToolBox::typed_count() const {
  if (tool().is_drawn()) return {1, kStrokePointsMax};
  return {tool().points_before() + 1, tool().points_before() + 1};
}

ToolEdits ToolBox::plan_typed(const Replica& replica, Material held) const {
  if (!typed_) return failure("no places are typed");
  const std::span<const VoxelPos> places = typed_->places;
  const auto [least, most] = typed_count();
  if (places.size() < least || places.size() > most) {
    return failure("the tool " + std::string(tool().name()) + " takes " + std::to_string(least) +
                   (least == most ? "" : " to " + std::to_string(most)) +
                   (most == 1 ? " place" : " places"));
  }
  const VoxelPos target = places.back();
  Aim aim;
  aim.held = held;
  const auto material = replica.shown_at(target);
  if (material) aim.hit = RayHit{target, *material, typed_->face, 0};
  if (tool().chooses_solid() && !tool().selects()) {
    if (!material) return failure("that place is not loaded");
    if (*material == kEmpty) return failure("there is only air at that place");
  }
  const std::size_t before = tool().is_drawn() ? places.size() : places.size() - 1;
  return plan(replica, aim, typed_->button, places.first(before), target);
}

ToolEdits ToolBox::apply_typed(const Replica& replica, Material held) {
  auto edits = plan_typed(replica, held);
  ++revision_;
  if (edits && tool().selects())
    selection_ = box_between(typed_->places.front(), typed_->places.back());
  return edits;
}

bool ToolBox::cancel() {
  ++revision_;
  const bool had_points = !points_.empty();
  points_.clear();
  return had_points;
}

void ToolBox::select(std::optional<VoxelBox> box) {
  selection_ = box && !box->empty() ? box : std::nullopt;
  ++revision_;
}

Result<VoxelBox, std::string> ToolBox::selected() const {
  if (!selection_) return failure("nothing is selected");
  return *selection_;
}

Result<void, std::string> ToolBox::grow(Direction side, std::int32_t steps) {
  const auto box = selected();
  if (!box) return failure(box.error());
  if (std::abs(steps) > kStepsMax) return failure("the selection moves by at most 4096 voxels");
  VoxelBox grown = *box;
  const std::int32_t shrinks_max = side_along(grown, axis_of(side)) - 1;
  VoxelPos& corner = is_positive(side) ? grown.max : grown.min;
  corner = moved(corner, side, std::max(steps, -shrinks_max));
  select(grown);
  return {};
}

Result<void, std::string> ToolBox::shift(Direction direction, std::int32_t steps) {
  const auto box = selected();
  if (!box) return failure(box.error());
  if (std::abs(steps) > kStepsMax) return failure("the selection moves by at most 4096 voxels");
  select(moved(*box, direction, steps));
  return {};
}

Result<void, std::string> ToolBox::copy(const Replica& replica, bool is_solid) {
  const auto box = selected();
  if (!box) return failure(box.error());
  auto copied = copy_box(replica, *box, copy_empty(is_solid));
  if (!copied) return cannot_copy(copied.error());
  clipboard_ = {*std::move(copied), {}};
  clipboard_names_.clear();
  for (const Material material : clipboard_.content->palette()) {
    clipboard_names_.push_back(materials_.knows(material) ? materials_[material].name : "");
  }
  ++revision_;
  return {};
}

ToolEdits ToolBox::cut(const Replica& replica, bool is_solid) {
  if (const auto copied = copy(replica, is_solid); !copied) return failure(copied.error());
  return fill(kEmpty);
}

ToolEdits ToolBox::fill(Material material) const {
  const auto box = selected();
  if (!box) return failure(box.error());
  return std::vector{EditDescriptor{FillBox{*box}, {}, material}};
}

ToolEdits ToolBox::replace(Material from, Material to) const {
  const auto box = selected();
  if (!box) return failure(box.error());
  return std::vector{EditDescriptor{FillBox{*box}, {MaskKind::only_material, from}, to}};
}

ToolEdits ToolBox::stack(const Replica& replica, Direction direction, std::int32_t times) const {
  const auto box = selected();
  if (!box) return failure(box.error());
  if (times < 1 || times > kStackMax) return failure("a stack has 1 to 64 copies");
  const auto copied = copy_box(replica, *box, CopyEmpty::as_empty);
  if (!copied) return cannot_copy(copied.error());
  const std::int32_t side = side_along(*box, axis_of(direction));
  std::vector<EditDescriptor> edits;
  for (std::int32_t i = 1; i <= times; ++i)
    edits.push_back({Paste{moved(box->min, direction, i * side), *copied, {}}, {}, kEmpty});
  return merge_edits(std::move(edits));
}

ToolEdits ToolBox::move(const Replica& replica, Direction direction, std::int32_t steps) {
  const auto box = selected();
  if (!box) return failure(box.error());
  if (std::abs(steps) > kStepsMax) return failure("the selection moves by at most 4096 voxels");
  if (steps == 0) return failure("the selection moves by one voxel or more");
  const Direction towards = steps > 0 ? direction : opposite(direction);
  const MoveParts parts = parts_of_move(*box, towards, std::abs(steps));
  // The place that is left is cleared last: if an edit is refused, nothing is lost.
  std::vector<EditDescriptor> edits;
  for (const auto& [part, how] : {std::pair{parts.entering, CopyEmpty::as_untouched},
                                  std::pair{parts.staying, CopyEmpty::as_empty}}) {
    if (part.empty()) continue;
    auto copied = copy_box(replica, part, how);
    if (!copied && copied.error().code == ErrorCode::bad_value) continue;  // nothing is in it
    if (!copied) return cannot_copy(copied.error());
    edits.push_back({Paste{moved(part.min, direction, steps), *std::move(copied), {}}, {}, kEmpty});
  }
  if (edits.empty()) return failure("the selection is empty");
  edits.push_back({FillBox{parts.left}, {}, kEmpty});
  select(moved(*box, direction, steps));
  return merge_edits(std::move(edits));
}

void ToolBox::rotate(int quarters) {
  clipboard_.orientation = clipboard_.orientation.rotated_about_y(quarters);
  ++revision_;
}

void ToolBox::mirror(Axis axis) {
  clipboard_.orientation = clipboard_.orientation.mirrored(axis);
  ++revision_;
}

void ToolBox::set_symmetry(const Symmetry& symmetry) {
  symmetry_ = symmetry;
  ++revision_;
}

void ToolBox::show_preview(bool is_shown) {
  is_preview_shown_ = is_shown;
  ++revision_;
}

std::string ToolBox::set_materials(const MaterialTable& materials) {
  materials_ = materials;
  preview_.set_visibility(VisibilityTable(visibilities(materials)));
  points_.clear();
  typed_.reset();  // an open window gives its places again
  ++revision_;
  if (!clipboard_.content) return {};
  std::vector<std::optional<Material>> palette;
  std::vector<std::string> names;
  std::string lacking;
  for (const std::string& name : clipboard_names_) {
    palette.push_back(materials.find(name));
    if (palette.back()) continue;
    lacking += (lacking.empty() ? "" : ", ") + name;
  }
  clipboard_.content = with_materials(*clipboard_.content, palette);
  clipboard_names_.clear();
  if (clipboard_.content) {
    for (const Material material : clipboard_.content->palette())
      clipboard_names_.push_back(materials[material].name);
  }
  if (lacking.empty()) return {};
  return "the clipboard lost materials that this world lacks: " + lacking;
}

bool ToolBox::step_preview(const Replica& replica, const Aim& aim, std::size_t chunks_max) {
  const ToolButton button = points_.empty() ? ToolButton::place : button_;
  const auto target = typed_ ? Result<VoxelPos, std::string>(VoxelPos{}) : target_of(aim, button);
  Previewed wanted{{}, {}, target ? *target : VoxelPos{}, kEmpty, aim.held, revision_};
  if (aim.hit && !typed_) {
    wanted.voxel = aim.hit->voxel;
    wanted.face = aim.hit->face;
    wanted.seen = aim.hit->material;
  }
  // A refusal may end without a change of what is watched, for example when a chunk arrives.
  const bool is_planned_again =
      !preview_refusal_.empty() && ++refused_calls_ % kPlanAgainCalls == 0;
  if (previewed_ != wanted || is_planned_again || preview_.is_outdated(replica)) {
    previewed_ = wanted;
    preview_refusal_.clear();
    std::vector<EditDescriptor> edits;
    if (is_preview_shown_ && !tool().selects()) {
      auto planned = typed_   ? plan_typed(replica, aim.held)
                     : target ? plan(replica, aim, button, points_, *target)
                              : ToolEdits(failure(target.error()));
      if (planned) {
        edits = *std::move(planned);
      } else {
        preview_refusal_ = planned.error();
      }
    }
    preview_.set(std::move(edits));
  }
  return preview_.step(replica, chunks_max);
}

}  // namespace runstone
