// FolderBench: a world with a folder for its backups.
#pragma once
#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "server/backup/backup_folder.hpp"
#include "server/backup/folder_program.hpp"
#include "tests/unit/server/backup/backup_bench.hpp"

namespace runstone::test {

inline constexpr TimeUs kBackupHourUs = 3'600'000'000;

struct FolderBench : BackupBench {
  FolderBench() { std::filesystem::create_directory(backups); }

  /// Carries out a request, and returns the error or an empty text. `printed` is then what it
  /// printed.
  std::string run(BackupFolderRequest request, TimeUs now_us = kBackupTimeUs,
                  const BackupPace& pace = {}) {
    std::ostringstream out;
    request.folder = backups;
    const auto done = run_backup_folder(request, now_us, out, pace);
    printed = out.str();
    return done ? "" : done.error();
  }
  std::string add(int hour, const BackupPolicy& policy = {0, 0, 0}, const BackupPace& pace = {}) {
    BackupFolderRequest request;
    request.action = BackupFolderRequest::Action::add;
    request.world = world;
    request.policy = policy;
    return run(request, kBackupTimeUs + hour * kBackupHourUs, pace);
  }
  std::string ask(BackupFolderRequest::Action action, const std::string& backup = "") {
    BackupFolderRequest request;
    request.action = action;
    request.backup = backup;
    return run(request);
  }
  std::string verify() { return ask(BackupFolderRequest::Action::verify); }
  std::string restore_backup(const std::string& name, const std::string& to) {
    std::ostringstream out;
    const auto done = restore({backups, to, false, name}, kBackupTimeUs + 100 * kBackupHourUs, out);
    printed = out.str();
    return done ? "" : done.error();
  }
  std::vector<BackupFolder::Entry> entries() {
    auto folder_of_backups = BackupFolder::open(backups);
    REQUIRE(folder_of_backups.has_value());
    auto all = folder_of_backups->entries();
    REQUIRE(all.has_value());
    return *std::move(all);
  }
  /// Returns the files of blocks.
  std::vector<std::filesystem::path> blocks() const {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(backups + "/blocks")) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
    return files;
  }
  std::uint64_t block_bytes() const {
    std::uint64_t bytes = 0;
    for (const auto& file : blocks()) bytes += std::filesystem::file_size(file);
    return bytes;
  }

  const std::string backups = folder / "backups";
};

}  // namespace runstone::test
