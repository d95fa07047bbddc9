// ClipboardTransfer: reads the clipboard of the tools from a file of any format, or writes it to
// one, for a player at the window. Files are read and written on a thread of their own: a town must
// not delay a frame. One file at a time. Thread: the main thread.
#pragma once
#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "client/play/server_notices.hpp"
#include "client/tools/tool_box.hpp"
#include "client/ui/hud_state.hpp"
#include "client/ui/ui_action.hpp"
#include "common/formats/file_build.hpp"

namespace runstone {

/// Returns a path in which a leading "~/" is the home folder, as in a shell. Blanks and quotes around
/// it, which a copied path may have, are left out.
std::string typed_path(const std::string& typed);

class ClipboardTransfer {
 public:
  ClipboardTransfer() = default;
  ClipboardTransfer(const ClipboardTransfer&) = delete;
  ClipboardTransfer& operator=(const ClipboardTransfer&) = delete;
  /// Waits until a file that is being written is on disk, or cannot be written. A file that is being
  /// read is given up.
  ~ClipboardTransfer() { stop(); }

  /// Begins to read or write a file. Returns a text for the player if it cannot: another file is under
  /// way, or there is nothing to write. Cost: O(materials) on this thread.
  std::optional<PlayerNotice> begin(const ClipboardOfFile& order, const ToolBox& tools);
  /// Takes the outcome if there is one: what was read becomes the clipboard. Returns a text for the
  /// player then. `has_loaded()` tells whether the clipboard is new.
  std::optional<PlayerNotice> step(ToolBox& tools);
  /// Returns true once after a file became the clipboard.
  bool take_loaded() { return std::exchange(has_loaded_, false); }
  /// Gives up the file that is being read. The clipboard stays as it is. The next file can begin
  /// when the thread has ended: step() says so. Files of other formats than models are read to
  /// their end first. Does nothing if no file is being read.
  void stop();
  bool is_busy() const { return !state_.empty(); }
  /// Returns what is under way, such as "reading castle.schem".
  FileState state() const;

 private:
  /// The state that the two threads of one reading share.
  struct Reading {
    std::atomic<bool> is_wanted = true;
    std::atomic<double> share = -1;  // of the voxels of a model that are made; below 0: none yet
    std::string notices;             // of the reading thread, until its outcome is here
  };

  std::string file_, state_;
  bool has_loaded_ = false;
  std::future<Result<FileBuild, std::string>> reading_;
  std::shared_ptr<Reading> shared_;  // of reading_
  std::future<Result<std::uint64_t, std::string>> writing_;
};

}  // namespace runstone
