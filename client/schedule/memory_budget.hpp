// MemoryBudget: bounds the memory of a client, whatever its server sends. A few bytes on the wire
// can become a chunk with a run and three quads for each voxel. Bounds of the network cannot
// prevent this, so the client counts what it keeps.
//   - If it keeps more than the budget, the view shrinks by one step. The farthest chunks leave it,
//     so that the near ones stay. The chunk at the player always stays.
//   - If the view is complete and the next larger one should fit, the view grows by one step. The
//     server then sends the chunks that were given up. The estimate assumes that all chunks are
//     equal. If it was wrong, the view shrinks again, and the pause before the next attempt
//     doubles.
// The budget may be exceeded by what arrives between two calls of step(). Pure. One thread.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

/// The memory that a client keeps, in bytes.
struct MemoryUse {
  std::size_t chunks = 0;    // confirmed and shown runs, commits held back, pending edits
  std::size_t edits = 0;     // local edits
  std::size_t meshes = 0;    // the newest mesh of each chunk
  std::size_t gpu = 0;       // uploaded quads; a software driver keeps them in main memory
  std::size_t textures = 0;  // pictures, their levels, and their copy on the GPU
  std::size_t total() const { return chunks + edits + meshes + gpu + textures; }
};

/// The radii of a view, in chunks.
struct ViewRadii {
  std::uint8_t h = 0, v = 0;  // horizontal, vertical
  friend bool operator==(const ViewRadii&, const ViewRadii&) = default;
};

class MemoryBudget {
 public:
  /// The least time between a change of the view and its next growth. It doubles up to the maximum
  /// while growths fail.
  static constexpr TimeUs kGrowPauseUs = 2'000'000;
  static constexpr TimeUs kGrowPauseUsMax = 128'000'000;

  MemoryBudget(std::size_t bytes_max, ViewRadii wanted);

  /// Sets the radii of the view that is wanted. If they are new, the view has these radii again.
  void set_wanted(ViewRadii wanted);
  /// Compares the use with the budget, and changes the view by one step at most. `is_complete`: all
  /// chunks of the view have arrived and were meshed, so that the use is that of the whole view.
  /// Returns true if radii() changed.
  bool step(const MemoryUse& use, bool is_complete, TimeUs now_us);

  ViewRadii radii() const { return radii_of(level_); }
  ViewRadii wanted() const { return wanted_; }
  /// Returns true if the view is smaller than wanted.
  bool binds() const { return level_ < level_max(); }
  std::size_t bytes_max() const { return bytes_max_; }
  /// Returns what is left of the budget.
  std::size_t room(const MemoryUse& use) const {
    return use.total() < bytes_max_ ? bytes_max_ - use.total() : 0;
  }

  // Since the start.
  std::uint64_t shrinks() const { return shrinks_; }
  std::uint64_t growths() const { return growths_; }
  /// Returns the greatest use that step() has seen.
  std::size_t peak_bytes() const { return peak_bytes_; }

 private:
  std::uint8_t level_max() const { return wanted_.h > wanted_.v ? wanted_.h : wanted_.v; }
  ViewRadii radii_of(std::uint8_t level) const;
  bool should_fit(const MemoryUse& use, std::uint8_t level) const;

  const std::size_t bytes_max_;
  ViewRadii wanted_;
  std::uint8_t level_;  // of level_max(); the radii are in proportion
  TimeUs changed_us_ = 0;
  TimeUs pause_us_ = kGrowPauseUs;
  bool grew_last_ = false;  // the last change was a growth
  std::uint64_t shrinks_ = 0, growths_ = 0;
  std::size_t peak_bytes_ = 0;
};

}  // namespace runstone
