#include "server/backup/folder_backup.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/os/file_writer.hpp"
#include "common/os/new_folder.hpp"
#include "server/backup/file_blocks.hpp"

namespace runstone {
namespace {

constexpr int kBlocksAtOnce = 16;  // between two rests

/// Returns the bytes of the next block of a file of which `left` bytes are left.
std::size_t bytes_of_block(std::uint64_t left) {
  return static_cast<std::size_t>(std::min<std::uint64_t>(left, kBlockBytes));
}

/// Writes a file of a backup into the folder `to`.
Result<void, std::string> write_file_of_backup(const BackedUpFile& file, const BlockFolder& blocks,
                                               const std::string& to) {
  constexpr mode_t kOwnerOnly = 0600;
  const std::string path = to + "/" + file.name;
  auto writer = FileWriter::replace(path, kOwnerOnly);
  if (!writer) return failure(path + ": cannot be made: " + writer.error());
  std::uint64_t left = file.bytes;
  for (const BlockHash& hash : file.blocks) {
    const std::size_t count = bytes_of_block(left);
    left -= count;
    const auto block = blocks.get(hash, count);
    if (!block) return failure(block.error());
    if (!writer->write(ByteView(*block)))
      return failure(path + ": cannot be written: " + writer->error());
  }
  if (auto finished = writer->finish(); !finished)
    return failure(path + ": cannot be written: " + finished.error());
  return {};
}

/// Stores the blocks of the copy in `folder`, and makes the backup of them.
Result<void, std::string> store_copy(const std::string& folder, BackupFolder& into,
                                     const BackupPace& pace, BackupManifest& manifest) {
  int blocks = 0;
  auto part_begun = std::chrono::steady_clock::now();
  const TakeBlock store = [&](ByteView block) -> Result<BlockHash, std::string> {
    if (blocks++ % kBlocksAtOnce == 0) {
      if (pace.rest && blocks > 1) pace.rest(std::chrono::steady_clock::now() - part_begun);
      part_begun = std::chrono::steady_clock::now();
      if (auto room = check_room(into.path(), into.path(), 0, pace.spare_bytes); !room) {
        return failure(room.error() + ": `runstone-server backup prune` removes older backups");
      }
    }
    const auto stored = into.blocks().put(block);
    if (!stored) return failure(stored.error());
    manifest.new_bytes += stored->written;
    return stored->hash;
  };
  const auto files = files_of_copy(folder);
  if (!files) return failure(files.error());
  for (const auto& path : *files) {
    auto file = cut_file(path, store);
    if (!file) return failure(file.error());
    manifest.files.push_back(*std::move(file));
  }
  return into.add(manifest);
}

}  // namespace

Result<AddedBackup, std::string> add_backup(const std::string& from, BackupFolder& into,
                                            TimeUs now_us, const BackupPace& pace,
                                            const BackupProgress& progress, std::ostream& out) {
  AddedBackup added;
  const std::string copy = into.path() + "/copy";
  std::error_code ignored;
  added.found_interrupted = std::filesystem::exists(copy + ".partial", ignored);
  // The folder is not finished on purpose: its destructor removes the copy.
  auto folder = NewFolder::make(copy, out);
  if (!folder) return failure(folder.error());
  auto copied = back_up_world(from, SourceUse::live, folder->path(), now_us, pace, progress);
  if (!copied) return failure(copied.error());
  const auto begun = std::chrono::steady_clock::now();
  added.copy = *std::move(copied);
  constexpr TimeUs kSecondUs = 1'000'000;
  added.manifest.world = added.copy.world;
  added.manifest.taken_us = now_us / kSecondUs * kSecondUs;
  added.manifest.epoch = added.copy.moment.epoch;
  added.manifest.seq = added.copy.moment.seq;
  if (auto stored = store_copy(folder->path(), into, pace, added.manifest); !stored) {
    // No backup names the blocks that were stored. Without room for a backup, they would fill the
    // disk for ever. If they cannot be removed now, the next removal of a backup removes them.
    static_cast<void>(into.remove({}));
    return failure(stored.error());
  }
  added.store_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return added;
}

Result<WorldBackup, std::string> write_backup(const BackupManifest& manifest,
                                              const BlockFolder& blocks, const std::string& to,
                                              TimeUs now_us) {
  WorldBackup backup;
  backup.moment = {manifest.epoch, manifest.seq, manifest.bytes()};
  const auto begun = std::chrono::steady_clock::now();
  for (const BackedUpFile& file : manifest.files) {
    if (auto written = write_file_of_backup(file, blocks, to); !written)
      return failure(written.error());
  }
  backup.copy_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  if (auto complete = complete_copy(to, now_us, backup); !complete)
    return failure(complete.error());
  return backup;
}

Result<void, std::string> check_blocks(const BackupManifest& manifest, const BlockFolder& blocks,
                                       std::set<BlockHash>& sound) {
  for (const BackedUpFile& file : manifest.files) {
    std::uint64_t left = file.bytes;
    for (const BlockHash& hash : file.blocks) {
      const std::size_t count = bytes_of_block(left);
      left -= count;
      if (sound.contains(hash)) continue;
      if (const auto block = blocks.get(hash, count); !block) return failure(block.error());
      sound.insert(hash);
    }
  }
  return {};
}

}  // namespace runstone
