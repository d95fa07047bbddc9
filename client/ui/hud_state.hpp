// HudState: the contents of the heads-up display in one frame. It is plain data that the client
// fills for each frame; texts are ready to be drawn.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/input/action.hpp"
#include "client/render/inspection.hpp"
#include "client/tools/tool_box.hpp"
#include "client/ui/library_window.hpp"
#include "client/ui/map_window.hpp"
#include "client/ui/rollback_window.hpp"
#include "client/ui/statistics_window.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"
#include "protocol/codec/log_mark_messages.hpp"

namespace runstone {

/// A player in the list. The first one is this client's.
struct ListedPlayer {
  std::string name, fingerprint;
  std::string role;           // empty if the server did not name it
  std::string distance = {};  // such as "120 voxels", or empty
};

/// A name over the head of another player.
struct NamePlate {
  std::string name;
  double x = 0, y = 0;  // pixels; the plate stands above this point
  double distance = 0;  // voxels
  double alpha = 1;     // 0 .. 1
};

/// The state of the timeline. Its marks are filled only while the timeline is shown.
struct TimelineState {
  Sequence newest = 0;  // of the live world, at most kSequenceShownMax
  Sequence shown = 0;   // equal to `newest` in the live world
  bool is_past = false;
  bool is_loading = false;
  std::string moment;                // the shown moment in words, for example its time in UTC
  std::vector<LogMark> band = {};    // over all of the log, ascending by seq
  std::vector<LogMark> recent = {};  // that end at the shown moment, ascending by seq
  std::map<AuthorId, std::string> authors = {};  // names of those of the marks
  std::string refusal = {};                      // why there will be no marks, or empty

  /// Returns the name of an author, or "#N" if it is not known.
  std::string name_of(AuthorId author) const {
    const auto found = authors.find(author);
    return found == authors.end() ? "#" + std::to_string(author) : found->second;
  }
};

/// The file of the clipboard that is being read or written.
struct FileState {
  std::string text;             // such as "reading castle.schem"; empty: no file is under way
  std::optional<double> share;  // of the work that is done, 0 .. 1; unset if nobody knows
  bool can_stop = false;        // the file is read, and the user has not stopped it
};

struct HudState {
  const MaterialTable* materials = nullptr;  // not null; it must outlive the call
  std::array<Material, kSlotCount> slots{};
  std::size_t slot = 0;              // the chosen one
  std::vector<Material> recent;      // used last, newest first
  std::vector<std::string> hotbars;  // names of those that the player has kept, ascending
  bool is_captured = false;          // the mouse moves the player
  bool is_connected = false;
  std::optional<double> ping_ms;     // the shortest of the last ones; nullopt: not known
  std::string place;                 // position, and how the player moves
  std::optional<Material> aimed_at;  // the voxel in sight
  std::string state;                 // for example that the past is shown; empty: nothing special
  std::optional<VoxelPos> sight;     // its place
  std::string author;                // who set it, and when; empty: not known
  std::string tool;                  // the chosen tool and its numbers; empty: the plain voxel tool
  std::string measure;               // size and corners of the box that is dragged; empty: none
  const ToolBox* tools = nullptr;    // not null while the tool window is open
  bool has_preview = false;          // `tools` has the preview of the next click
  double time_of_day = 0.4;          // that frames show, as FrameLook::time_of_day
  bool has_own_time = false;         // the player has chosen it
  bool has_files = false;            // the clipboard can be read from files, and written to them
  FileState file;
  bool shows_players = false;
  std::vector<ListedPlayer> players;
  std::vector<std::string> names;  // of the other players, for completion
  std::vector<NamePlate> plates;
  TimelineState timeline;
  InspectionModes inspection;
  MapState map;
  RollbackState rollback;
  LibraryState library;
  StatisticsState statistics;  // filled only while Hud::shows_statistics()
};

}  // namespace runstone
