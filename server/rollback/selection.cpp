#include "server/rollback/selection.hpp"

#include <algorithm>
#include <set>

#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {
namespace {

/// Adds records to a selection, in any order.
class Collector {
 public:
  explicit Collector(const LogReader& reader)
      : file_(reader.file()), edge_(reader.meta().chunk_edge) {
    selection_.chunk_edge = edge_;
  }

  void keep_inside(const std::optional<VoxelBox>& box) { selection_.box = box; }

  /// Returns false if the selection is full.
  bool take(const EditRecord& record) {
    const std::optional<VoxelBox>& box = selection_.box;
    bool is_inside = false;
    touched_chunks(record.edit, edge_, touched_);
    for (const ChunkCoord at : touched_) {
      if (box && intersect(*box, box_of(at, edge_)).empty()) continue;
      if (++touches_ > kSelectionTouchesMax) return false;
      selection_.chunks[{0, at}].push_back(record.version.seq);
      is_inside = true;
    }
    if (!is_inside) return true;  // only the edit's bounding box overlaps `box`
    const bool is_first = selection_.edits++ == 0;
    if (is_first || record.version.seq < selection_.first) {
      selection_.first = record.version.seq;
      selection_.first_us = record.time_us;
    }
    if (is_first || record.version.seq > selection_.last) {
      selection_.last = record.version.seq;
      selection_.last_us = record.time_us;
    }
    return true;
  }

  Selection finish() {
    for (auto& [key, edits] : selection_.chunks) std::sort(edits.begin(), edits.end());
    return std::move(selection_);
  }

  Unexpected<StoreError> too_large() const {
    return {{StoreError::Kind::bad_request, file_, "edit_log",
             "the selection is too large: ask for a shorter time or a smaller box"}};
  }

 private:
  std::string file_;
  std::int32_t edge_;
  Selection selection_;
  std::vector<ChunkCoord> touched_;  // by the present record
  std::uint64_t touches_ = 0;
};

}  // namespace

std::optional<VoxelBox> Selection::area() const {
  std::optional<VoxelBox> all;
  for (const auto& [key, in_chunk] : chunks) {
    const VoxelBox one = box_of(key.at, chunk_edge);
    if (!all) all = one;
    all->min = {std::min(all->min.x, one.min.x), std::min(all->min.y, one.min.y),
                std::min(all->min.z, one.min.z)};
    all->max = {std::max(all->max.x, one.max.x), std::max(all->max.y, one.max.y),
                std::max(all->max.z, one.max.z)};
  }
  return all && box ? intersect(*all, *box) : all;
}

StoreResult<Selection> select_edits(LogReader& reader, const SelectionFilter& filter,
                                    const ShouldContinue& should_continue) {
  LogQuery query;
  query.from_us = filter.from_us;
  query.until_us = filter.until_us;
  query.box = filter.box;
  query.cause = filter.cause;
  query.first = filter.first;
  query.last = filter.last;
  Collector collector(reader);
  collector.keep_inside(filter.box);
  std::set<AuthorId> authors(filter.authors.begin(), filter.authors.end());
  const bool is_one_pass = authors.empty() || authors.size() > kSearchedAuthorsMax;
  const auto admits = [&](AuthorId author) {
    return (authors.empty() || authors.contains(author)) &&
           !std::ranges::binary_search(filter.excluded_authors, author);
  };
  bool has_room = true;
  bool is_wanted = true;
  const auto run = [&]() {
    return reader.query_log(query, [&](const EditRecord& record) {
      is_wanted = !should_continue || should_continue();
      if (is_wanted && admits(record.op.author)) has_room = collector.take(record);
      return is_wanted && has_room;
    });
  };
  StoreResult<void> done;
  if (is_one_pass) done = run();
  for (const AuthorId author : authors) {
    if (is_one_pass) break;
    query.author = author;
    if (done && has_room && is_wanted) done = run();
  }
  if (!done) return failure(done.error());
  if (!is_wanted) return cancelled(reader);
  if (!has_room) return collector.too_large();
  return collector.finish();
}

StoreResult<Selection> select_edits(LogReader& reader, const std::vector<Sequence>& edits,
                                    const ShouldContinue& should_continue) {
  Collector collector(reader);
  bool has_room = true;
  for (const Sequence seq : edits) {
    if (should_continue && !should_continue()) return cancelled(reader);
    const auto read = reader.read_log(seq, seq, [&](const EditRecord& record) {
      has_room = has_room && collector.take(record);
      return true;
    });
    if (!read) return failure(read.error());
    if (!has_room) return collector.too_large();
  }
  return collector.finish();
}

}  // namespace runstone
