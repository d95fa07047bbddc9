// UiAction: what the user did in a window of the interface. The client carries it out.
#pragma once
#include <cstdint>
#include <string>
#include <variant>

#include "client/render/inspection.hpp"
#include "client/tools/tool_command.hpp"
#include "client/ui/library_window.hpp"
#include "client/ui/rollback_window.hpp"
#include "client/ui/time_panel.hpp"
#include "common/core/ids.hpp"
#include "common/models/model_choices.hpp"

namespace runstone {

/// A line was typed. One that begins with a slash is a command for the server.
struct SendLine {
  std::string text;
};
/// A material was chosen for the chosen slot.
struct HoldMaterial {
  Material material = 0;
};
/// The user keeps the slots under a name, takes those of a name, or forgets them.
struct HotbarOrder {
  enum class What : std::uint8_t { keep, take, forget };
  What what = What::take;
  std::string name;
};
/// The user moved to this moment of the log, or to the live world if `is_live`.
struct ShowMoment {
  Sequence seq = 0;
  bool is_live = false;
};

/// The clipboard of the tools is read from a file of this computer, or written to it.
struct ClipboardOfFile {
  std::string file;  // as typed
  bool is_saved = false;
  ModelChoices model = {};  // of a file with a model that is read
};
/// The file that is being read is not wanted any more.
struct FileStop {};

/// The user chose what frames show of storage and meshing.
struct SetInspection {
  InspectionModes modes;
};

using UiAction =
    std::variant<SendLine, HoldMaterial, HotbarOrder, ShowMoment, SetInspection, RollbackOrder,
                 LibraryOrder, ToolCommand, ClipboardOfFile, FileStop, SetTime>;

}  // namespace runstone
