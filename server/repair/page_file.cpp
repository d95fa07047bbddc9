#include "server/repair/page_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/sqlite/sqlite_file.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLogHeaderBytes = 32, kLogFrameHeaderBytes = 24;
constexpr std::uint32_t kLogMagic = 0x377f0682;  // the last bit: checksums are big-endian
constexpr std::uint32_t kFormatRepaired = 4;     // the first format that can be repaired
constexpr std::array<std::size_t, 4> kPageBytesTried = {2'048, 4'096, 1'024, 8'192};

// An entry of a page of back references: its kind, and the number of a page.
constexpr std::size_t kPointerBytes = 5;
constexpr std::uint8_t kPointerKindMax = 5;
constexpr std::uint64_t kLockByte = std::uint64_t{1} << 30;

/// The running checksum of the write-ahead log.
class LogChecksum {
 public:
  explicit LogChecksum(bool is_big_endian) : is_big_endian_(is_big_endian) {}
  void add(ByteView in) {
    for (std::size_t at = 0; at + 8 <= in.size(); at += 8) {
      a_ += word(in, at) + b_;
      b_ += word(in, at + 4) + a_;
    }
  }
  bool is(ByteView in, std::size_t at) const {
    return sqlite_u32(in, at) == a_ && sqlite_u32(in, at + 4) == b_;
  }

 private:
  std::uint32_t word(ByteView in, std::size_t at) const {
    const std::uint32_t value = sqlite_u32(in, at);
    if (is_big_endian_) return value;
    return value >> 24 | (value >> 8 & 0xff00U) | (value << 8 & 0xff0000U) | value << 24;
  }
  bool is_big_endian_;
  std::uint32_t a_ = 0, b_ = 0;
};

bool is_page_size(std::size_t bytes) {
  return std::has_single_bit(bytes) && bytes >= 512 && bytes <= 65'536;
}

}  // namespace

StoreResult<PageFile> PageFile::open(const std::string& folder) {
  const std::string file = folder + "/world.sqlite";
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) return failure(StoreError{StoreError::Kind::not_a_world, file, "", error.message()});
  auto main = sql::VfsFile::open(file, sql::VfsFile::Mode::read, "");
  if (!main) return failed(main.error());
  PageFile out(file, *std::move(main), bytes);
  if (auto read = out.read_header(); !read) return failed(read.error());
  if (auto read = out.read_log(); !read) return failed(read.error());
  out.read_free_pages();
  return out;
}

std::optional<Bytes> PageFile::read_from(sql::VfsFile& file, std::uint64_t at, std::size_t bytes) {
  Bytes out(bytes);
  if (!file.read(at, out)) return std::nullopt;
  return out;
}

StoreResult<void> PageFile::read_header() {
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  const auto header = read_from(main_, 0, kDatabaseHeaderBytes);
  const bool is_ours =
      header &&
      std::equal(kMagic.begin(), kMagic.end(), header->begin(),
                 [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; }) &&
      sqlite_u32(*header, 68) == kApplicationId;
  // A damaged header says nothing about the format: the world is repaired all the same.
  if (is_ours) {
    const std::uint32_t format = sqlite_u32(*header, 60);
    if (auto known = check_format(file_, format); !known) return known;
    if (format < kFormatRepaired) {
      return failure(StoreError{StoreError::Kind::bad_request, file_, "",
                                "is of world format " + std::to_string(format) +
                                    ", which cannot be repaired: put it back from a backup"});
    }
    page_bytes_ = static_cast<std::size_t>((*header)[16]) << 8 | (*header)[17];
    if (page_bytes_ == 1) page_bytes_ = 65'536;
  } else {
    damage_.push_back("the header of the database is damaged");
  }
  if (!is_page_size(page_bytes_)) page_bytes_ = guessed_page_bytes();
  // A page that is cut off is read with zeros behind its end.
  pages_ = static_cast<std::uint32_t>((main_bytes_ + page_bytes_ - 1) / page_bytes_);
  return {};
}

