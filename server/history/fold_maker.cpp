#include "server/history/fold_maker.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/runs/reorder.hpp"
#include "server/history/base_chunk.hpp"

namespace runstone {
namespace {

// Smaller folds take hardly less time, because most of it is then the wait for the disk.
constexpr FoldSize kFoldSizeMax{4'096, 128}, kFoldSizeMin{128, 16};

}  // namespace

FoldSize next_fold_size(const FoldSize& now, std::chrono::microseconds taken) {
  FoldSize next = now;
  if (taken > kFoldTimeMax) {
    next = {now.edits_max / 2, now.chunks_max / 2};
  } else if (taken < kFoldTimeMax / 2) {
    next = {now.edits_max + now.edits_max / 4, now.chunks_max + now.chunks_max / 4};
  }
  return {std::clamp(next.edits_max, kFoldSizeMin.edits_max, kFoldSizeMax.edits_max),
          std::clamp(next.chunks_max, kFoldSizeMin.chunks_max, kFoldSizeMax.chunks_max)};
}

StoreResult<std::optional<LogFold>> FoldMaker::next(Sequence until, const FoldSize& size) {
  // Head, log and base are read at one moment.
  if (const auto begun = reader_.begin_reads(); !begun) return failure(begun.error());
  auto fold = read(until, size);
  if (const auto ended = reader_.end_reads(); !ended && fold) return failure(ended.error());
  return fold;
}

StoreResult<std::optional<LogFold>> FoldMaker::read(Sequence until, const FoldSize& size) {
  const auto head = reader_.log_head();
  if (!head) return failure(head.error());
  const std::int32_t edge = reader_.meta().chunk_edge;
  LogFold fold;
  fold.from = head->version.seq;
  fold.to = *head;
  const Sequence last = std::min(until, fold.from + std::max<Sequence>(size.edits_max, 1));
  std::map<ChunkKey, ReplayedChunk> chunks;
  std::optional<StoreError> wrong;
  const auto read = reader_.read_log(fold.from + 1, last, [&](const EditRecord& record) {
    const std::vector<ChunkCoord> touched = touched_chunks(record.edit, edge);
    const auto added = static_cast<std::size_t>(std::ranges::count_if(
        touched, [&](const ChunkCoord& at) { return !chunks.contains({0, at}); }));
    const bool is_first = fold.to.version.seq == fold.from;
    if (!is_first && chunks.size() + added > size.chunks_max) return false;
    for (const ChunkCoord& at : touched) {
      const ChunkKey key{0, at};
      auto found = chunks.find(key);
      if (found == chunks.end()) {
        auto base = base_chunk_in_any_order(reader_, generator_, key);
        if (!base) {
          wrong = base.error();
          return false;
        }
        found = chunks.emplace(key, ReplayedChunk(*std::move(base), origin_of(at, edge))).first;
      }
      found->second.add(record.edit, record.version, scratch_);
    }
    fold.to = {record.version, record.time_us};
    return true;
  });
  if (!read) return failure(read.error());
  if (wrong) return failure(*std::move(wrong));
  if (fold.to.version.seq == fold.from) return std::optional<LogFold>();
  for (auto& [key, replayed] : chunks) {
    replayed.flush(scratch_);
    Chunk chunk = std::move(replayed.chunk());
    chunk.voxels = in_cheapest_order(std::move(chunk.voxels));
    fold.chunks.emplace_back(key, std::make_shared<const Chunk>(std::move(chunk)));
  }
  return std::optional(std::move(fold));
}

}  // namespace runstone
