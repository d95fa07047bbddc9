// Clipboard: what a paste puts into the world: a cuboid of cells, each of them a material (empty included) or
// untouched, which leaves what is there. Kept as runs, like a chunk, beside the list of its materials.
// Invariants (Clipboard::of() checks them; bytes from outside pass through it too):
//   - sides 1 .. kSideMax, the runs are canonical, and at least one cell is touched;
//   - the palette ascends strictly and each entry is used: a cell number is 0 (untouched) or palette index + 1;
//   - the encoding has at most kClipboardBytesMax bytes.
// The axis order is part of a clipboard: the same cells in another order are another clipboard, since runs
// and bytes differ. Builders choose the order with the fewest runs.
// Threads: immutable, so shared freely.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Answers an edit request that would fill the memory of everybody in view: a byte is at most one run.
inline constexpr std::size_t kClipboardBytesMax = 48 * 1024;

/// Cells of a clipboard.
struct CellBox {
  LocalPos first;
  Extent extent;
  friend bool operator==(const CellBox&, const CellBox&) = default;
};

class Clipboard {
 public:
  /// `cells` holds cell numbers in place of materials. bad_value, not_canonical, broken_invariant or
  /// limit_exceeded name the first broken invariant. O(runs + palette).
  static Result<std::shared_ptr<const Clipboard>> of(std::vector<Material> palette, RunChunk cells);

  Extent extent() const { return cells_.extent; }
  const RunChunk& cells() const { return cells_; }
  const std::vector<Material>& palette() const { return palette_; }
  /// Material of a cell number above 0.
  Material material(std::uint16_t number) const { return palette_[number - 1U]; }
  /// Number of cells that are not untouched, at least 1.
  std::uint32_t touched() const { return touched_; }
  /// Smallest box that holds these.
  const CellBox& touched_box() const { return touched_box_; }
  std::size_t byte_size() const { return byte_size_; }  // of the encoding
  /// Nothing where untouched. Requires a place inside the extent. O(log runs).
  std::optional<Material> at(LocalPos place) const;

  friend bool operator==(const Clipboard& a, const Clipboard& b) {
    return a.palette_ == b.palette_ && a.cells_ == b.cells_;
  }

 private:
  Clipboard(std::vector<Material> palette, RunChunk cells)
      : palette_(std::move(palette)), cells_(std::move(cells)) {}
  std::vector<Material> palette_;
  RunChunk cells_;
  std::uint32_t touched_ = 0;
  CellBox touched_box_;
  std::size_t byte_size_ = 0;
};

/// Appends the canonical bytes (docs/edit-log.md).
void write_clipboard(ByteWriter& w, const Clipboard& clipboard);

/// Reads all that is left. Only canonical bytes pass; null after a rejection. Allocates no more than the bytes
/// at hand ask for.
std::shared_ptr<const Clipboard> read_clipboard(ByteReader& r);

}  // namespace runstone
