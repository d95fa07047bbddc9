#include <leveldb/db.h>

#include <charconv>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/formats/luanti_block.hpp"
#include "server/import/leveldb_overlay.hpp"
#include "server/import/luanti_map.hpp"

namespace runstone {
namespace {

/// The rows of the log, which the database keeps in memory, and a new manifest. Luanti's log has at
/// most 4 MiB before it becomes a table.
constexpr std::size_t kLogBytesMax = std::size_t{512} << 20;
/// The tables that are open at a time.
constexpr int kOpenFilesMax = 200;

/// Returns one line on why a map cannot be read, and what to do.
std::string words_of_leveldb(const leveldb::Status& status) {
  const std::string what = status.ToString();
  if (status.IsCorruption() || status.IsNotFound()) {
    return "damaged: " + what +
           ". Restore it from a backup. If Luanti still starts with a copy of the world, run it "
           "once, and import the copy";
  }
  if (status.IsInvalidArgument())
    return "not a LevelDB, or not all of its files are there: " + what;
  return "cannot be read: " + what;
}

class LeveldbMap final : public LuantiMap {
 public:
  /// Opens the database and counts its rows, which also verifies the checksums of all tables.
  Result<void, std::string> open(const std::string& folder) {
    std::error_code unknown;
    if (!std::filesystem::exists(std::filesystem::path(folder) / "CURRENT", unknown))
      return failure("not a LevelDB, or not all of its files are there: it has no file CURRENT");
    leveldb::Options options;
    options.env = &overlay_;
    options.paranoid_checks = true;
    options.max_open_files = kOpenFilesMax;
    leveldb::DB* database = nullptr;
    const leveldb::Status opened = leveldb::DB::Open(options, folder, &database);
    overlay_.freeze();
    database_.reset(database);
    if (overlay_.is_in_use()) {
      return failure(
          "in use: another program holds its lock. Stop the Luanti server, or copy the folder of the "
          "world while the server is stopped, and import the copy");
    }
    if (!opened.ok()) return failure(words_of_leveldb(opened));
    return each_row([&](const LuantiRow&) { ++row_count_; });
  }

  std::uint64_t row_count() const override { return row_count_; }

  Result<void, std::string> each_row(const std::function<void(const LuantiRow&)>& to_row) override {
    leveldb::ReadOptions reading = verified();
    reading.fill_cache = false;
    const std::unique_ptr<leveldb::Iterator> at(database_->NewIterator(reading));
    for (at->SeekToFirst(); at->Valid(); at->Next()) {
      const std::string key = at->key().ToString();
      LuantiRow row;
      row.pos = pos_of(key);
      row.block = luanti_block_coord(row.pos);
      row.is_placed = std::to_string(row.pos) == key && luanti_block_pos(row.block) == row.pos;
      row.data = {reinterpret_cast<const std::uint8_t*>(at->value().data()), at->value().size()};
      to_row(row);
    }
    if (!at->status().ok()) return failure(words_of_leveldb(at->status()));
    return {};
  }

  std::optional<ByteView> find(ChunkCoord block) override {
    const std::string key = std::to_string(luanti_block_pos(block));
    if (!database_->Get(verified(), key, &found_).ok()) return std::nullopt;
    return ByteView(reinterpret_cast<const std::uint8_t*>(found_.data()), found_.size());
  }

 private:
  static leveldb::ReadOptions verified() {
    leveldb::ReadOptions out;
    out.verify_checksums = true;
    return out;
  }
  /// Returns the number that the whole key is, or 0.
  static std::int64_t pos_of(const std::string& key) {
    std::int64_t pos = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), pos);
    return error == std::errc() && end == key.data() + key.size() ? pos : 0;
  }

  LeveldbOverlay overlay_{kLogBytesMax};  // outlives the database
  std::unique_ptr<leveldb::DB> database_;
  std::uint64_t row_count_ = 0;
  std::string found_;
};

}  // namespace

Result<std::unique_ptr<LuantiMap>, std::string> open_luanti_leveldb_map(const std::string& folder) {
  auto map = std::make_unique<LeveldbMap>();
  if (const auto opened = map->open(folder); !opened) return failure(opened.error());
  return std::unique_ptr<LuantiMap>(std::move(map));
}

}  // namespace runstone
