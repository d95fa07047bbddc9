// RollbackPreview: the changes that a rollback would make. A worker computes it; the world strand
// keeps it under an id and answers from it.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/rollback/restore_plan.hpp"
#include "server/rollback/selection.hpp"
#include "server/rollback/should_continue.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

/// The protected ground on which a player without the right `roll_back` takes edits back.
struct OwnGround {
  AuthorId author = 0;  // of the player
  std::string name;     // of the protected box
  VoxelBox box;         // in the protected box; nothing outside changes
};

struct RollbackPreview {
  enum class State { computing, ready, applied };
  /// The functions of somebody who wants to see changes, called on the worker. Both are there or
  /// neither.
  struct PlanViewer {
    /// Gets all chunks that would change, ascending, if there are any. Returns those whose plans
    /// add() shall get.
    std::function<std::vector<ChunkKey>(const std::vector<ChunkKey>& changing)> choose;
    /// Gets the plans of these chunks, one after another.
    std::function<void(const RestorePlan&)> add;
  };
  /// A function that the worker calls after the last plan. It returns lines for the answer, and
  /// returns soon when the answer is no longer wanted.
  using Summary = std::function<std::string(WorldReader& reader, const Generator& generator,
                                            const std::string& id, const ShouldContinue& wanted)>;

  std::uint64_t number = 0;
  State state = State::computing;
  /// The world strand clears it when nobody wants the preview any more. Threads: any.
  std::shared_ptr<std::atomic<bool>> is_wanted = std::make_shared<std::atomic<bool>>(true);
  /// How far compute() is. Threads: any.
  struct Progress {
    std::atomic<std::uint64_t> edits = 0;  // selected; 0 while they are looked for
    std::atomic<std::uint64_t> chunks = 0, chunks_done = 0;
  };
  std::shared_ptr<Progress> progress = std::make_shared<Progress>();
  Sequence rollback = 0;         // first edit of the rollback; 0 until it has written one
  std::optional<OwnGround> own;  // nullopt: of a player with the right `roll_back`

  // The worker writes these in compute(). The world strand reads them after the worker has
  // answered.
  std::shared_ptr<const Selection> selection;
  std::uint64_t voxels = 0, chunks = 0;  // that would change
  /// The line about edits that may match but are no longer in the log. Empty: there are none.
  std::string removed;
  std::string summary, error;  // `error` is empty if the preview could be computed

  /// Returns the id: "p1".
  std::string id() const { return "p" + std::to_string(number); }
  /// Selects edits and counts what would change in each chunk that they touch, up to sequence `end`,
  /// which must be durable. Then plans the chunks that the viewer chooses. Blocks on the disk. The
  /// functions may be empty.
  void compute(WorldReader& reader, const Generator& generator, const SelectionFilter& filter,
               Sequence end, const PlanViewer& viewer, const Summary& summarise);
  /// Returns how far compute() is, as the end of "p1: ". Thread: the world strand.
  std::string progress_text() const;
  /// Returns true if the rollback would change nothing. Requires that compute() succeeded, as for
  /// the texts below.
  bool is_empty() const { return selection->edits == 0 || voxels == 0; }
  /// Returns the answer about an empty preview.
  std::string text_of_nothing() const;
  /// Returns the answer about a preview that is not empty.
  std::string text() const;

 private:
  /// Calls viewer.add() with the plans that it chooses. Sets `error` if one cannot be made.
  void show(RestorePlanner& planner, Sequence end, const std::vector<ChunkKey>& changing,
            const PlanViewer& viewer);
  /// Sets `error`, to "cancelled" if nobody wants the preview any more.
  void fail_with(const StoreError& why) { error = is_wanted->load() ? why.message() : "cancelled"; }
};

}  // namespace runstone