std::size_t PageFile::guessed_page_bytes() {
  constexpr std::uint64_t kPagesTried = 4'096;
  std::size_t best = kPageBytesTried[0];
  std::uint64_t best_cells = 0;
  for (const std::size_t bytes : kPageBytesTried) {
    std::uint64_t cells = 0;
    const std::uint64_t pages = std::min(kPagesTried, main_bytes_ / bytes);
    for (std::uint64_t i = 1; i < pages; ++i) {
      const auto page = read_from(main_, i * bytes, bytes);
      const auto found = page ? cells_of(*page, 0, bytes) : std::nullopt;
      if (found && found->unreadable == 0) cells += found->cells.size();
    }
    if (cells > best_cells) {
      best = bytes;
      best_cells = cells;
    }
  }
  return best;
}

StoreResult<void> PageFile::read_log() {
  const std::string file = file_ + "-wal";
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error || bytes < kLogHeaderBytes) return {};
  auto opened = sql::VfsFile::open(file, sql::VfsFile::Mode::read, "");
  if (!opened) return failed(opened.error());
  log_ = *std::move(opened);
  const auto header = read_from(*log_, 0, kLogHeaderBytes);
  LogChecksum checksum((header ? (*header)[3] & 1U : 0U) != 0);
  if (header) checksum.add(ByteView(*header).first(24));
  bool is_sound = header && (sqlite_u32(*header, 0) & ~1U) == kLogMagic &&
                  checksum.is(*header, 24) && sqlite_u32(*header, 8) == page_bytes_;
  if (!is_sound) damage_.push_back("the header of world.sqlite-wal is damaged");
  // Frames of an earlier use of the file have other salts. If the header is damaged, the first
  // frame has the salts.
  Bytes salts;
  if (is_sound) salts.assign(header->begin() + 16, header->begin() + 24);
  std::map<std::uint32_t, std::uint64_t> open;  // since the last commit
  for (std::uint64_t at = kLogHeaderBytes; at + kLogFrameHeaderBytes + page_bytes_ <= bytes;
       at += kLogFrameHeaderBytes + page_bytes_) {
    const auto frame = read_from(*log_, at, kLogFrameHeaderBytes + page_bytes_);
    if (frame && salts.empty()) salts.assign(frame->begin() + 8, frame->begin() + 16);
    if (!frame || !std::equal(salts.begin(), salts.end(), frame->begin() + 8)) {
      // The rest is of an earlier use, unless a later frame has the salts again.
      is_sound = false;
      continue;
    }
    const std::uint32_t number = sqlite_u32(*frame, 0);
    if (is_sound) {
      checksum.add(ByteView(*frame).first(8));
      checksum.add(ByteView(*frame).subspan(kLogFrameHeaderBytes));
      is_sound = checksum.is(*frame, 16);
    }
    if (!is_sound) {
      if (torn_frames_.empty())
        damage_.push_back("world.sqlite-wal is damaged at byte " + std::to_string(at) +
                          ": SQLite does not read what is behind");
      torn_[number] = at;
      torn_frames_.emplace_back(number, at);
      continue;
    }
    open[number] = at;
    if (const std::uint32_t size = sqlite_u32(*frame, 4); size != 0) {
      for (const auto& [page, from] : open) committed_[page] = from;
      open.clear();
      committed_pages_ = size;
    }
  }
  // Frames behind the last commit are of a transaction that was not committed, so they are dropped.
  // If there are torn frames, the frame of its commit may be one of them.
  if (torn_frames_.empty()) open.clear();
  for (const auto& [page, from] : open) {
    torn_.try_emplace(page, from);
    torn_frames_.emplace_back(page, from);
  }
  pages_ = std::max(pages_, committed_pages_);
  return {};
}

std::optional<Bytes> PageFile::page(std::uint32_t number) {
  if (number == 0 || number > pages_) return std::nullopt;
  const auto framed = committed_.find(number);
  if (framed != committed_.end())
    return read_from(*log_, framed->second + kLogFrameHeaderBytes, page_bytes_);
  const std::uint64_t at = std::uint64_t{number - 1} * page_bytes_;
  if (at >= main_bytes_) return std::nullopt;
  return read_from(main_, at, page_bytes_);
}

