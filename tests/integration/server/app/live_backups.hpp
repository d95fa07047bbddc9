// LiveBackups: backups of a world, one after another, while its server dies. Each must have what was
// on disk when it began.
#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>

#include "server/backup/backup_program.hpp"
#include "server/store/store.hpp"
#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {

class LiveBackups {
 public:
  /// `world`: the folder.
  explicit LiveBackups(std::string world) : world_(std::move(world)) {}

  /// Makes backups until `is_over`. The last one goes on while the server dies. Thread: any, one at a
  /// time.
  void work(const std::atomic<bool>& is_over) {
    while (!is_over) {
      const Sequence before = last_of(world_);
      const std::string copy = folder_ / "copy";
      std::ostringstream out;
      if (const auto done = back_up({world_, copy, false}, kNowUs, out, {})) {
        ++done_;
        if (last_of(copy) < before) ++incomplete_;
      } else {
        error_ = done.error();
      }
      std::filesystem::remove_all(copy);
    }
  }
  std::uint64_t done() const { return done_; }
  /// Returns the error of the last backup that failed, or an empty text.
  const std::string& error() const { return error_; }
  /// Returns the number of backups that lack something.
  std::uint64_t incomplete() const { return incomplete_; }

 private:
  static constexpr TimeUs kNowUs = 1'795'000'000'000'000;

  /// Returns the last edit on disk, or 0 if the world cannot be read.
  static Sequence last_of(const std::string& folder) {
    const auto store = open_world(folder, StoreAccess::read_only);
    if (!store) return 0;
    const auto last = (*store)->last_sequence();
    return last ? *last : 0;
  }

  const std::string world_;
  const TempFolder folder_;
  std::uint64_t done_ = 0, incomplete_ = 0;
  std::string error_;
};

}  // namespace runstone::test
