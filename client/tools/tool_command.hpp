// ToolCommand: something that a player does with the tools besides clicking. Keys, the tool window
// and scripts give the same commands, and carry_out() carries them out. One thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "client/tools/tool_box.hpp"

namespace runstone {

struct ToolChoice {
  std::string name;
};
/// Sets a parameter of the chosen tool.
struct ParameterChange {
  std::string name;
  std::int32_t value = 0;
};
/// Sets a text of the chosen tool.
struct TextChange {
  std::string name, text;
};
/// Sets the places of the chosen tool by their coordinates. With nullopt, clicks choose places
/// again.
struct PlacesChange {
  std::optional<TypedPlaces> typed;
};
/// Makes the edits of the typed places.
struct TypedApply {};
/// Selects a box, adds it to the selection or removes it from there; nullopt selects nothing.
struct SelectionChange {
  std::optional<VoxelBox> box;
  SelectMode mode = SelectMode::fresh;
};
/// Changes the selection, or the voxels in it.
struct SelectionCommand {
  enum class Kind : std::uint8_t {
    copy,
    cut,
    clear,
    fill,
    replace,
    stack,
    move,
    grow,
    shift,
    keep,  // only the voxels for which a filter holds stay selected
    drop,  // they are not selected any more
  };
  Kind kind = Kind::copy;
  bool is_solid = false;                   // copy, cut: a paste skips the empty voxels
  Material material = kEmpty;              // fill: the new one; replace: the old one
  Material other = kEmpty;                 // replace: the new one
  Direction direction = Direction::pos_y;  // stack, move, grow, shift
  bool is_all_around = false;              // grow: all sides move
  std::int32_t count = 1;                  // stack, move, grow, shift
  std::string filter = {};                 // keep, drop
};
/// Moves the build that was just pasted by one voxel.
struct PasteNudge {
  Direction direction = Direction::pos_y;
};
/// Turns the clipboard by quarter turns, and then mirrors it.
struct ClipboardTurn {
  int quarters = 0;
  std::optional<Axis> mirror;
};
/// Turns the clipboard by any angle and scales it.
struct ClipboardReshape {
  BuildRotation rotation;
};
struct SymmetryChange {
  Symmetry symmetry;
};
struct PreviewChange {
  bool is_shown = true;
};

using ToolCommand = std::variant<ToolChoice, ParameterChange, TextChange, PlacesChange, TypedApply,
                                 SelectionChange, SelectionCommand, PasteNudge, ClipboardTurn,
                                 ClipboardReshape, SymmetryChange, PreviewChange>;

/// Carries out a command. Returns the edits to propose, which may be none. Fails with words for the
/// player, for example if there is no world yet. `held` is the material in the hand.
ToolEdits carry_out(ToolBox& box, const Replica& replica, Material held,
                    const ToolCommand& command);

}  // namespace runstone
