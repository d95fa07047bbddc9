// PreviewEdits: the edits that the rollback of a preview would write, as far as a client sees them
// and has room for them: those near the centre of its view. One object belongs to one preview.
// Thread: the worker that computes the preview adds, and then the world strand takes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "protocol/codec/messages.hpp"
#include "server/rollback/restore_plan.hpp"

namespace runstone {

class PreviewEdits {
 public:
  explicit PreviewEdits(const View& view) : view_(view) {}

  /// Returns the chunks of these whose edits there may be room for, ascending: those of the view, and
  /// of very many the nearest ones. Requires that `changing` ascend and that each has an edit. Cost:
  /// O(chunks log chunks).
  std::vector<ChunkKey> choose(const std::vector<ChunkKey>& changing);
  /// Adds the edits of a chunk if the view has it. If there is no room for all, drops the edits of
  /// the chunks that are farthest from the centre. Cost: O(runs of the edits + chunks).
  void add(const RestorePlan& plan);
  /// Moves the edits into a message.
  void take(RestorePreview& out);

 private:
  struct Part {
    ChunkCoord at;
    std::int64_t distance = 0;  // of the chunk from the centre, squared
    std::size_t bytes = 0;
    std::vector<EditDescriptor> edits;
  };

  std::int64_t distance_of(ChunkCoord at) const;

  View view_;
  std::vector<Part> parts_;  // a heap; the farthest part is at the front
  std::size_t edits_ = 0, bytes_ = 0;
  bool is_cut_ = false;
};

}  // namespace runstone