std::vector<std::pair<std::uint32_t, Bytes>> PageFile::torn_pages() {
  std::vector<std::pair<std::uint32_t, Bytes>> out;
  for (const auto& [number, at] : torn_frames_) {
    if (auto page = read_from(*log_, at + kLogFrameHeaderBytes, page_bytes_))
      out.emplace_back(number, *std::move(page));
  }
  return out;
}

std::optional<Bytes> PageFile::record_of(const PageCell& cell, Age age) {
  Bytes record(cell.local.begin(), cell.local.end());
  const std::uint64_t pages_max = cell.record_bytes / (page_bytes_ - 4) + 1;
  if (cell.overflow != 0 && pages_max > pages_) return std::nullopt;
  std::uint32_t next = cell.overflow;
  while (record.size() < cell.record_bytes) {
    std::optional<Bytes> part;
    const auto torn = age == Age::torn ? torn_.find(next) : torn_.end();
    if (torn != torn_.end())
      part = read_from(*log_, torn->second + kLogFrameHeaderBytes, page_bytes_);
    if (!part) part = page(next);
    if (!part) return std::nullopt;
    next = sqlite_u32(*part, 0);
    const std::uint64_t bytes =
        std::min<std::uint64_t>(page_bytes_ - 4, cell.record_bytes - record.size());
    record.insert(record.end(), part->begin() + 4,
                  part->begin() + 4 + static_cast<std::ptrdiff_t>(bytes));
  }
  return record;
}

bool PageFile::is_pointer_map(std::uint32_t number, ByteView page) const {
  if (number < 2 || page.size() < kPointerBytes) return false;
  // Each of them stands before the pages that it describes. SQLite never uses the page of the
  // locks.
  const auto group = static_cast<std::uint32_t>(page_bytes_ / kPointerBytes + 1);
  const auto lock_page = static_cast<std::uint32_t>(kLockByte / page_bytes_ + 1);
  std::uint32_t map = (number - 2) / group * group + 2;
  if (map == lock_page) ++map;
  if (map != number || page[0] == 0) return false;
  for (std::size_t at = 0; at + kPointerBytes <= page.size(); at += kPointerBytes) {
    if (page[at] > kPointerKindMax) return false;
  }
  return true;
}

void PageFile::read_free_pages() {
  is_free_.assign(std::size_t{pages_} + 1, false);
  const auto first = page(1);
  if (!first) {
    damage_.push_back("page 1 cannot be read");
    return;
  }
  std::uint32_t trunk = sqlite_u32(*first, 32);
  const std::uint32_t expected = sqlite_u32(*first, 36);
  std::uint32_t found = 0;
  bool is_sound = true;
  const auto take = [&](std::uint32_t number) {
    is_sound = is_sound && number > 1 && number <= pages_ && !is_free_[number];
    if (!is_sound) return;
    is_free_[number] = true;
    ++found;
  };
  while (trunk != 0 && is_sound && found < expected) {
    take(trunk);
    const auto list = is_sound ? page(trunk) : std::nullopt;
    is_sound = list.has_value();
    if (!is_sound) break;
    const std::uint32_t leaves = sqlite_u32(*list, 4);
    is_sound = leaves <= page_bytes_ / 4 - 2;
    for (std::uint32_t i = 0; i < leaves && is_sound; ++i) take(sqlite_u32(*list, 8 + 4 * i));
    trunk = sqlite_u32(*list, 0);
  }
  if (!is_sound || found != expected) {
    damage_.push_back("the list of free pages is damaged");
    is_free_.assign(is_free_.size(), false);
  }
  // A file that has become smaller is cut off when its log is moved into it.
  if (committed_pages_ == 0 || has_torn_pages()) return;
  for (std::uint32_t number = committed_pages_ + 1; number <= pages_; ++number)
    is_free_[number] = true;
}

}  // namespace runstone
