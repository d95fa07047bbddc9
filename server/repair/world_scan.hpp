// world_scan: every row that can be read in the pages of a damaged world. The pages are read one
// after another, not along the trees, so that a damaged page costs the rows in it and no others.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "server/repair/found_row.hpp"
#include "server/repair/page_file.hpp"

namespace runstone {

/// Where a row was found. A scan reads the origins in this order.
enum class RowOrigin {
  used,  // a page of the database, as the last commit left it
  torn,  // a frame behind the first damaged one of the write-ahead log; its rows may be newer
  free   // a page on the list of free pages; its rows may be older than a compaction
};

struct ScanEvents {
  std::function<StoreResult<void>(FoundTable, const StoredRow&, RowOrigin)> on_row;
  /// A row in a used page whose checksum is wrong. Its columns are not proven.
  std::function<StoreResult<void>(FoundTable, const StoredRow&)> on_damaged_row;
  /// Gets the number of pages that were read, and that of all.
  std::function<void(std::uint64_t, std::uint64_t)> on_progress;
};

/// Calls the events for all rows: first those of used pages, then those of torn frames, then those
/// of free pages. Returns a line for each damaged page. Fails as the events, or if the database of
/// `proof` fails. Cost: O(bytes of the files).
StoreResult<std::vector<std::string>> scan_world(PageFile& pages, RowProof& proof,
                                                 const ScanEvents& events);

/// An entry of an index of the log: the value of a column of the record `seq`.
struct IndexEntry {
  std::int64_t value = 0;
  Sequence seq = 0;
};
/// Calls `each` for the entries of each page of an index of the log by author or by cause. The
/// pages do not say which of the two it is.
StoreResult<void> scan_index_pages(
    PageFile& pages, const std::function<StoreResult<void>(const std::vector<IndexEntry>&)>& each);

}  // namespace runstone
