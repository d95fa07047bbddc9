#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/core/assert.hpp"
#include "common/formats/minecraft_level.hpp"
#include "common/formats/minecraft_region.hpp"
#include "common/formats/piece_joiner.hpp"
#include "common/os/private_file.hpp"
#include "server/import/import_parts.hpp"

namespace runstone {
namespace {

/// The game's region files have at most 256 MiB: 1024 chunks of 255 sectors.
constexpr std::size_t kRegionBytesMax = std::size_t{512} << 20;
constexpr std::size_t kRegionBuildBytesMax = std::size_t{1} << 30;
constexpr std::string_view kRegionEnding = ".mca";

ByteView view_of(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

/// The place of level.dat where players arrive, or a notice why there is none.
struct LevelFile {
  std::optional<VoxelPos> spawn;
  std::string notice;
};

/// Reads level.dat of the folder of a world.
LevelFile read_level_file(const std::filesystem::path& folder) {
  constexpr std::size_t kLevelBytesMax = std::size_t{16} << 20;
  constexpr const char* kMiddle = ": players arrive in the middle of the world";
  const std::string file = (folder / "level.dat").string();
  const auto bytes = read_file(file, kLevelBytesMax, FileKinds::regular);
  if (!bytes) return {std::nullopt, bytes.error() + kMiddle};
  const auto spawn = read_minecraft_spawn(view_of(*bytes));
  if (!spawn) return {std::nullopt, file + ": " + spawn.error().what + kMiddle};
  if (!*spawn) return {std::nullopt, file + ": says no place in the overworld" + kMiddle};
  return {*spawn, ""};
}

class MinecraftParts final : public ImportParts {
 public:
  MinecraftParts(std::vector<std::string> files, LevelFile level, bool keep_all)
      : files_(std::move(files)),
        level_(std::move(level)),
        keep_all_(keep_all),
        format_(format_of_file(kRegionEnding)) {
    RUNSTONE_ASSERT(format_ != nullptr);
  }

  std::size_t count() const override { return files_.size(); }
  std::optional<VoxelPos> spawn() const override { return level_.spawn; }
  std::vector<std::string> notices() const override {
    return level_.notice.empty() ? std::vector<std::string>() : std::vector{level_.notice};
  }
  Result<std::optional<ImportPart>, std::string> read(std::size_t index,
                                                      ImportFaults& faults) override {
    const std::string& file = files_[index];
    const auto bytes = read_file(file, kRegionBytesMax, FileKinds::regular);
    if (!bytes) return failure(bytes.error());
    const auto region = open_minecraft_region(view_of(*bytes), region_of_file_name(file));
    if (!region) {
      faults.push_back(file + ": " + region.error().what);
      return std::optional<ImportPart>();
    }
    PieceJoiner joiner(*format_, keep_all_, kRegionBuildBytesMax);
    for (unsigned slot = 0; slot < kRegionSlots; ++slot) {
      const auto read = read_slot(file, *region, slot, joiner);
      if (!read && is_of_joiner(read.error())) return failure(file + ": " + read.error().what);
      if (!read) faults.push_back(fault_text(file, *region, slot, read.error()));
    }
    if (!joiner.has_pieces()) return std::optional<ImportPart>();
    const VoxelPos at = joiner.box().min;
    auto build = joiner.join();
    // The chunks say nothing of any voxel.
    if (!build && build.error().code == ErrorCode::bad_value) return std::optional<ImportPart>();
    if (!build) return failure(file + ": " + build.error().what);
    return std::optional(ImportPart{*std::move(build), at});
  }

 private:
  Result<bool> read_slot(const std::string& file, const MinecraftRegion& region, unsigned slot,
                         PieceJoiner& joiner) {
    std::string external;
    const ExternalChunk find = [&](unsigned of) -> std::optional<ByteView> {
      if (!region.at) return std::nullopt;
      const std::filesystem::path folder = std::filesystem::path(file).parent_path();
      auto read = read_file((folder / external_chunk_file(*region.at, of)).string(),
                            kMinecraftChunkBytesMax, FileKinds::regular);
      if (!read) return std::nullopt;
      external = *std::move(read);
      return view_of(external);
    };
    joiner_failed_ = false;
    return reader_.read(region, slot, find, [&](ForeignPiece&& piece) {
      auto added = joiner.add(std::move(piece));
      joiner_failed_ = !added;
      return added;
    });
  }
  /// Returns true if the last slot failed because the joiner is full, and not because of the slot.
  bool is_of_joiner(const Error& error) const {
    return joiner_failed_ && error.code == ErrorCode::limit_exceeded;
  }
  static std::string fault_text(const std::string& file, const MinecraftRegion& region,
                                unsigned slot, const Error& error) {
    const RegionPos at = region.at.value_or(RegionPos{});
    const auto x = std::int64_t{at.x} * kRegionSide + slot % kRegionSide;
    const auto z = std::int64_t{at.z} * kRegionSide + slot / kRegionSide;
    return file + ": chunk " + std::to_string(x) + "," + std::to_string(z) + ": " + error.what;
  }

  std::vector<std::string> files_;
  LevelFile level_;
  bool keep_all_;
  const Format* format_;
  MinecraftChunkReader reader_;
  bool joiner_failed_ = false;
};

/// Returns true if a file has the name that the game gives a region, so that no two files are one.
bool is_region_file(const std::filesystem::path& file) {
  const auto at = region_of_file_name(file.string());
  return at &&
         file.filename() == "r." + std::to_string(at->x) + "." + std::to_string(at->z) + ".mca";
}

/// Returns the region files of a folder, in the order of their names; none if there is no such folder.
Result<std::vector<std::string>, std::string> region_files(const std::filesystem::path& folder) {
  std::vector<std::string> out;
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) return out;
  std::filesystem::directory_iterator at(folder, error);
  for (const std::filesystem::directory_iterator end; !error && at != end; at.increment(error)) {
    if (is_region_file(at->path())) out.push_back(at->path().string());
  }
  if (error) return failure(folder.string() + ": " + error.message());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

Result<std::unique_ptr<ImportParts>, std::string> open_minecraft_parts(const std::string& place,
                                                                       bool keep_all) {
  std::error_code unknown;
  std::vector<std::string> files;
  LevelFile level;
  if (std::filesystem::is_directory(place, unknown)) {
    auto found = region_files(std::filesystem::path(place) / "region");
    if (found && !found->empty()) level = read_level_file(place);
    if (found && found->empty()) found = region_files(place);
    if (!found) return failure(found.error());
    files = *std::move(found);
    if (files.empty()) {
      return failure(place +
                     ": no region file (r.X.Z.mca) is there or in its folder region; other "
                     "dimensions are in DIM-1 (Nether) and DIM1 (End)");
    }
  } else if (has_ending(place, kRegionEnding)) {
    files.push_back(place);
  } else {
    return failure(place + ": is neither a folder nor a region file (r.X.Z.mca)");
  }
  return std::unique_ptr<ImportParts>(
      std::make_unique<MinecraftParts>(std::move(files), std::move(level), keep_all));
}

}  // namespace runstone
