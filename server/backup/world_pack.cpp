#include "server/backup/world_pack.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <ostream>
#include <span>
#include <system_error>
#include <utility>

#include "common/os/file_writer.hpp"
#include "common/os/low_priority.hpp"
#include "common/os/new_folder.hpp"
#include "common/os/progress_line.hpp"
#include "server/backup/copy_text.hpp"
#include "server/backup/file_blocks.hpp"
#include "server/backup/tar_header.hpp"

namespace runstone {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPackManifest = "runstone-pack";
constexpr TimeUs kPackSecondUs = 1'000'000;
constexpr mode_t kPackMode = 0600;
constexpr std::size_t kPackedManifestMax = std::size_t{4} << 30;

/// Writes the entries of a pack. After the first error the others do nothing.
class PackWriter {
 public:
  PackWriter(FileWriter& file, TimeUs time_us)
      : file_(file),
        time_s_(static_cast<std::uint64_t>(std::max<TimeUs>(time_us, 0) / kPackSecondUs)) {}

  Result<void, std::string> begin(const std::string& name, std::uint64_t bytes) {
    const auto header = tar_header({name, bytes, time_s_});
    if (!header) return failure(header.error());
    return write(*header);
  }
  Result<void, std::string> write(ByteView bytes) {
    if (file_.write(bytes)) return {};
    return failure("cannot be written: " + file_.error());
  }
  Result<void, std::string> fill(std::size_t bytes) { return write(Bytes(bytes, 0)); }

 private:
  FileWriter& file_;
  const std::uint64_t time_s_;
};

Result<BackedUpFile, std::string> pack_file(const fs::path& path, PackWriter& pack,
                                            const BackupPace& pace) {
  std::error_code error;
  const std::uint64_t bytes = fs::file_size(path, error);
  if (error) return failure(path.string() + ": cannot be read: " + error.message());
  if (auto begun = pack.begin(path.filename().string(), bytes); !begun)
    return failure(begun.error());
  auto part_begun = std::chrono::steady_clock::now();
  int blocks = 0;
  auto packed = cut_file(path, [&](ByteView block) -> Result<BlockHash, std::string> {
    if (auto written = pack.write(block); !written) return failure(written.error());
    constexpr int kBlocksToRest = 16;
    if (++blocks % kBlocksToRest == 0) {
      if (pace.rest) pace.rest(std::chrono::steady_clock::now() - part_begun);
      part_begun = std::chrono::steady_clock::now();
      const std::string folder = path.parent_path().string();
      if (auto room = check_room("the pack", folder, 0, pace.spare_bytes); !room)
        return failure(room.error());
    }
    return hash_of_block(block);
  });
  if (!packed) return packed;
  if (auto filled = pack.fill(tar_padding(bytes)); !filled) return failure(filled.error());
  return packed;
}

/// Writes the pack of the copied world in `folder` to a file in that folder.
Result<std::string, std::string> write_pack(const std::string& folder, const WorldBackup& copy,
                                            TimeUs now_us, const BackupPace& pace) {
  const auto files = files_of_copy(folder);
  if (!files) return failure(files.error());
  const std::string fresh = folder + "/" + kPackManifest;
  auto file = FileWriter::replace(fresh, kPackMode);
  if (!file) return failure("cannot be made: " + file.error());
  PackWriter pack(*file, now_us);
  BackupManifest manifest;
  manifest.world = copy.world;
  manifest.taken_us = now_us / kPackSecondUs * kPackSecondUs;
  manifest.epoch = copy.moment.epoch;
  manifest.seq = copy.moment.seq;
  for (const auto& path : *files) {
    auto packed = pack_file(path, pack, pace);
    if (!packed) return failure(packed.error());
    manifest.files.push_back(*std::move(packed));
  }
  manifest.new_bytes = manifest.bytes();
  const std::string text = manifest_text(manifest);
  if (auto begun = pack.begin(kPackManifest, text.size()); !begun) return failure(begun.error());
  if (!file->write(std::string_view(text))) return failure("cannot be written: " + file->error());
  if (auto ended = pack.fill(tar_padding(text.size()) + 2 * kTarBlockBytes); !ended)
    return failure(ended.error());
  if (auto finished = file->finish(); !finished)
    return failure("cannot be written: " + finished.error());
  return fresh;
}

/// Gives a file the name `to`. Fails if there is a file of this name, also one that was made a
/// moment ago. The error is that of the system.
Result<void, std::string> rename_to_new(const std::string& from, const std::string& to) {
  const auto wrong = [] { return failure(std::generic_category().message(errno)); };
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return {};
  if (errno != EINVAL && errno != ENOSYS) return wrong();
  // Some file systems of networks cannot do this. A link does not replace a file either.
  if (::link(from.c_str(), to.c_str()) != 0) return wrong();
  ::unlink(from.c_str());
  return {};
}

/// Reads the entries of a pack.
class PackReader {
 public:
  explicit PackReader(const std::string& file) : in_(file, std::ios::binary) {}

