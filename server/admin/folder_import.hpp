// FolderImport: adds the .rsb files of a folder to the library, for the command `builds import`. A
// worker reads and verifies a batch of files; the log writer writes one file after another; each
// record is ordered when its file is written. Between two batches the log writer is free for a
// moment, so that players can add builds meanwhile.
// A file that cannot be read is refused, and the others go on. The import ends early if the library
// is full, if the log takes no records, or if a command cancels it. What was added then stays.
// Thread: the world strand. Cost on it: one record for each file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/admin/build_folder.hpp"
#include "server/admin/command_call.hpp"

namespace runstone {

class FolderImport : public std::enable_shared_from_this<FolderImport> {
 public:
  /// Refusals that the answer shows. It counts the others.
  static constexpr std::size_t kRefusalsShown = 5;

  FolderImport(const CommandCall& call, std::shared_ptr<const BuildFolder> folder);
  /// Reads the next batch, saves what had to wait, and answers with the progress. Call it on every
  /// tick. The first call begins the import.
  void tick(const Clocks& now);
  /// Ends the import, which answers when everything that was added is on disk.
  void cancel() { end("cancelled"); }
  bool is_over() const { return stage_ == Stage::over; }
  const std::string& path() const { return path_; }

 private:
  enum class Stage : std::uint8_t {
    between,  // two batches
    reading,  // a worker reads a batch
    waiting,  // for the log writer
    saving,   // the log writer has a file
    over
  };
  void read_batch();
  void take_batch(FolderBatch batch, const std::string& error);
  /// Gives the next file of the batch to the log writer, or goes on to the next batch.
  void save_next();
  void saved(const AddBuild& build, const std::string& error);
  /// Answers. `why` is empty at the end of the folder, otherwise why the import ends before.
  void end(const std::string& why);
  std::string summary(const std::string& why) const;

  CommandCall call_;  // `now` is the time of the last tick
  const std::string path_;
  const std::size_t files_, others_;           // .rsb files of the folder, and others in it
  std::shared_ptr<const BuildFolder> folder_;  // null at the end
  Stage stage_ = Stage::between;
  FolderBatch batch_;
  std::size_t saved_of_batch_ = 0;
  TimeUs next_batch_us_ = 0, report_us_ = 0;  // steady clock
  std::uint64_t added_ = 0, known_ = 0, refused_ = 0;
  std::vector<std::string> refusals_;  // the first kRefusalsShown
  Sequence last_ = 0;                  // record of a build that was added, or 0
};

}  // namespace runstone
