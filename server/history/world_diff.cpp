#include "server/history/world_diff.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "common/core/key_text.hpp"
#include "common/edits/apply/edit_changes.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/restore/restore.hpp"

namespace runstone {

namespace {

struct Written {
  EditDescriptor edit;
  AuthorId author = 0;
};

/// The edits between the moments, and for each chunk the indices of those that touched it.
struct Between {
  std::vector<Written> edits;
  std::map<ChunkCoord, std::vector<std::uint32_t>> chunks;
};

StoreError cancelled(const WorldReader& reader) {
  return {StoreError::Kind::cancelled, reader.file(), "edit_log", "was not read to the end"};
}

StoreResult<Between> read_between(WorldReader& reader, Sequence from, Sequence to,
                                  const WorldAt::Progress& progress) {
  Between between;
  const std::int32_t edge = reader.meta().chunk_edge;
  bool is_cancelled = false;
  const auto read = reader.read_log(from + 1, to, [&](const EditRecord& record) {
    const auto index = static_cast<std::uint32_t>(between.edits.size());
    for (const ChunkCoord& at : touched_chunks(record.edit, edge))
      between.chunks[at].push_back(index);
    between.edits.push_back({record.edit, record.op.author});
    if (progress && record.version.seq % WorldAt::kProgressEdits == 0)
      is_cancelled = !progress(record.version.seq, to);
    return !is_cancelled;
  });
  if (!read) return failure(read.error());
  if (is_cancelled) return failure(cancelled(reader));
  if (between.edits.size() != to - from) {
    return failure(StoreError{StoreError::Kind::bad_request, reader.file(), "edit_log",
                              "was shortened by retention while it was read; begin again"});
  }
  return between;
}

/// Applies edits to one chunk and records their authors.
class ChunkDiff {
 public:
  ChunkDiff(RunChunk before, VoxelPos origin)
      : before_(before),
        now_(std::move(before)),
        origin_(origin),
        writers_(uniform_chunk(now_.extent, 0, now_.order)) {}

  /// Returns false if the chunk has more authors than there are materials.
  bool add(const Written& written, ApplyScratch& scratch, ApplyResult& result) {
    apply_stack(now_, digest_, origin_, {&written.edit, 1}, scratch, result);
    const std::span<const Change> changes = changes_of(scratch, result);
    if (changes.empty()) return true;
    const auto found = std::find(authors_.begin(), authors_.end(), written.author);
    const auto slot = static_cast<std::size_t>(found - authors_.begin()) + 1;
    if (slot > 0xffff) return false;
    if (found == authors_.end()) authors_.push_back(written.author);
    painted_.assign(changes.begin(), changes.end());
    for (Change& change : painted_) change.material = static_cast<Material>(slot);
    write_changes(writers_, painted_, scratch);
    return true;
  }

  /// Adds the voxels that differ to the counts of their authors. Returns the sum.
  std::uint64_t count(std::map<AuthorId, std::uint64_t>& by_author) const {
    std::vector<Difference> differences;
    append_differences(now_, before_, differences);
    std::uint64_t sum = 0;
    for (const Difference& difference : differences) {
      VoxelIndex at = difference.first;
      for (std::size_t run = find_run(writers_, at); at < difference.last; ++run) {
        const VoxelIndex end = std::min(difference.last, writers_.runs.end(run));
        by_author[authors_[std::size_t{writers_.runs.material(run)} - 1]] += end - at;
        at = end;
      }
      sum += difference.last - difference.first;
    }
    return sum;
  }

 private:
  const RunChunk before_;
  RunChunk now_;
  VoxelPos origin_;
  RunChunk writers_;  // a voxel is 0 if no edit changed it, else 1 + index of authors_
  std::vector<AuthorId> authors_;
  std::vector<Change> painted_;
  Digest digest_;  // apply_stack() needs one; its value is not used
};

}  // namespace

StoreResult<WorldDiff> diff_world(WorldReader& reader, const Generator& generator, Sequence from,
                                  Sequence to, const WorldAt::Progress& progress) {
  const auto last = reader.last_sequence();
  if (!last) return failure(last.error());
  if (from > to || to > *last) {
    return failure(StoreError{
        StoreError::Kind::bad_request, reader.file(), "edit_log",
        from > to ? "seq=" + std::to_string(from) + " is behind seq=" + std::to_string(to)
                  : "ends at seq=" + std::to_string(*last)});
  }
  auto world = WorldAt::open(reader, generator, from, progress);
  if (!world) return failure(world.error());
  const auto between = read_between(reader, from, to, progress);
  if (!between) return failure(between.error());

  WorldDiff diff;
  diff.from = from;
  diff.to = to;
  diff.edits = between->edits.size();
  std::map<AuthorId, std::uint64_t> edits, voxels;
  for (const Written& written : between->edits) ++edits[written.author];
  ApplyScratch scratch;
  ApplyResult result;
  for (const auto& [at, touching] : between->chunks) {
    const ChunkKey key{0, at};
    auto start = world->chunk(key);
    if (!start) return failure(start.error());
    ChunkDiff chunk(std::move(start->voxels), origin_of(at, reader.meta().chunk_edge));
    for (const std::uint32_t index : touching) {
      if (!chunk.add(between->edits[index], scratch, result)) {
        return failure(StoreError{StoreError::Kind::bad_request, reader.file(),
                                  "chunk=" + text_of(key),
                                  "was written by more than 65535 authors between these moments"});
      }
    }
    const std::uint64_t changed = chunk.count(voxels);
    diff.voxels += changed;
    if (changed > 0) diff.chunks.push_back({key, touching.size(), changed});
    if (progress && !progress(to, to)) return failure(cancelled(reader));
  }
  for (const auto& [author, count] : edits) diff.authors.push_back({author, count, voxels[author]});
  std::sort(diff.chunks.begin(), diff.chunks.end(), [](const auto& a, const auto& b) {
    return std::tuple(b.voxels, a.key) < std::tuple(a.voxels, b.key);
  });
  std::sort(diff.authors.begin(), diff.authors.end(), [](const auto& a, const auto& b) {
    return std::tuple(b.voxels, b.edits, a.author) < std::tuple(a.voxels, a.edits, b.author);
  });
  return diff;
}

}  // namespace runstone
