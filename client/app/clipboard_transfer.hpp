// ClipboardTransfer: reads the clipboard of the tools from a file of any format, or writes it to one,
// for a player at the window. Files are read and written on a thread of their own: a town must not delay a
// frame. One file at a time. Thread: the main thread.
#pragma once
#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "client/play/server_notices.hpp"
#include "client/tools/tool_box.hpp"
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
  ~ClipboardTransfer() { is_wanted_->store(false); }

  /// Begins to read or write a file. Returns a text for the player if it cannot: another file is under
  /// way, or there is nothing to write. Cost: O(materials) on this thread.
  std::optional<PlayerNotice> begin(const ClipboardOfFile& order, const ToolBox& tools);
  /// Takes the outcome if there is one: what was read becomes the clipboard. Returns a text for the
  /// player then. `has_loaded()` tells whether the clipboard is new.
  std::optional<PlayerNotice> step(ToolBox& tools);
  /// Returns true once after a file became the clipboard.
  bool take_loaded() { return std::exchange(has_loaded_, false); }
  /// Returns what is under way, such as "reading castle.schem", or an empty text.
  const std::string& state() const { return state_; }

 private:
  std::string file_, state_;
  bool has_loaded_ = false;
  std::future<Result<FileBuild, std::string>> reading_;
  const std::shared_ptr<std::atomic<bool>> is_wanted_ = std::make_shared<std::atomic<bool>>(true);
  std::shared_ptr<std::string> notices_;  // of the reading thread, until its outcome is here
  std::future<Result<std::uint64_t, std::string>> writing_;
};

}  // namespace runstone
