// ToolBox: the tools of a player and the state that they share: the chosen tool, the places chosen
// so far, the selection, the clipboard, the symmetry and the preview. It answers clicks with edits,
// which the caller proposes in the given order. Pure: no clock, socket, window or OpenGL. One
// thread.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/tools/box_set.hpp"
#include "client/tools/build_preview.hpp"
#include "client/tools/building_tools.hpp"
#include "client/tools/edit_preview.hpp"
#include "client/tools/pasted_build.hpp"
#include "client/tools/pattern_preview.hpp"
#include "client/tools/selected_voxels.hpp"
#include "client/tools/symmetry.hpp"
#include "client/tools/tool.hpp"
#include "common/builds/rotated_build.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

class ToolBox {
 public:
  ToolBox() : tools_(make_tools()) {}

  std::span<const std::unique_ptr<Tool>> tools() const { return tools_; }
  const Tool& tool() const { return *tools_[chosen_]; }
  /// Chooses a tool by its name, and forgets the places chosen so far. Fails with words for the
  /// player if there is none of that name.
  Result<void, std::string> choose(std::string_view name);
  /// Sets a parameter of the chosen tool. Fails as Tool::set() does.
  Result<void, std::string> set_parameter(std::string_view name, std::int32_t value);
  /// Sets a text of the chosen tool. Fails as Tool::set_text() does.
  Result<void, std::string> set_text(std::string_view name, std::string text);
  /// Changes the first parameter of the chosen tool by `steps`, within its range.
  void change_size(std::int32_t steps);

  /// Takes the press of a button. Returns the edits to propose, which are none while places are
  /// being chosen. If the first place was chosen with the other button, forgets the places instead.
  /// Fails with words for the player. Requires an open replica.
  ToolEdits press(const Replica& replica, const Aim& aim, ToolButton button);
  /// Takes the aim while the button is held. Only tools that are drawn use it.
  void drag(const Aim& aim);
  /// Takes the release of the button, which completes an action of a tool that is drawn.
  ToolEdits release(const Replica& replica, const Aim& aim);
  /// Forgets the places chosen so far. Returns false if there were none.
  bool cancel();
  std::span<const VoxelPos> points() const { return points_; }
  /// Returns the button that chose the first of points().
  ToolButton button() const { return button_; }

  /// Returns the box between the first place chosen and the voxel that the next click chooses, or
  /// nullopt if no place is chosen, or if the tool works on no box between two places.
  std::optional<VoxelBox> spanned(const Aim& aim) const;

  /// Returns the stroke of the brush that the next click, or the release of the button, would make,
  /// or nullopt if the tool is no such brush, the click chooses no voxel, places are typed or a
  /// symmetry makes copies.
  std::optional<BrushStroke> next_stroke(const Aim& aim) const;

  /// Sets places by their coordinates, wherever the player looks. The preview then shows what
  /// apply_typed() does. With nullopt, clicks choose places again. Requires coordinates inside the
  /// world.
  void type_places(std::optional<TypedPlaces> typed);
  const std::optional<TypedPlaces>& typed_places() const { return typed_; }
  /// Returns how many places apply_typed() takes with the chosen tool, at least and at most.
  std::array<std::size_t, 2> typed_count() const;
  /// Returns the edits of the typed places, as if each had been chosen by a click; a tool that
  /// selects selects them. Fails with words for the player if no places are typed, or if there are
  /// too few or too many. Requires an open replica.
  ToolEdits apply_typed(const Replica& replica, Material held);

