#include "client/tools/tool_box.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <utility>
#include <variant>

#include "client/replica/copy_box.hpp"
#include "client/tools/action_source.hpp"
#include "client/tools/build_words.hpp"
#include "client/tools/merge_edits.hpp"
#include "client/tools/placed_material.hpp"
#include "client/tools/shown_voxels.hpp"
#include "client/tools/turned_materials.hpp"
#include "client/tools/voxel_joins.hpp"
#include "common/builds/build_builder.hpp"
#include "common/builds/build_transforms.hpp"
#include "common/core/assert.hpp"
#include "common/core/build_info.hpp"
#include "common/formats/material_family.hpp"
#include "common/formats/turned_names.hpp"
#include "common/materials/material_lookup.hpp"
#include "common/materials/nearest_material.hpp"
#include "common/mesh_materials/mesh_materials_of.hpp"
#include "common/sculpt/row_build.hpp"
#include "common/sculpt/voxel_rows.hpp"
#include "common/shapes/shape_faces.hpp"
#include "common/shapes/turned_shape.hpp"

namespace runstone {
namespace {

/// Bounds the copies of one stack.
constexpr std::int32_t kStackMax = 4096;
/// Bounds the steps of one move or growth.
constexpr std::int32_t kStepsMax = 4096;
/// Bounds the work for a selection of several boxes that becomes a build: its rows along x, each cut
/// at the borders of chunks.
constexpr std::uint64_t kSelectedPiecesMax = std::uint64_t{1} << 20;
/// The words for a selection of more than BoxSet::kBoxesMax boxes.
constexpr const char* kTooManyParts = "the selection would have more than 256 parts";
/// A preview that is refused is planned again after so many calls.
constexpr unsigned kPlanAgainCalls = 32;
/// That of a costly tool is planned again after so many calls, if the replica has changed.
constexpr unsigned kCostlyAgainCalls = 256;
/// The colour of the ghosts of selected voxels.
constexpr std::array<std::uint8_t, 3> kSelectedColour = {60, 160, 255};
/// Selected voxels have no ghosts if their box has more rows along x than this.
constexpr std::int64_t kSelectedGhostRowsMax = std::int64_t{1} << 20;
/// The names of missing materials that a message lists.
constexpr std::size_t kLackingListed = 8;

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

EmptyCells empty_cells(bool is_solid) {
  return is_solid ? EmptyCells::skipped : EmptyCells::pasted;
}

Unexpected<std::string> cannot_copy(const Error& error) {
  return failure("cannot copy: " + words_of(error));
}

template <class T>
void append(std::vector<T>& to, std::vector<T> from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// Returns the number of chunks that a box meets, at most about 2^60.
std::uint64_t chunks_of(const VoxelBox& box, std::int32_t edge) {
  const VoxelPos sides = sides_of(box);
  const auto along = [&](std::int32_t side) {
    return std::min<std::uint64_t>(static_cast<std::uint64_t>(side / edge) + 2, 1U << 20);
  };
  return along(sides.x) * along(sides.y) * along(sides.z);
}

/// Returns true if the rows of the boxes along x have more than kSelectedPiecesMax pieces, each row
/// counted with one piece more than it may have.
bool has_too_many_pieces(std::span<const VoxelBox> boxes, std::int32_t edge) {
  std::uint64_t pieces = 0;
  for (const VoxelBox& box : boxes) {
    const VoxelPos sides = sides_of(box);
    const auto rows = static_cast<std::uint64_t>(sides.y) * static_cast<std::uint64_t>(sides.z);
    // More rows would not leave the product in its range.
    if (rows > kSelectedPiecesMax) return true;
    pieces += rows * (static_cast<std::uint64_t>(sides.x / edge) + 2);
    if (pieces > kSelectedPiecesMax) return true;
  }
  return false;
}

/// Returns a build of one material of these voxels, or null if it would take too much memory.
BuildPtr build_of_selected(const VoxelRows& rows) {
  const VoxelBox& box = rows.box();
  const VoxelPos sides = sides_of(box);
  // The build reads each row of the box, so the number of rows is bounded.
  if (std::int64_t{sides.y} * sides.z > kSelectedGhostRowsMax || sides.x > kBuildSideMax)
    return nullptr;
  const auto row_of = [&](std::int32_t y, std::int32_t z, std::vector<RowStretch>& out) {
    const auto* const row = rows.row(y + box.min.y, z + box.min.z);
    if (row == nullptr) return;
    for (const RowStretch& part : *row)
      out.push_back({part.low - box.min.x, part.high - box.min.x});
  };
  auto made = build_of_rows(sides, Axis::y, Material{1}, row_of);
  return made ? *std::move(made) : nullptr;
}

/// Returns a build of one material with the sides of a box, or null if there is no such build.
BuildPtr block_of(const VoxelBox& box, Material material) {
  const VoxelPos sides = sides_of(box);
  if (std::max({sides.x, sides.y, sides.z}) > kBuildSideMax) return nullptr;
  constexpr auto kEdge = static_cast<std::int32_t>(kSideMax);
  auto out = BuildBuilder::of(
      {grid_cuts(sides.x, kEdge), grid_cuts(sides.y, kEdge), grid_cuts(sides.z, kEdge)});
  if (!out) return nullptr;
  const std::uint16_t number = *out->number_of(material);
  const BuildCuts cuts = out->cuts();
  const auto side = [&](std::size_t axis, std::uint32_t i) {
    return static_cast<std::uint8_t>(cuts[axis][i + 1U] - cuts[axis][i]);
  };
  for (SectionPos at; at.z + 1U < cuts[2].size(); ++at.z) {
    for (at.y = 0; at.y + 1U < cuts[1].size(); ++at.y) {
      for (at.x = 0; at.x + 1U < cuts[0].size(); ++at.x) {
        const Extent extent{side(0, at.x), side(1, at.y), side(2, at.z)};
        if (!out->put(at, uniform_chunk(extent, number))) return nullptr;
      }
    }
  }
  auto made = out->finish();
  return made ? *std::move(made) : nullptr;
}

}  // namespace

Result<void, std::string> ToolBox::choose(std::string_view name) {
  const auto it = std::find_if(tools_.begin(), tools_.end(),
                               [&](const auto& tool) { return tool->name() == name; });
  if (it == tools_.end()) return failure("there is no tool " + std::string(name));
  // Forgets the chunks that the last plan kept.
  tools_[chosen_]->forget_plan();
  pattern_.set(nullptr);
  chosen_ = static_cast<std::size_t>(it - tools_.begin());
  points_.clear();
  ++revision_;
  return {};
}

Result<void, std::string> ToolBox::set_parameter(std::string_view name, std::int32_t value) {
  ++revision_;
  return tools_[chosen_]->set(name, value);
}

Result<void, std::string> ToolBox::set_text(std::string_view name, std::string text) {
  ++revision_;
  return tools_[chosen_]->set_text(name, std::move(text));
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
    const bool may_float = !points_.empty() && (tool().reaches_air() || !tool().chooses_solid());
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
                        std::span<const VoxelPos> points, VoxelPos target) {
  auto made =
      tool().plan({replica, aim, button, points, target, selected_.boxes.boxes(), selected_.voxels,
                   clipboard_, materials_, symmetry_.kind != SymmetryKind::none});
  if (!made) return made;
  for (const EditDescriptor& edit : made->edits) {
    // A box may be longer than one descriptor has it: then it is cut.
    if (std::holds_alternative<FillBox>(edit.shape)) continue;
    if (const auto ok = validate(edit); !ok) return failure(ok.error().what);
  }
  return with_copies(*std::move(made), symmetry_, mirrored_, materials_);
}

ToolEdits ToolBox::press(const Replica& replica, const Aim& aim, ToolButton button) {
  ++revision_;
  if (!points_.empty() && button != button_) {
    points_.clear();
    return std::vector<EditDescriptor>{};
  }
  const auto target = target_of(aim, button);
  if (!target) return failure(target.error());
  if (tool().is_drawn() || !tool().completes(points_, *target)) {
    button_ = button;
    points_.push_back(*target);
    return std::vector<EditDescriptor>{};
  }
  auto edits = plan(replica, aim, button, points_, *target);
  if (tool().selects() && !points_.empty()) {
    const auto done =
        select(box_between(points_.front(), *target), held_mode_.value_or(tool().select_mode()));
    if (!done) edits = failure(done.error());
  }
  hold_copied(edits);
  keep_pasted(replica, edits);
  points_.clear();
  return edits;
}

void ToolBox::drag(const Aim& aim) {
  if (!tool().is_drawn() || points_.empty() || points_.size() >= kStrokePointsMax) return;
  const auto target = target_of(aim, button_);
  if (!target || *target == points_.back()) return;
  if (stroke_step(points_.back(), *target) > kStrokeStepMax) return;
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

std::optional<VoxelBox> ToolBox::spanned(const Aim& aim) const {
  if (points_.empty() || !tool().spans_box()) return std::nullopt;
  const auto target = target_of(aim, button_);
  if (!target) return std::nullopt;
  return box_between(points_.front(), *target);
}

std::optional<BrushStroke> ToolBox::next_stroke(const Aim& aim) const {
  if (typed_ || symmetry_.kind != SymmetryKind::none) return std::nullopt;
  const ToolButton button = points_.empty() ? ToolButton::place : button_;
  const auto target = target_of(aim, button);
  if (!target) return std::nullopt;
  return tool().stroke(aim.held, button, points_, *target);
}

void ToolBox::type_places(std::optional<TypedPlaces> typed) {
  typed_ = std::move(typed);
  ++revision_;
}

std::array<std::size_t, 2> ToolBox::typed_count() const {
  if (tool().is_drawn()) return {1, kStrokePointsMax};
  return {tool().points_before() + 1, tool().points_before_max() + 1};
}

ToolEdits ToolBox::plan_typed(const Replica& replica, Material held) {
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
  if (tool().chooses_solid() && !tool().reaches_air()) {
    if (!material) return failure("that place is not loaded");
    if (*material == kEmpty) return failure("there is only air at that place");
  }
  const std::size_t before = tool().is_drawn() ? places.size() : places.size() - 1;
  return plan(replica, aim, typed_->button, places.first(before), target);
}

ToolEdits ToolBox::apply_typed(const Replica& replica, Material held) {
  auto edits = plan_typed(replica, held);
  ++revision_;
  if (edits && tool().selects()) {
    const auto done = select(box_between(typed_->places.front(), typed_->places.back()),
                             held_mode_.value_or(tool().select_mode()));
    if (!done) return failure(done.error());
  }
  hold_copied(edits);
  keep_pasted(replica, edits);
  return edits;
}

bool ToolBox::cancel() {
  ++revision_;
  const bool had_points = !points_.empty();
  points_.clear();
  return had_points;
}

void ToolBox::select(std::optional<VoxelBox> box) { select(BoxSet(box.value_or(VoxelBox{}))); }

void ToolBox::select(BoxSet boxes) { select(Selected{std::move(boxes), nullptr, 0}); }

void ToolBox::select(Selected selected) {
  const bool are_others = selected_.voxels != selected.voxels;
  selected_ = std::move(selected);
  selection_ = selected_.empty() ? std::nullopt : std::optional(selected_.boxes.around());
  ++revision_;
  if (!are_others) return;
  std::vector<ShownBuild> shown;
  if (BuildPtr build = selected_.voxels ? build_of_selected(*selected_.voxels) : nullptr)
    shown.push_back({std::move(build), selected_.voxels->box().min});
  selected_preview_.set(std::move(shown));
}

Result<void, std::string> ToolBox::select(const VoxelBox& box, SelectMode mode) {
  if (selected_.voxels && mode != SelectMode::fresh) {
    // Only the part of the box around the voxels can remove voxels.
    const VoxelBox part = mode == SelectMode::add ? box : intersect(box, *selection_);
    if (part.empty()) return {};
    const auto rows = rows_of({BoxSet(part), nullptr, 0});
    if (!rows) return failure(rows.error());
    auto made = combined(selected_, *rows, mode);
    if (!made) return failure(made.error());
    select(*std::move(made));
    return {};
  }
  std::optional<BoxSet> now(BoxSet{box});
  if (mode == SelectMode::add) now = BoxSet::united(selected_.boxes, *now);
  if (mode == SelectMode::remove) now = BoxSet::without(selected_.boxes, *now);
  if (!now) return failure(kTooManyParts);
  select(*std::move(now));
  return {};
}

Result<void, std::string> ToolBox::narrow(const Replica& replica, const std::string& filter,
                                          bool is_kept) {
  if (!replica.opened()) return failure("no world is open");
  auto made = filtered(replica, selected_, filter, is_kept, materials_);
  if (!made) return failure(made.error());
  select(*std::move(made));
  return {};
}

Result<BoxSet, std::string> ToolBox::boxes_or_words() const {
  if (selected_.empty()) return failure("nothing is selected");
  return selected_.boxes;
}

Result<BuildPtr, std::string> ToolBox::selected_build(const Replica& replica) const {
  const std::span<const VoxelBox> boxes = selected_.boxes.boxes();
  if (boxes.size() == 1 && !selected_.voxels) {
    auto copied = copy_box(replica, boxes.front());
    if (!copied) return cannot_copy(copied.error());
    return *std::move(copied);
  }
  if (!replica.opened()) return failure("no world is open");
  if (!selected_.voxels && has_too_many_pieces(boxes, replica.chunk_edge()))
    return failure("too many voxels to copy of several boxes: select one box, or fewer voxels");
  const VoxelRowsPtr rows =
      selected_.voxels ? selected_.voxels : std::make_shared<const VoxelRows>(rows_of_boxes(boxes));
  auto placed = build_of_voxels(
      *rows, replica.chunk_edge(), [&](ChunkCoord at) { return replica.shown({0, at}); }, true);
  if (!placed) return cannot_copy(placed.error());
  return std::move(placed->build);
}

Result<void, std::string> ToolBox::grow(Direction side, std::int32_t steps) {
  const auto now = boxes_or_words();
  if (!now) return failure(now.error());
  if (std::abs(steps) > kStepsMax) return failure("the selection moves by at most 4096 voxels");
  if (selected_.voxels) {
    auto made = grown_selection(selected_, side, steps);
    if (!made) return failure(made.error());
    select(*std::move(made));
    return {};
  }
  // One box keeps one voxel.
  if (now->boxes().size() == 1)
    steps = std::max(steps, 1 - side_along(now->around(), axis_of(side)));
  auto made = steps > 0 ? now->grown(side, steps) : now->shrunk(side, -steps);
  if (!made) return failure(kTooManyParts);
  if (made->empty()) return failure("nothing would be left of the selection");
  select(*std::move(made));
  return {};
}

Result<void, std::string> ToolBox::grow_all(std::int32_t steps) {
  const Selected before = selected_;
  for (int side = 0; side < kDirectionCount; ++side) {
    const auto done = grow(static_cast<Direction>(side), steps);
    if (done) continue;
    select(before);
    return done;
  }
  return {};
}

Result<void, std::string> ToolBox::shift(Direction direction, std::int32_t steps) {
  const auto now = boxes_or_words();
  if (!now) return failure(now.error());
  if (std::abs(steps) > kStepsMax) return failure("the selection moves by at most 4096 voxels");
  if (selected_.voxels) {
    select(Selected::of(moved(*selected_.voxels, moved(VoxelPos{}, direction, steps))));
  } else {
    select(now->moved(direction, steps));
  }
  return {};
}

Result<void, std::string> ToolBox::copy(const Replica& replica, bool is_solid) {
  if (const auto now = boxes_or_words(); !now) return failure(now.error());
  auto copied = selected_build(replica);
  if (!copied) return failure(copied.error());
  if (is_solid && (*copied)->solid() == 0) return failure("the selection is empty");
  hold_voxels(*std::move(copied), empty_cells(is_solid));
  return {};
}

void ToolBox::keep_pasted(const Replica& replica, ToolEdits& made) {
  if (!made || made->empty() || tool().name() != "paste") return;
  pasted_ = PastedBuild::of(*made, clipboard_, replica);
  is_paste_fresh_ = pasted_.has_value();
  if (pasted_) made->chain = ActionChain::begins;
}

ToolEdits ToolBox::nudge(const Replica& replica, Direction direction) {
  if (!pasted_)
    return failure(
        "nothing that can be moved was just pasted (a paste of at most 262,144 voxels, not mirrored)");
  ++revision_;
  PastedBuild next = *pasted_;
  auto made = next.move(direction, replica);
  if (!made) return made;
  // As a build it would become an action of its own.
  if (!is_small(*made, replica.edit_limits()))
    return failure("the build is too large to be moved here");
  pasted_ = std::move(next);
  return made;
}

void ToolBox::hold_copied(ToolEdits& made) {
  if (!made) return;
  if (!made->chosen) {
    if (made->copied) hold_voxels(made->copied->build, made->copied->empty);
    return;
  }
  auto now = combined(selected_, *made->chosen, held_mode_.value_or(made->chosen_mode));
  if (now) {
    select(*std::move(now));
  } else {
    made = failure(now.error());
  }
}

void ToolBox::hold_voxels(BuildPtr build, EmptyCells empty) {
  take_rows(*build);
  hold_clipboard(std::move(build), empty);
  ++clipboard_changes_;
}

void ToolBox::take_rows(const Build& build) {
  clipboard_rows_.clear();
  for (const Material material : build.palette()) {
    clipboard_rows_.push_back(materials_.knows(material) ? row_of(materials_[material])
                                                         : MaterialRow{});
  }
}

std::string ToolBox::set_clipboard(BuildPtr build, EmptyCells empty,
                                   std::vector<MaterialRow> rows) {
  RUNSTONE_ASSERT(build && rows.size() == build->palette().size());
  clipboard_rows_ = std::move(rows);
  hold_clipboard(std::move(build), empty);
  ++clipboard_changes_;
  // Before a world is open there is only air. The names wait for its table.
  return materials_.size() > 1 ? fit_clipboard() : std::string();
}

void ToolBox::hold_clipboard(BuildPtr build, EmptyCells empty) {
  PasteLimits any_volume;
  any_volume.volume_max = UINT64_MAX;
  auto whole = whole_clipboard(*build, empty, any_volume);
  clipboard_ = {std::move(build), empty, std::move(whole)};
  mirrored_.forget();
  ++revision_;
}

ToolEdits ToolBox::cut(const Replica& replica, bool is_solid) {
  if (const auto copied = copy(replica, is_solid); !copied) return failure(copied.error());
  return fill(replica, kEmpty);
}

ToolEdits ToolBox::fill(const Replica& replica, Material material) const {
  return filled(replica, {}, material);
}

ToolEdits ToolBox::replace(const Replica& replica, Material from, Material to) const {
  return filled(replica, {MaskKind::only_material, from}, to);
}

ToolEdits ToolBox::filled(const Replica& replica, const Mask& mask, Material material) const {
  if (!replica.opened()) return failure("no world is open");
  const auto now = boxes_or_words();
  if (!now) return failure(now.error());
  if (selected_.voxels) {
    const bool is_one = mask.kind == MaskKind::only_material;
    return refilled(replica, *selected_.voxels,
                    is_one ? std::optional(mask.material) : std::nullopt, material);
  }
  std::vector<EditDescriptor> edits;
  for (const VoxelBox& box : now->boxes()) edits.push_back({FillBox{box}, mask, material});
  if (edits.size() > 1) return edits;
  ShownVoxels shown(replica);
  return joined_box(edits.front(), materials_, [&](VoxelPos at) { return shown.at(at); });
}

ToolEdits ToolBox::stack(const Replica& replica, Direction direction, std::int32_t times) const {
  const auto now = boxes_or_words();
  if (!now) return failure(now.error());
  if (times < 1 || times > kStackMax)
    return failure("a stack has 1 to " + std::to_string(kStackMax) + " copies");
  const auto copied = selected_build(replica);
  if (!copied) return failure(copied.error());
  const VoxelBox box = now->around();
  const std::int32_t side = side_along(box, axis_of(direction));
  // The first copy lies beside the selection; the selection itself is not pasted.
  const VoxelPos step = moved(VoxelPos{}, direction, side);
  BuildPtr copies = *copied;
  VoxelPos corner;
  if (times > 1) {
    auto made = stacked(*copies, step, times - 1);
    if (!made) return failure("cannot stack: " + words_of(made.error()));
    corner = stack_corner(step, times - 1);
    copies = *std::move(made);
  }
  const VoxelPos first = moved(box.min, direction, side);
  const VoxelPos at{first.x + corner.x, first.y + corner.y, first.z + corner.z};
  if (!is_in_world(at, copies->sides())) return failure("the stack reaches outside the world");
  return paste_of_build({std::move(copies), at, {}, EmptyCells::pasted}, replica.edit_limits());
}

ToolEdits ToolBox::move(const Replica& replica, Direction direction, std::int32_t steps) {
  const auto now = boxes_or_words();
  if (!now) return failure(now.error());
  if (std::abs(steps) > kStepsMax) return failure("the selection moves by at most 4096 voxels");
  if (steps == 0) return failure("the selection moves by one voxel or more");
  if (selected_.voxels) {
    if (!replica.opened()) return failure("no world is open");
    auto made = moved_voxels(replica, *selected_.voxels, direction, steps);
    if (made) select(Selected::of(moved(*selected_.voxels, moved(VoxelPos{}, direction, steps))));
    return made;
  }
  const BoxSet target = now->moved(direction, steps);
  if (!is_in_world(target.around().min, sides_of(target.around())))
    return failure("the selection would reach outside the world");
  const auto entered = BoxSet::without(target, *now);
  const auto staying = BoxSet::common(target, *now);
  const auto left = BoxSet::without(*now, target);
  if (!entered || !staying || !left) return failure(kTooManyParts);
  // The place that is left is cleared last: if an edit is refused, nothing is lost.
  ToolAction out;
  for (const auto& [parts, empty] :
       {std::pair{&*entered, EmptyCells::skipped}, std::pair{&*staying, EmptyCells::pasted}}) {
    for (const VoxelBox& part : parts->boxes()) {
      const auto copied = copy_box(replica, moved(part, direction, -steps));
      if (!copied) return cannot_copy(copied.error());
      if (empty == EmptyCells::skipped && (*copied)->solid() == 0) continue;  // nothing is in it
      ToolAction paste = paste_of_build({*copied, part.min, {}, empty}, replica.edit_limits());
      append(out.pastes, std::move(paste.pastes));
      append(out.edits, std::move(paste.edits));
    }
  }
  if (out.empty()) return failure("the selection is empty");
  for (const VoxelBox& part : left->boxes()) out.edits.push_back({FillBox{part}, {}, kEmpty});
  select(target);
  if (out.pastes.empty()) out.edits = merge_edits(std::move(out.edits));
  return out;
}

Result<void, std::string> ToolBox::rotate(int quarters) {
  return turn(Orientation{}.rotated_about_y(quarters));
}

Result<void, std::string> ToolBox::mirror(Axis axis) { return turn(Orientation{}.mirrored(axis)); }

Result<void, std::string> ToolBox::turn(const Orientation& orientation) {
  turn_notice_.clear();
  if (!clipboard_.build || orientation == Orientation{}) return {};
  auto made = turned(*clipboard_.build, orientation);
  if (made) made = with_turned_rows(*std::move(made), orientation);
  if (!made) return failure("cannot turn the clipboard: " + words_of(made.error()));
  hold_clipboard(*std::move(made), clipboard_.empty);
  ++clipboard_changes_;
  return {};
}

Result<void, std::string> ToolBox::reshape(const BuildRotation& rotation) {
  if (rotation.percent < kScaleMin || rotation.percent > kScaleMax)
    return failure("the scale must be from " + std::to_string(kScaleMin) + " to " +
                   std::to_string(kScaleMax) + " percent");
  if (rotation.percent == 100 && rotation.axis == Axis::y && rotation.degrees % 90 == 0)
    return rotate(rotation.degrees / 90);
  turn_notice_.clear();
  if (!clipboard_.build) return failure("nothing was copied");
  auto made = rotated_build(*clipboard_.build, rotation);
  if (!made) return failure("cannot turn the clipboard: " + std::string(made.error().what));
  // Cells may have been left out, and with them the last cell of a material.
  std::vector<MaterialRow> rows;
  for (const Material material : (*made)->palette())
    rows.push_back(clipboard_rows_[*clipboard_.build->number_of(material) - 1U]);
  clipboard_rows_ = std::move(rows);
  hold_clipboard(*std::move(made), clipboard_.empty);
  ++clipboard_changes_;
  return {};
}

Result<BuildPtr> ToolBox::with_turned_rows(BuildPtr build, const Orientation& orientation) {
  // The palette of a turned build has the same order, and so have the rows.
  if (materials_.size() == 1) {
    // No world is open: its table will have the names.
    const std::array<Axis, 3> along = {orientation.along(Axis::x), orientation.along(Axis::y),
                                       orientation.along(Axis::z)};
    std::size_t stuck = 0;
    for (MaterialRow& row : clipboard_rows_) {
      auto name = turned_material_name(row.name, along, orientation.flips);
      Shape shape = turned(row.shape, along, orientation.flips);
      // Name and shape turn together, as in a build of a file.
      if (!name || (!shape.is_cube() && !check_shape(shape))) {
        ++stuck;
        continue;
      }
      row.name = *std::move(name);
      row.shape = std::move(shape);
    }
    turn_notice_ = stuck_notice(stuck);
    return build;
  }
  const TurnedMaterials now = turned_materials(build->palette(), orientation, materials_);
  if (now.is_changed) {
    auto made = with_materials(*build, now.ids);
    if (!made) return failure(made.error());
    build = *std::move(made);
    take_rows(*build);
  }
  turn_notice_ = stuck_text(now.stuck);
  return build;
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
  return set_materials(materials, mesh_materials_of(materials));
}

std::string ToolBox::set_materials(const MaterialTable& materials, const MeshMaterialsPtr& meshed) {
  materials_ = materials;
  mirrored_.forget();
  pasted_.reset();
  preview_.set_materials(meshed);
  selected_preview_.set_materials(meshed);
  build_preview_.set_materials(meshed);
  tools_[chosen_]->forget_plan();  // the chunks may be those of another world
  points_.clear();
  typed_.reset();  // an open window gives its places again
  ++revision_;
  return fit_clipboard();
}

Material ToolBox::material_of_row(const MaterialRow& row) const {
  if (row.visibility == Visibility::empty) return kEmpty;
  if (const auto same = materials_.find(row.name)) return *same;
  if (const auto member = nearest_member(materials_, states_of_material(row.name))) return *member;
  return nearest_material(row, materials_);
}

std::string ToolBox::fit_clipboard() {
  if (!clipboard_.build) return {};
  std::vector<std::optional<Material>> palette;
  std::vector<MaterialRow> rows;
  std::string lacking;
  std::size_t lacking_count = 0;
  bool has_member = false;  // of the family of one that is lacking
  for (const MaterialRow& row : clipboard_rows_) {
    palette.push_back(material_of_row(row));
    if (materials_.find(row.name) || row.visibility == Visibility::empty) continue;
    has_member |= nearest_member(materials_, states_of_material(row.name)).has_value();
    if (++lacking_count <= kLackingListed) lacking += (lacking.empty() ? "" : ", ") + row.name;
  }
  auto made = with_materials(*clipboard_.build, palette);
  if (made) {
    for (const Material material : (*made)->palette()) rows.push_back(row_of(materials_[material]));
  }
  clipboard_rows_ = std::move(rows);
  const bool is_nothing =
      !made || (clipboard_.empty == EmptyCells::skipped && (*made)->solid() == 0);
  if (is_nothing) {
    clipboard_ = {};
    clipboard_rows_.clear();
  } else {
    hold_clipboard(*std::move(made), clipboard_.empty);
  }
  if (!made)
    return "the clipboard is lost: with the materials of this world it takes too much memory";
  if (lacking_count == 0) return {};
  if (lacking_count > kLackingListed)
    lacking += " and " + std::to_string(lacking_count - kLackingListed) + " more";
  return std::string(has_member ? "other states or " : "") +
         "the nearest colours take the place of materials that this world lacks: " + lacking;
}

bool ToolBox::step_preview(const Replica& replica, const Aim& aim, std::size_t chunks_max) {
  const ToolButton button = points_.empty() ? ToolButton::place : button_;
  const auto target = typed_ ? Result<VoxelPos, std::string>(VoxelPos{}) : target_of(aim, button);
  Previewed wanted{{}, {}, target ? *target : VoxelPos{}, kEmpty, aim.held, revision_};
  if (aim.hit && !typed_) {
    wanted.voxel = aim.hit->voxel;
    wanted.face = aim.hit->face;
    wanted.seen = aim.hit->material;
    // The look says how the voxel lies.
    if (chosen_ == 0 && button == ToolButton::place && aim.hit->face)
      wanted.held = placed_material(aim.held, click_of(aim), materials_);
  }
  const bool is_costly = is_preview_shown_ && target && tool().is_costly();
  if (previewed_ != wanted) {
    previewed_ = wanted;
    is_plan_due_ = true;
    rested_calls_ = 0;
    if (is_costly) {
      preview_refusal_.clear();
      show({}, replica.chunk_edge());
    }
  } else if (is_refusal_due(replica) || preview_.is_outdated(replica)) {
    is_plan_due_ = true;
  }
  const bool is_whole = chunks_max == std::numeric_limits<std::size_t>::max();
  if (is_plan_due_ && (!is_costly || is_whole || ++rested_calls_ > kRestCalls))
    plan_preview(replica, aim, button, target);
  step_pattern(is_whole);
  const bool has_edits_changed = preview_.step(replica, chunks_max);
  // A cube of 64 cells is as much work as several chunks.
  const bool has_builds_changed = build_preview_.step(std::max<std::size_t>(chunks_max / 8, 1));
  const bool has_selected_changed =
      selected_preview_.step(std::max<std::size_t>(chunks_max / 8, 1));
  if (!has_edits_changed && !has_builds_changed && !has_selected_changed) return false;
  ghosts_ = preview_.ghosts();
  ghosts_.insert(ghosts_.end(), build_preview_.ghosts().begin(), build_preview_.ghosts().end());
  for (GhostChunk ghost : selected_preview_.ghosts()) {
    ghost.tint = kSelectedColour;
    ghosts_.push_back(std::move(ghost));
  }
  return true;
}

void ToolBox::plan_preview(const Replica& replica, const Aim& aim, ToolButton button,
                           const Result<VoxelPos, std::string>& target) {
  is_plan_due_ = false;
  rested_calls_ = 0;
  planned_on_ = mark_of(replica);
  preview_refusal_.clear();
  ToolAction made;
  if (is_preview_shown_ && !tool().selects()) {
    auto planned = typed_   ? plan_typed(replica, aim.held)
                   : target ? plan(replica, aim, button, points_, *target)
                            : ToolEdits(failure(target.error()));
    if (planned) {
      made = *std::move(planned);
    } else {
      preview_refusal_ = planned.error();
    }
  }
  show(std::move(made), replica.chunk_edge());
}

bool ToolBox::is_refusal_due(const Replica& replica) {
  if (preview_refusal_.empty()) return false;
  ++refused_calls_;
  // A refusal may end without a change of what is watched, for example when a chunk arrives.
  if (!tool().is_costly()) return refused_calls_ % kPlanAgainCalls == 0;
  return refused_calls_ % kCostlyAgainCalls == 0 && planned_on_ != mark_of(replica);
}

ToolBox::ReplicaMark ToolBox::mark_of(const Replica& replica) {
  const ReplicaCounters& counters = replica.counters();
  return {counters.snapshots_taken, counters.adopted, counters.chunk_edits_applied,
          replica.confirmed_count(), replica.local_edits().bytes()};
}

void ToolBox::step_pattern(bool is_whole) {
  const auto made = pattern_.step(mirrored_, is_whole);
  if (!made) return;
  if (made->empty() && !pattern_.is_too_large())
    preview_refusal_ = "the pattern changes no voxel there";
  std::vector<ShownBuild> builds;
  for (const BuildPaste& paste : *made)
    builds.push_back({paste.build, paste.at, false, paste.is_difference});
  build_preview_.set(std::move(builds));
}

void ToolBox::show(ToolAction made, std::int32_t chunk_edge) {
  pattern_.set(std::move(made.pattern));
  std::vector<ShownBuild> builds;
  for (const BuildPaste& paste : made.pastes)
    builds.push_back({paste.build, paste.at, false, paste.is_difference});
  // Voxels that are only copied are shown where they are.
  previews_copy_ = made.copied && made.empty();
  previewed_choice_ = made.chosen ? std::optional(made.chosen_mode) : std::nullopt;
  if (previews_copy_) builds.push_back({made.copied->build, made.copied->at});
  // A box of more chunks than a preview compares is drawn as a build of its material.
  std::erase_if(made.edits, [&](const EditDescriptor& edit) {
    const auto* const fill = std::get_if<FillBox>(&edit.shape);
    if (fill == nullptr || chunks_of(fill->box, chunk_edge) <= EditPreview::kChunksMax)
      return false;
    const bool is_removed = edit.material == kEmpty;
    if (auto build = block_of(fill->box, is_removed ? Material{1} : edit.material))
      builds.push_back({std::move(build), fill->box.min, is_removed});
    return true;
  });
  preview_.set(std::move(made.edits));
  build_preview_.set(std::move(builds));
}

}  // namespace runstone
