#include "common/edits/apply/run_patch.hpp"

#include "common/core/assert.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone {
namespace {

// Builds one area at a time from old runs [first_, last_) and the changes in them.
template <class Runs>
class Planner {
 public:
  Planner(Runs old, std::vector<EditArea>& areas, std::vector<Run>& runs)
      : old_(old), areas_(areas), runs_(runs), cursor_(old), area_start_(runs.size()) {}

  void change(const Change& c) {
    cursor_.seek(c.first);
    const std::size_t from = cursor_.run();
    // A kept neighbour of the new material would merge with the change, so it belongs to the area.
    const bool merges =
        from > 0 && old_.end(from - 1) == c.first && old_.material(from - 1) == c.material;
    const std::size_t low = merges ? from - 1 : from;
    if (!open_ || low > last_) {
      close();
      open_ = true;
      first_ = copied_ = low;
      at_ = low == 0 ? 0 : old_.end(low - 1);
    }
    copy_to(c.first);
    put(c.last, c.material);
    at_ = c.last;
    cursor_.seek(c.last - 1);
    std::size_t to = cursor_.run();
    if (old_.end(to) == c.last) {
      copied_ = to + 1;
      if (to + 1 < old_.size() && old_.material(to + 1) == c.material) ++to;
    } else {
      copied_ = to;
    }
    last_ = to + 1;
  }

  void close() {
    if (!open_) return;
    copy_to(old_.end(last_ - 1));
    const std::size_t before = last_ - first_;
    const std::size_t after = runs_.size() - area_start_;
    areas_.push_back({static_cast<std::uint32_t>(static_cast<std::ptrdiff_t>(first_) + grown_),
                      static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(after)});
    grown_ += static_cast<std::ptrdiff_t>(after) - static_cast<std::ptrdiff_t>(before);
    area_start_ = runs_.size();
    open_ = false;
  }

 private:
  // Copies the old voxels from at_ up to `end`. copied_ is the old run that covers at_.
  void copy_to(VoxelIndex end) {
    while (at_ < end) {
      const VoxelIndex run_end = old_.end(copied_);
      const VoxelIndex stop = run_end < end ? run_end : end;
      put(stop, old_.material(copied_));
      if (run_end == stop) ++copied_;
      at_ = stop;
    }
  }

  void put(VoxelIndex end, Material material) {
    if (runs_.size() > area_start_ && runs_.back().material == material) {
      runs_.back().end = end;
    } else {
      runs_.push_back({end, material});
    }
  }

  Runs old_;
  std::vector<EditArea>& areas_;
  std::vector<Run>& runs_;
  RunCursor<Runs> cursor_;
  std::size_t area_start_;
  bool open_ = false;
  std::size_t first_ = 0, last_ = 0;  // old runs of the open area
  std::size_t copied_ = 0;
  VoxelIndex at_ = 0;
  std::ptrdiff_t grown_ = 0;  // new runs minus old runs so far
};

}  // namespace

void plan_patch(const RunChunk& chunk, std::span<const Change> changes,
                std::vector<EditArea>& areas, std::vector<Run>& runs) {
  chunk.runs.visit([&]<class Runs>(Runs old) {
    Planner<Runs> planner(old, areas, runs);
    for (const Change& c : changes) planner.change(c);
    planner.close();
  });
}

PatchWrite cheaper_write(const RunChunk& chunk, std::span<const EditArea> areas) {
  // A moved run costs a small part of a copied run (memmove against a loop), and a splice has a
  // fixed cost.
  constexpr std::size_t kMovedPerCopied = 16;
  constexpr std::size_t kSpliceCopies = 16;
  if (areas.size() < 2) return PatchWrite::pieces;
  const std::size_t tail = chunk.runs.size() - areas.front().first;
  const std::size_t pieces = areas.size() * (kSpliceCopies + tail / kMovedPerCopied);
  return pieces < kSpliceCopies + tail ? PatchWrite::pieces : PatchWrite::whole;
}

void write_patch(RunChunk& chunk, std::span<const EditArea> areas, std::span<const Run> runs,
                 PatchWrite how, std::vector<Run>& scratch) {
  if (areas.empty()) return;
  std::size_t used = 0;
  if (how == PatchWrite::pieces) {
    for (const EditArea& area : areas) {
      chunk.runs.splice(area.first, area.before, runs.subspan(used, area.after));
      used += area.after;
    }
    RUNSTONE_DASSERT(used == runs.size());
    return;
  }
  scratch.clear();
  // The first area has the same index before and after.
  const std::size_t first = areas.front().first;
  std::size_t old = first;
  chunk.runs.visit([&](const auto& from) {
    for (const EditArea& area : areas) {
      while (first + scratch.size() < area.first) {
        scratch.push_back({from.end(old), from.material(old)});
        ++old;
      }
      const auto in = runs.subspan(used, area.after);
      scratch.insert(scratch.end(), in.begin(), in.end());
      used += area.after;
      old += area.before;
    }
  });
  RUNSTONE_DASSERT(used == runs.size());
  chunk.runs.splice(first, old - first, scratch);
}

}  // namespace runstone