  /// Returns the next entry, or nullopt at the end.
  Result<std::optional<TarEntry>, std::string> next() {
    TarHeader header{};
    if (!read(header)) return failure("is cut off");
    return parse_tar_header(header);
  }
  /// Returns false if the file ends before `out` is full.
  bool read(std::span<std::uint8_t> out) {
    in_.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
    return static_cast<std::size_t>(in_.gcount()) == out.size();
  }
  bool skip(std::size_t bytes) {
    Bytes skipped(bytes);
    return read(skipped);
  }

 private:
  std::ifstream in_;
};

/// Returns true for a name that a copied world may have, so that the file lands in its folder.
bool is_name_in_pack(const std::string& name) {
  return name == "world.sqlite" || name == "world.durable" ||
         (name.ends_with(".toml") && name.find('/') == std::string::npos);
}

Result<BackedUpFile, std::string> unpack_file(PackReader& pack, const TarEntry& entry,
                                              const std::string& to) {
  if (!is_name_in_pack(entry.name)) return failure("holds " + entry.name + ", so it is no pack");
  const std::string path = to + "/" + entry.name;
  auto writer = FileWriter::replace(path, kPackMode);
  if (!writer) return failure(path + ": cannot be made: " + writer.error());
  BackedUpFile file{entry.name, entry.bytes, {}};
  Bytes block(kBlockBytes);
  for (std::uint64_t left = entry.bytes; left > 0;) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left, kBlockBytes));
    const auto part = std::span(block).first(count);
    if (!pack.read(part)) return failure("is cut off");
    if (!writer->write(ByteView(part)))
      return failure(path + ": cannot be written: " + writer->error());
    file.blocks.push_back(hash_of_block(part));
    left -= count;
  }
  if (!pack.skip(tar_padding(entry.bytes))) return failure("is cut off");
  if (auto finished = writer->finish(); !finished)
    return failure(path + ": cannot be written: " + finished.error());
  return file;
}

Result<BackupManifest, std::string> read_packed_manifest(PackReader& pack, std::uint64_t bytes) {
  if (bytes > kPackedManifestMax) return failure("is no pack of a world");
  std::string text;
  Bytes block(kBlockBytes);
  for (std::uint64_t left = bytes; left > 0;) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left, kBlockBytes));
    if (!pack.read(std::span(block).first(count))) return failure("is cut off");
    text.append(reinterpret_cast<const char*>(block.data()), count);
    left -= count;
  }
  return parse_manifest(text);
}

/// Writes all files of a pack to `to`. Returns the manifest, which is that of the files.
Result<BackupManifest, std::string> unpack_files(const std::string& file, const std::string& to) {
  PackReader pack(file);
  std::vector<BackedUpFile> files;
  for (;;) {
    const auto entry = pack.next();
    if (!entry) return failure(entry.error());
    if (!*entry) return failure("is no pack of a world: its manifest is missing");
    if ((*entry)->name != kPackManifest) {
      auto unpacked = unpack_file(pack, **entry, to);
      if (!unpacked) return failure(unpacked.error());
      files.push_back(*std::move(unpacked));
      continue;
    }
    auto manifest = read_packed_manifest(pack, (*entry)->bytes);
    if (manifest && manifest->files != files)
      return failure("is damaged: its files are not those of its manifest");
    return manifest;
  }
}

}  // namespace

Result<void, std::string> pack_world(const PackRequest& request, TimeUs now_us, std::ostream& out,
                                     const BackupPace& pace) {
  lower_priority();
  lower_disk_priority();
  if (is_inside(request.file, request.world))
    return failure(request.file + ": lies in " + request.world);
  std::error_code error;
  if (fs::exists(fs::symlink_status(request.file, error)))
    return failure(request.file + ": is there: a pack replaces no file");
  // The folder is not finished on purpose: its destructor removes the copy.
  auto folder = NewFolder::make(request.file + ".copy", out);
  if (!folder) return failure(folder.error());
  const auto copied = [&] {
    ProgressLine line("pages copied", request.progress);
    return back_up_world(request.world, SourceUse::live, folder->path(), now_us, pace,
                         [&](std::uint64_t done, std::uint64_t all) { line.show(done, all); });
  }();
  if (!copied) return failure(copied.error());
  const auto fresh = write_pack(folder->path(), *copied, now_us, pace);
  if (!fresh) return failure(request.file + ": " + fresh.error());
  const std::uint64_t bytes = fs::file_size(*fresh, error);
  if (auto named = rename_to_new(*fresh, request.file); !named)
    return failure(request.file + ": cannot be made: " + named.error());
  sync_folder_of(request.file);
  out << "packed      " << request.world << " to " << request.file << ", " << bytes << " bytes\n";
  print_copy(*copied, out);
  return {};
}

Result<WorldBackup, std::string> unpack_world(const std::string& file, const std::string& to,
                                              TimeUs now_us) {
  const auto begun = std::chrono::steady_clock::now();
  const auto manifest = unpack_files(file, to);
  if (!manifest) {
    const bool names_file = manifest.error().starts_with(to);
    return failure(names_file ? manifest.error() : file + ": " + manifest.error());
  }
  WorldBackup backup;
  backup.moment = {manifest->epoch, manifest->seq, manifest->bytes()};
  backup.copy_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  if (auto complete = complete_copy(to, now_us, backup); !complete)
    return failure(complete.error());
  return backup;
}

}  // namespace runstone
