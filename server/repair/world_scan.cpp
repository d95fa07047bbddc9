#include "server/repair/world_scan.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace runstone {
namespace {

constexpr std::uint64_t kProgressPages = 256;

/// Returns the row of a cell, with its row id in place of the key that stands for it.
std::optional<StoredRow> row_of(PageFile& pages, const PageCell& cell, PageFile::Age age) {
  const auto record = pages.record_of(cell, age);
  // A damaged length may name overflow pages that a short row does not need.
  auto row = decode_stored_row(record ? ByteView(*record) : cell.local);
  if (row && !row->empty() && cell.row_id && std::holds_alternative<std::monostate>(row->front()))
    row->front() = *cell.row_id;
  return row;
}

class Scan {
 public:
  Scan(PageFile& pages, RowProof& proof, const ScanEvents& events)
      : pages_(pages), proof_(proof), events_(events) {}

  StoreResult<void> page(std::uint32_t number, const Bytes& bytes, RowOrigin origin) {
    if (pages_.is_pointer_map(number, bytes)) return {};
    const auto found = cells_of(bytes, PageFile::header_bytes(number), pages_.page_bytes());
    if (!found) {
      const bool is_blank = std::ranges::all_of(bytes, [](std::uint8_t byte) { return byte == 0; });
      if (origin == RowOrigin::used && is_blank) damaged(number, "has only zeros");
      return {};
    }
    std::uint64_t unreadable = found->unreadable;
    for (const PageCell& cell : found->cells) {
      const auto row = row_of(
          pages_, cell, origin == RowOrigin::torn ? PageFile::Age::torn : PageFile::Age::committed);
      unreadable += row ? 0 : 1;
      if (!row) continue;
      const auto table = proof_.table_of(*row);
      if (!table) return failure(table.error());
      if (*table) {
        if (auto taken = events_.on_row(**table, *row, origin); !taken) return taken;
      } else if (const auto likely = RowProof::likely_table_of(*row);
                 likely && origin == RowOrigin::used) {
        if (auto noted = events_.on_damaged_row(*likely, *row); !noted) return noted;
      }
    }
    if (unreadable != 0 && origin == RowOrigin::used)
      damaged(number, std::to_string(unreadable) + " of its rows cannot be read");
    return {};
  }

  void damaged(std::uint32_t number, const std::string& what) {
    lines_.push_back("page " + std::to_string(number) + ": " + what);
  }
  std::vector<std::string> take_lines() { return std::exchange(lines_, {}); }

 private:
  PageFile& pages_;
  RowProof& proof_;
  const ScanEvents& events_;
  std::vector<std::string> lines_;
};

}  // namespace

StoreResult<std::vector<std::string>> scan_world(PageFile& pages, RowProof& proof,
                                                 const ScanEvents& events) {
  Scan scan(pages, proof, events);
  std::uint64_t done = 0;
  for (const RowOrigin origin : {RowOrigin::used, RowOrigin::torn, RowOrigin::free}) {
    if (origin == RowOrigin::torn) {
      for (const auto& [number, bytes] : pages.torn_pages()) {
        if (auto read = scan.page(number, bytes, origin); !read) return failure(read.error());
      }
      continue;
    }
    for (std::uint32_t number = 1; number <= pages.pages(); ++number) {
      if (pages.free_pages()[number] != (origin == RowOrigin::free)) continue;
      if (events.on_progress && ++done % kProgressPages == 0)
        events.on_progress(done, pages.pages());
      const auto bytes = pages.page(number);
      if (!bytes) {
        scan.damaged(number, "cannot be read");
      } else if (auto read = scan.page(number, *bytes, origin); !read) {
        return failure(read.error());
      }
    }
  }
  return scan.take_lines();
}

StoreResult<void> scan_index_pages(
    PageFile& pages, const std::function<StoreResult<void>(const std::vector<IndexEntry>&)>& each) {
  for (std::uint32_t number = 1; number <= pages.pages(); ++number) {
    const auto bytes = pages.page(number);
    if (bytes && pages.is_pointer_map(number, *bytes)) continue;
    const auto found =
        bytes ? cells_of(*bytes, PageFile::header_bytes(number), pages.page_bytes()) : std::nullopt;
    if (!found || pages.free_pages()[number]) continue;
    std::vector<IndexEntry> entries;
    for (const PageCell& cell : found->cells) {
      // An entry has three columns: value, sequence and log. It is too short for overflow pages.
      if (cell.row_id || cell.overflow != 0) continue;
      const auto row = decode_stored_row(cell.local);
      if (!row || row->size() != 3) continue;
      const auto* value = std::get_if<std::int64_t>(&(*row)[0]);
      const auto* seq = std::get_if<std::int64_t>(&(*row)[1]);
      if (value == nullptr || seq == nullptr || (*row)[2] != StoredValue(std::int64_t{0})) continue;
      entries.push_back({*value, static_cast<Sequence>(*seq)});
    }
    if (entries.empty()) continue;
    if (auto taken = each(entries); !taken) return taken;
  }
  return {};
}

}  // namespace runstone
