// BackupBench: a world with some edits, for tests of backup and restore.
#pragma once
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include "server/backup/backup_program.hpp"
#include "server/store/store.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {

inline constexpr TimeUs kBackupTimeUs = 1'795'000'000'000'000;  // 2026-11-18
inline constexpr Sequence kBackupEdits = 400;

class BackupBench {
 public:
  BackupBench() {
    auto made = create_world(world, sample_meta());
    REQUIRE(made.has_value());
    store = *std::move(made);
    REQUIRE(store->raise_epoch().has_value());
    const PlayerRow players[] = {sample_player(1), sample_player(2)};
    REQUIRE(store->append(players, sample_records(rng, 1, 1, kBackupEdits)).has_value());
  }

  /// Appends `count` edits, as a server that runs the world does.
  void play(std::size_t count) {
    const auto last = store->last_sequence();
    REQUIRE(last.has_value());
    REQUIRE(store->append({}, sample_records(rng, store->epoch(), *last + 1, count)).has_value());
  }
  /// Returns the error, or an empty string. What the program printed is then in `printed`.
  std::string back_up_to(const std::string& to, BackupPace pace = {}) {
    std::ostringstream out;
    const auto done = back_up({world, to, false}, kBackupTimeUs, out, pace);
    printed = out.str();
    return done ? "" : done.error();
  }
  std::string restore_to(const std::string& from, const std::string& to,
                         TimeUs now_us = kBackupTimeUs + 3'600'000'000) {
    std::ostringstream out;
    const auto done = restore({from, to, false}, now_us, out);
    printed = out.str();
    return done ? "" : done.error();
  }
  static std::unique_ptr<Store> opened(const std::string& folder,
                                       StoreAccess access = StoreAccess::read_only) {
    auto opened = open_world(folder, access);
    if (!opened) FAIL(opened.error().message());
    return *std::move(opened);
  }
  static void write_file(const std::string& file, const std::string& text) {
    std::ofstream(file) << text;
  }

  TempFolder folder;
  SplitMix64 rng{7};
  const std::string world = folder / "world", copy = folder / "copy", back = folder / "back";
  std::unique_ptr<Store> store;
  std::string printed;
};

}  // namespace runstone::test
