// PageFile: the pages of a world's database, read from `world.sqlite` and `world.sqlite-wal`
// without the SQLite library. SQLite stops reading the write-ahead log at the first damaged frame;
// the frames behind it are read here too, as *torn* ones: each row in them has a checksum of its
// own.
// Source: "The Database Header", "The Freelist", "Pointer Map or Ptrmap Pages" and "The Write-Ahead
// Log" in
// https://sqlite.org/fileformat2.html
// Threads: one thread at a time.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/sqlite/vfs_file.hpp"
#include "server/repair/page_cells.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

class PageFile {
 public:
  /// A page as a commit left it, or as a torn frame has it.
  enum class Age { committed, torn };

  /// Opens the database of the world in a folder. Fails (not_a_world) if there is no file, and (io)
  /// if it cannot be read.
  static StoreResult<PageFile> open(const std::string& folder);

  std::size_t page_bytes() const { return page_bytes_; }
  /// Returns the number of pages. Pages count from 1.
  std::uint32_t pages() const { return pages_; }
  /// Returns a page, or nullopt if it cannot be read.
  std::optional<Bytes> page(std::uint32_t number);
  bool has_torn_pages() const { return !torn_frames_.empty(); }
  /// Returns the torn frames, each with its number of a page and its bytes.
  std::vector<std::pair<std::uint32_t, Bytes>> torn_pages();
  /// Returns the bytes before the header of a page.
  static std::size_t header_bytes(std::uint32_t number) {
    return number == 1 ? kDatabaseHeaderBytes : 0;
  }
  /// Returns the whole record of a cell, with its overflow pages. Returns nullopt if they end
  /// early.
  std::optional<Bytes> record_of(const PageCell& cell, Age age);
  /// Returns true for a page of back references, which has no rows. Files that can give space back
  /// in parts have such pages. It looks at the page alone, because the header may be damaged.
  bool is_pointer_map(std::uint32_t number, ByteView page) const;
  /// Returns true for each page that SQLite does not use. Element 0 is not a page.
  const std::vector<bool>& free_pages() const { return is_free_; }

  /// Returns a line for each damage of the header, of the list of free pages and of the write-ahead
  /// log.
  const std::vector<std::string>& damage() const { return damage_; }

 private:
  PageFile(std::string file, sql::VfsFile main, std::uint64_t bytes)
      : file_(std::move(file)), main_(std::move(main)), main_bytes_(bytes) {}
  StoreResult<void> read_header();
  /// Returns the size of a page with which the most pages of the file are sound.
  std::size_t guessed_page_bytes();
  StoreResult<void> read_log();
  void read_free_pages();
  std::optional<Bytes> read_from(sql::VfsFile& file, std::uint64_t at, std::size_t bytes);

  std::string file_;
  sql::VfsFile main_;
  std::uint64_t main_bytes_;
  std::optional<sql::VfsFile> log_;
  std::size_t page_bytes_ = 0;
  std::uint32_t pages_ = 0;
  std::uint32_t committed_pages_ = 0;  // as the last commit of the log says; 0: there is none
  // Where the newest frame of a page begins in the log.
  std::map<std::uint32_t, std::uint64_t> committed_, torn_;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> torn_frames_;
  std::vector<bool> is_free_;
  std::vector<std::string> damage_;
};

}  // namespace runstone
