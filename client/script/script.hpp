// Script: a list of commands for a client. docs/client.md describes the language. A script is
// parsed before the client connects, so that a mistake is reported at once. ScriptRunner runs it.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"
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
enum class Until : std::uint8_t { loaded, durable, synced };
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
struct Quit {};

using Step = std::variant<Move, Walk, Roam, Look, LookAt, Set, Box, Sphere, Stroke, Copy, Paste,
                          Dig, Place, Wait, WaitUntil, Screenshot, Expect, Repeat, End, Burst,
                          Digests, HistoryRequest, Say, WaitChat, Command, Quit>;

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
