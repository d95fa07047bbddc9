// PlayerFiles: writes what a player holds in each world, and the hotbars that are kept under names,
// into their files soon after a change, so that a client that is killed loses little. A thread of
// std::async writes, because a slow disk must not delay a frame. Thread: the main thread. Times are
// microseconds of the steady clock.
#pragma once
#include <future>
#include <optional>
#include <string>
#include <utility>

#include "client/play/world_kit.hpp"
#include "client/settings/hotbars_file.hpp"
#include "client/settings/world_kits.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class PlayerFiles {
 public:
  /// Writing begins this long after the first change that is not written. A client that is killed
  /// loses the changes of this time, and of the time that the disk needs.
  static constexpr TimeUs kDelayUs = 2'000'000;
  /// The pause after a write that failed.
  static constexpr TimeUs kRetryUs = 30'000'000;

  /// A file with an empty name is neither read nor written.
  PlayerFiles(std::string kits_file, std::string hotbars_file);
  PlayerFiles(const PlayerFiles&) = delete;
  PlayerFiles& operator=(const PlayerFiles&) = delete;
  /// Waits until what is being written is on disk, or cannot be written.
  ~PlayerFiles() { wait(); }

  /// Takes the kit of a world, in place of an earlier one.
  void keep(const WorldId& world, const WorldKit& kit, TimeUs now_us);
  /// Takes all hotbars of the player, in place of earlier ones.
  void keep(HotbarRows hotbars, TimeUs now_us);
  /// Returns the newest kit of a world, written or not, or nullopt if there is none. Waits for the
  /// disk: call it when a world opens.
  std::optional<WorldKit> kit_of(const WorldId& world) const;

  /// Begins to write what is due. Call it in every turn. Returns the warning of a write that failed
  /// since the last call, or an empty text. A change that cannot be written is tried again after
  /// kRetryUs.
  std::string step(TimeUs now_us);
  /// Writes everything before it returns. The last kit is written although it has not changed: of
  /// several clients of one player in one world, the one that ends last leaves its kit. Fails with a
  /// line that begins with the name of the file.
  Result<void, std::string> finish();

  bool is_writing() const { return write_.valid(); }

 private:
  struct Unwritten {
    UnsavedKits kits;
    std::optional<HotbarRows> hotbars;
    bool empty() const { return kits.empty() && !hotbars; }
  };
  /// Writes both files. Fails as save_kit() and save_hotbars() do.
  static Result<void, std::string> write(Unwritten what, const std::string& kits_file,
                                         const std::string& hotbars_file);
  void wait() const;
  /// Takes the result of the write. The changes that could not be written wait again, unless they
  /// were replaced.
  Result<void, std::string> take_written();

  const std::string kits_file_, hotbars_file_;
  /// World and line of the last keep().
  std::optional<std::pair<std::string, std::string>> last_kit_;
  Unwritten waiting_;  // to be written
  TimeUs due_us_ = 0;  // when writing begins, if something waits
  Unwritten written_;  // what write_ writes
  std::future<Result<void, std::string>> write_;
};

}  // namespace runstone