  /// Returns the smallest box around the selected voxels, or nullopt if there are none.
  const std::optional<VoxelBox>& selection() const { return selection_; }
  /// Returns the selection if it is one box.
  std::optional<VoxelBox> selected_box() const {
    const bool is_box = selected_.boxes.boxes().size() == 1 && !selected_.voxels;
    return is_box ? selection_ : std::nullopt;
  }
  /// Returns the selected voxels.
  const Selected& selected() const { return selected_; }
  /// Returns the boxes of the selection, or the box around the voxels if it is a set of voxels.
  const BoxSet& selected_boxes() const { return selected_.boxes; }
  /// Selects a box; nullopt selects nothing. An empty box counts as nothing.
  void select(std::optional<VoxelBox> box);
  /// Selects these voxels.
  void select(BoxSet boxes);
  void select(Selected selected);
  /// Selects a box, adds it to the selection or removes it from there. Fails with words for the
  /// player if the selection would have too many parts or voxels.
  Result<void, std::string> select(const VoxelBox& box, SelectMode mode);
  /// Keeps the selected voxels for which a typed filter holds, or does not hold if `is_kept` is
  /// false. Fails as filtered() does. Requires an open replica.
  Result<void, std::string> narrow(const Replica& replica, const std::string& filter, bool is_kept);
  /// Sets the mode that a held key gives; nullopt: the mode of the chosen tool counts.
  void hold_select_mode(std::optional<SelectMode> mode) { held_mode_ = mode; }
  /// Moves the side of the selection that faces `side` by `steps` voxels outward. A negative number
  /// shrinks the selection; a selection of one box keeps one voxel. Fails if nothing is selected or
  /// nothing would be left, and as select() does.
  Result<void, std::string> grow(Direction side, std::int32_t steps);
  /// Moves all sides of the selection outward, or inward with a negative number. Fails as grow() does.
  Result<void, std::string> grow_all(std::int32_t steps);
  /// Moves the selected boxes, not their voxels.
  Result<void, std::string> shift(Direction direction, std::int32_t steps);

  /// Copies the selected voxels, of a box of any size. With `is_solid`, a paste changes no voxel where
  /// the copy is empty. Fails with words for the player, as do the functions below.
  Result<void, std::string> copy(const Replica& replica, bool is_solid);
  /// Copies the selected voxels and returns the edit that clears them.
  ToolEdits cut(const Replica& replica, bool is_solid);
  /// Returns the edit that fills the selection, or clears it with kEmpty. Fences and the like in a
  /// thin selection join (joined_box()).
  ToolEdits fill(const Replica& replica, Material material) const;
  /// Returns the edit that replaces a material in the selection, with joins as fill().
  ToolEdits replace(const Replica& replica, Material from, Material to) const;
  /// Returns the paste that repeats the selected voxels `times` times in a direction.
  ToolEdits stack(const Replica& replica, Direction direction, std::int32_t times) const;
  /// Returns the edits that move the selected voxels, and moves the selection. Solid voxels move
  /// and leave empty ones behind.
  ToolEdits move(const Replica& replica, Direction direction, std::int32_t steps);

  /// Returns the edit that moves the build that was just pasted by one voxel, as a part of the action
  /// that pasted it. Fails with words for the player if there is none. Requires an open replica.
  ToolEdits nudge(const Replica& replica, Direction direction);
  /// Call it when an action begins. If it is not the action of the last paste, that paste cannot be
  /// moved any more.
  void begin_action() {
    if (!std::exchange(is_paste_fresh_, false)) pasted_.reset();
  }
  /// Call it when an edit was refused or an action was taken back: the last paste, or a step of it,
  /// may not be in the world, so it cannot be moved any more.
  void forget_pasted() {
    pasted_.reset();
    is_paste_fresh_ = false;
  }

  const ToolClipboard& clipboard() const { return clipboard_; }
  /// Returns the rows of the materials of the clipboard, by palette entry, as the world from which they
  /// were copied has them.
  std::span<const MaterialRow> clipboard_rows() const { return clipboard_rows_; }
  /// Returns a number that rises when the player copies something, turns the clipboard or takes another
  /// one from a file or a library.
  std::uint64_t clipboard_changes() const { return clipboard_changes_; }
  /// Sets the clipboard to a build of another world or of a file: `rows` are the materials of its
  /// palette. Its materials are found by their names; returns what set_materials() returns. Before
  /// set_materials() they are found when it is called. Requires one row for each palette entry.
  std::string set_clipboard(BuildPtr build, EmptyCells empty, std::vector<MaterialRow> rows);
  /// Turns the clipboard by quarter turns about the vertical axis, with its materials
  /// (turned_materials.hpp).
  Result<void, std::string> rotate(int quarters);
  /// Mirrors the clipboard along an axis of the world, with its materials.
  Result<void, std::string> mirror(Axis axis);
  /// Turns the clipboard about an axis by any angle and scales it, by the nearest voxel
  /// (common/builds/rotated_build.hpp). Its materials turn only with quarter turns about y.
  Result<void, std::string> reshape(const BuildRotation& rotation);
  /// Returns what the last rotate() or mirror() could not do, as a sentence for the player, or an
  /// empty text.
  const std::string& turn_notice() const { return turn_notice_; }

