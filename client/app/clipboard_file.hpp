// ClipboardFile: keeps the clipboard of the player in a file, so that it survives the program. The file
// is an .rsb (docs/builds.md) with the materials by their names. It is written whole or not at all, on
// a thread of its own: a copy of a town must not delay a frame. Thread: the main thread.
#pragma once
#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/tools/tool_box.hpp"
#include "common/core/result.hpp"
#include "common/formats/file_build.hpp"
#include "common/models/model_choices.hpp"

namespace runstone {

class ClipboardFile {
 public:
  /// With an empty `file`, nothing is kept.
  explicit ClipboardFile(std::string file) : file_(std::move(file)) {}
  ClipboardFile(const ClipboardFile&) = delete;
  ClipboardFile& operator=(const ClipboardFile&) = delete;
  /// Waits until the clipboard of the last step() is on disk, or cannot be written.
  ~ClipboardFile();

  /// Reads the file into the tools. Does nothing if there is no file. Fails with a line for the log if
  /// it cannot be read; the tools and the file stay as they are. Blocks on the disk.
  Result<void, std::string> load(ToolBox& tools);
  /// Begins to write the clipboard if the player has changed it. While one is being written, only the
  /// newest of those that follow waits. Returns a line for the player if a clipboard
  /// could not be written, otherwise an empty text. Cost: O(1) on this thread.
  std::string step(const ToolBox& tools);

 private:
  struct Kept {
    BuildPtr build;
    EmptyCells empty = EmptyCells::pasted;
    std::vector<MaterialRow> rows;
  };
  static Result<void, std::string> write(const std::string& file, const Kept& kept);

  const std::string file_;
  std::uint64_t taken_ = 0;    // ToolBox::clipboard_changes() of the last clipboard that was taken
  std::optional<Kept> waits_;  // for the end of `writing_`
  std::future<Result<void, std::string>> writing_;
};

/// Sets the clipboard to a build of a file. Returns text about materials that the world lacks, which may
/// be empty.
std::string set_clipboard(FileBuild read, ToolBox& tools);
/// Returns the clipboard as a build for a file. Fails with one line if nothing was copied.
Result<FileBuild, std::string> build_of_clipboard(const std::string& file, const ToolBox& tools);

/// Sets the clipboard to the build of a file, whose ending names the format (docs/formats.md). Returns
/// text about materials that the world lacks, which may be empty. `model` counts for a file with a
/// model. The error is one line. Blocks until the build is made.
Result<std::string, std::string> read_clipboard(const std::string& file, ToolBox& tools,
                                                const ModelChoices& model = {});
/// Writes the clipboard to a file, whose ending names the format. An old file is replaced when the new
/// one is whole. Fails with one line, also if nothing was copied. Blocks on the disk.
Result<void, std::string> write_clipboard(const std::string& file, const ToolBox& tools);

/// Returns the path of the clipboard in the user's data folder, or an empty text if there is none.
std::string default_clipboard_file();

}  // namespace runstone
