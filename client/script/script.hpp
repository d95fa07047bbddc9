// Script: a list of commands for a client. docs/client.md describes the language. A script is
// parsed before the client connects, so that a mistake is reported at once. ScriptRunner runs it.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "client/render/frame_look.hpp"
#include "client/render/inspection.hpp"
#include "client/tools/aim.hpp"
#include "client/tools/tool_command.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"
#include "common/models/model_choices.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// A coordinate: `7` is absolute, `~` and `~-2` are relative to the player, and `^` and `^+1` are
/// relative to the highest shown solid voxel of the column. The last form is for y only.
struct ScriptCoordinate {
  enum class Base : std::uint8_t { world, player, surface };
  Base base = Base::world;
  double offset = 0;
};
using ScriptPosition = std::array<ScriptCoordinate, 3>;

struct ScriptMask {
  MaskKind kind = MaskKind::everything;
  std::string material;  // name or number, for only_material
};

namespace script {

struct Move {
  ScriptPosition to;
};
struct Walk {
  ScriptPosition to;
  double speed = 1;  // voxels a second
};
/// Moves to and fro between the player's place and `to` while later commands run, until the next
/// Move, Walk or Roam.
struct Roam {
  ScriptPosition to;
  double speed = 1;  // voxels a second
};
struct Look {
  double yaw = 0, pitch = 0;  // degrees
};
/// Sets the time of day of the picture.
struct TimeOfDay {
  double share = 0;  // of the day: 0 midnight, 0.5 noon
};
/// Sets how the edges of the picture are smoothed.
struct SmoothEdges {
  Antialiasing antialiasing = Antialiasing::automatic;
};
struct LookAt {
  ScriptPosition at;
};
struct Set {
  ScriptPosition at;
  std::string material;
};
struct Box {
  ScriptPosition from, to;  // corner voxels, both included
  std::string material;
  ScriptMask mask;
};
struct Sphere {
  ScriptPosition centre;
  std::uint16_t radius = 0;
  std::string material;
  ScriptMask mask;
};
struct Stroke {
  std::uint16_t radius = 1;
  std::string material;
  std::vector<ScriptPosition> points;  // two or more
  ScriptMask mask;
};
struct Copy {
  std::string name;
  ScriptPosition from, to;  // corner voxels, both included
  bool solid = false;       // true: a paste leaves the voxels alone where the copy is empty
};
struct Paste {
  std::string name;
  ScriptPosition at;  // smallest corner of the clipboard after `orientation` is applied
  Orientation orientation;
  ScriptMask mask;
};
struct Dig {};
struct Place {
  std::string material;
};
struct Wait {
  double seconds = 0;
};
enum class Until : std::uint8_t { loaded, horizon, durable, synced };
struct WaitUntil {
  Until what = Until::loaded;
  double seconds_max = 0;
};
struct Screenshot {
  std::string file;
};
struct Expect {
  ScriptPosition at;
  std::string material;
};
struct Repeat {
  std::uint32_t times = 0;
  std::size_t end = 0;  // index of its End
};
struct End {
  std::size_t repeat = 0;  // index of its Repeat
};
/// A burst is open loop: edit i is due i / rate seconds after the start, whatever happened to the
/// earlier edits.
struct Burst {
  std::uint32_t count = 0;
  double rate = 1;
  std::int32_t radius = 0;
  std::uint64_t seed = 0;
  std::string material;
};
struct Digests {
  std::string file;
};
struct HistoryRequest {
  HistoryTarget to = HistoryTarget::live;
  Sequence seq = 0;        // for HistoryTarget::sequence
  double seconds_ago = 0;  // for HistoryTarget::time
};
/// A line of chat.
struct Say {
  std::string text;
};
/// Waits for a line of chat that contains the text.
struct WaitChat {
  double seconds_max = 0;
  std::string text;
};
/// A command for the server, such as undo.
struct Command {
  std::string text;
};
/// Presses a key chord, such as F1 or ctrl+Z, and releases it.
struct PressKey {
  std::string chord;  // as parse_key_chord() reads it
};
/// Types characters.
struct Type {
  std::string text;  // UTF-8
};
/// Clicks with the mouse at a place of the frame, in pixels from its upper left corner.
struct Click {
  double x = 0, y = 0;
};
/// Shows or hides the user interface in the frames, and so in the screenshots.
struct ShowInterface {
  bool is_shown = true;
};
/// Shows or hides a mode of inspection.
struct Inspect {
  InspectionMode mode{};
  bool is_on = true;
};
/// Shows or hides the map from above.
struct ShowMap {
  bool is_shown = true;
  bool is_full = false;  // in all of the frame
};
/// Sets the pixels of the map for each voxel.
struct ZoomMap {
  double pixels = 1;
};
struct ShowTimeline {
  bool is_shown = true;
};
/// A command of the rollback window.
struct Rollback {
  enum class Kind : std::uint8_t { preview, apply, undo, forget };
  Kind kind = Kind::preview;
  std::string filters;  // of a preview, as the server reads them
};
/// Shows or hides the window of the library of builds.
struct ShowLibrary {
  bool is_shown = true;
};
/// Lists the builds of the library whose names have a part.
struct ListBuilds {
  std::string name;  // empty: all
};
/// Puts a build of the library into the clipboard of the tools.
struct TakeBuild {
  Sequence number = 0;
};
/// Adds the clipboard of the tools to the library.
struct AddBuild {
  std::string name;
};
/// Chooses a building tool by its name.
struct ChooseTool {
  std::string name;
};
/// Sets a parameter of the chosen tool.
struct SetParameter {
  std::string name, value;  // the value is a number or one of the parameter's choices
};
/// Aims at a face of a voxel until the next AimAt.
struct AimAt {
  std::optional<ScriptPosition> voxel;  // nullopt: where the player looks
  Direction face = Direction::pos_y;
};
/// Puts a material into the player's hand.
struct Hold {
  std::string material;
};
/// Keeps the slots of the hotbar under a name, takes those of a name, or forgets them.
struct NamedHotbar {
  enum class What : std::uint8_t { keep, take, forget };
  What what = What::take;
  std::string name;
};
/// A mouse button with the chosen tool.
struct UseTool {
  enum class Part : std::uint8_t { click, press, drag, release };
  Part part = Part::click;
  ToolButton button = ToolButton::place;  // not for drag and release
};
/// Selects a box by two corner voxels, both included, adds it to the selection or removes it from
/// there.
struct Select {
  SelectMode mode = SelectMode::fresh;
  std::optional<ScriptPosition> from, to;  // nullopt: selects nothing
};
/// Changes the selection, or the voxels in it.
struct SelectionEdit {
  SelectionCommand command;     // its materials are not set
  std::string material, other;  // the names for `command`; empty: none
};
struct SetSymmetry {
  SymmetryKind kind = SymmetryKind::none;
  ScriptPosition centre;  // its y does not count
};
/// Gives the places of the chosen tool by their numbers.
struct TypePlaces {
  std::vector<ScriptPosition> places;  // none: by clicks again
  ToolButton button = ToolButton::place;
  Direction face = Direction::pos_y;
};
/// A command of the tools in which there is nothing to resolve.
struct RunToolCommand {
  ToolCommand command;
};
/// Reads the clipboard of the tools from a file of any format (docs/formats.md), or writes it to one.
struct FileOfClipboard {
  bool is_written = false;
  std::string file;
  ModelChoices model = {};  // of a file with a model that is read
};
struct Quit {};

using Step =
    std::variant<Move, Walk, Roam, Look, TimeOfDay, SmoothEdges, LookAt, Set, Box, Sphere, Stroke,
                 Copy, Paste, Dig, Place, Wait, WaitUntil, Screenshot, Expect, Repeat, End, Burst,
                 Digests, HistoryRequest, Say, WaitChat, Command, PressKey, Type, Click,
                 ShowInterface, Inspect, ShowMap, ZoomMap, ShowTimeline, Rollback, ShowLibrary,
                 ListBuilds, TakeBuild, AddBuild, ChooseTool, SetParameter, AimAt, Hold,
                 NamedHotbar, UseTool, Select, SelectionEdit, SetSymmetry, TypePlaces,
                 RunToolCommand, FileOfClipboard, Quit>;

}  // namespace script

struct ScriptCommand {
  std::uint32_t line = 0;  // from 1
  script::Step step;
};

struct Script {
  std::string file;  // for error messages
  std::vector<ScriptCommand> commands;
};

/// The default time limit of commands that wait for a state.
inline constexpr double kScriptWaitSecondsMax = 120;

/// Parses a script. Fails with the first wrong line. Names of materials are not checked, because
/// only the world knows them. `file` is for error messages.
Result<Script, TextError> parse_script(std::string_view text, std::string_view file);

}  // namespace runstone