  const Symmetry& symmetry() const { return symmetry_; }
  /// Sets the symmetry. It applies to the edits of tools, not to those of the selection.
  void set_symmetry(const Symmetry& symmetry);

  /// Takes the materials of the world. The clipboard of another world gets the ids that materials
  /// of the same names have in this world. Other members of their families, and otherwise those
  /// with the nearest colours, take the place of materials that the world lacks; the returned text
  /// names these, and is empty if there are none.
  std::string set_materials(const MaterialTable& materials);
  /// Does so with what previews read of the materials: `meshed` is mesh_materials_of() them.
  std::string set_materials(const MaterialTable& materials, const MeshMaterialsPtr& meshed);
  const MaterialTable& materials() const { return materials_; }

  void show_preview(bool is_shown);
  bool is_preview_shown() const { return is_preview_shown_; }
  /// Makes the preview of the next click: at most `chunks_max` chunks in this call. Returns true if
  /// the ghosts changed. Requires an open replica. Cost: that of the chosen tool's plan, if the
  /// aim, the tool or the chunks changed, EditPreview::step(), and a step of a pattern that is too
  /// large to be worked out at once (all of it if chunks_max is the largest number). The plan of a
  /// costly tool (Tool::is_costly()) is made once the aim has been the same for more than
  /// kRestCalls calls, or if chunks_max is the largest number, and not again while it is refused
  /// and the replica is as it was.
  bool step_preview(const Replica& replica, const Aim& aim, std::size_t chunks_max);
  static constexpr unsigned kRestCalls = 16;
  /// Returns the preview of the edits, and that of the builds that are too large for one edit.
  const EditPreview& preview() const { return preview_; }
  const BuildPreview& build_preview() const { return build_preview_; }
  /// Returns true if the preview of the next click shows all of it.
  bool is_preview_complete() const {
    return !is_plan_due_ && preview_.is_complete() && build_preview_.is_complete() &&
           !pattern_.is_under_way();
  }
  /// Returns true if the next click makes more than a preview can show. It is not refused.
  bool is_preview_too_large() const { return pattern_.is_too_large(); }
  /// Returns the ghosts of both.
  const std::vector<GhostChunk>& ghosts() const { return ghosts_; }
  /// Returns true if the preview shows voxels that the next click only copies.
  bool previews_copy() const { return previews_copy_; }
  /// Returns what the next click does with the selection, if the preview shows voxels that it
  /// selects or deselects.
  std::optional<SelectMode> previewed_choice() const {
    return previewed_choice_ ? std::optional(held_mode_.value_or(*previewed_choice_))
                             : std::nullopt;
  }
  /// Returns why the next click would be refused, or an empty text.
  const std::string& preview_refusal() const { return preview_refusal_; }

 private:
  /// Returns the voxel that a click chooses. Fails with words for the player.
  Result<VoxelPos, std::string> target_of(const Aim& aim, ToolButton button) const;
  ToolEdits plan(const Replica& replica, const Aim& aim, ToolButton button,
                 std::span<const VoxelPos> points, VoxelPos target);
  ToolEdits plan_typed(const Replica& replica, Material held);
  /// Returns the boxes of the selection. Fails with words for the player if there is none.
  Result<BoxSet, std::string> boxes_or_words() const;
  /// Returns the selected voxels, with the empty ones, as a build whose corner is that of
  /// selection(). Its other cells are untouched. Fails with words for the player.
  Result<BuildPtr, std::string> selected_build(const Replica& replica) const;
  ToolEdits filled(const Replica& replica, const Mask& mask, Material material) const;
  Result<void, std::string> turn(const Orientation& orientation);
  /// Keeps what the paste tool is about to put down, and lets the action go on.
  void keep_pasted(const Replica& replica, ToolEdits& made);
  /// Puts the voxels that an action copies into the clipboard, or selects the voxels that it
  /// chooses.
  void hold_copied(ToolEdits& made);
  /// Sets clipboard_rows_ to the rows that the materials of a build have in this world.
  void take_rows(const Build& build);
  /// Sets the clipboard to voxels of this world.
  void hold_voxels(BuildPtr build, EmptyCells empty);
  /// Sets the clipboard, whose rows are set already.
  void hold_clipboard(BuildPtr build, EmptyCells empty);
  /// Gives a build that was turned its materials, and sets clipboard_rows_ and turn_notice_.
  Result<BuildPtr> with_turned_rows(BuildPtr build, const Orientation& orientation);
  /// Returns the material of this world for a row of another one.
  Material material_of_row(const MaterialRow& row) const;
  /// Gives the clipboard the materials of this world, by the names in its rows.
  std::string fit_clipboard();
  void show(ToolAction made, std::int32_t chunk_edge);
  /// Goes on with the preview of a pattern, and shows its builds when they are made.
  void step_pattern(bool is_whole);
  /// Plans the next click, and shows what it makes or keeps why it would be refused.
  void plan_preview(const Replica& replica, const Aim& aim, ToolButton button,
                    const Result<VoxelPos, std::string>& target);
  /// Returns true if a refusal stands that is to be planned again in this call of step_preview().
  bool is_refusal_due(const Replica& replica);

  /// The facts on which the present preview depends, besides the chunks.
  struct Previewed {
    std::optional<VoxelPos> voxel;
    std::optional<Direction> face;
    VoxelPos target;
    Material seen = kEmpty, held = kEmpty;
    std::uint64_t revision = 0;
    friend bool operator==(const Previewed&, const Previewed&) = default;
  };

  /// The numbers of a replica that change with its shown voxels.
  struct ReplicaMark {
    std::uint64_t snapshots = 0, adopted = 0, edits = 0;
    std::size_t chunks = 0, local_bytes = 0;
    friend bool operator==(const ReplicaMark&, const ReplicaMark&) = default;
  };
  static ReplicaMark mark_of(const Replica& replica);

  std::vector<std::unique_ptr<Tool>> tools_;
  std::size_t chosen_ = 0;
  std::vector<VoxelPos> points_;
  ToolButton button_ = ToolButton::place;  // of the first point
  std::optional<TypedPlaces> typed_;
  Selected selected_;
  std::optional<VoxelBox> selection_;  // around selected_
  std::optional<SelectMode> held_mode_;
  ToolClipboard clipboard_;
  std::optional<PastedBuild> pasted_;        // may be moved by nudge()
  bool is_paste_fresh_ = false;              // its action has not begun yet
  std::vector<MaterialRow> clipboard_rows_;  // by palette entry of the clipboard
  std::uint64_t clipboard_changes_ = 0;
  std::string turn_notice_;
  Symmetry symmetry_;
  MirroredBuilds mirrored_;
  MaterialTable materials_;
  EditPreview preview_;
  BuildPreview build_preview_;
  BuildPreview selected_preview_;  // of the selected voxels that are no boxes
  PatternPreview pattern_;
  std::vector<GhostChunk> ghosts_;
  bool previews_copy_ = false;
  std::optional<SelectMode> previewed_choice_;  // without a held key
  std::string preview_refusal_;
  unsigned refused_calls_ = 0;  // of step_preview() with a refusal
  ReplicaMark planned_on_;      // the replica when the preview was last planned
  std::optional<Previewed> previewed_;
  bool is_plan_due_ = false;    // the preview of previewed_ is not planned yet, or outdated
  unsigned rested_calls_ = 0;   // of step_preview() while a plan is due
  std::uint64_t revision_ = 0;  // rises when the state behind the preview changes
  bool is_preview_shown_ = true;
};

}  // namespace runstone
