// Clipboard: the content of a paste. It is a cuboid of cells; each cell is a material (empty
// included) or untouched, which keeps the present voxel. It is kept as runs, like a chunk, with a
// list of its materials. Invariants (Clipboard::of() checks them; bytes from outside pass through
// it too):
//   - sides are 1 .. kSideMax, the runs are canonical, and at least one cell is touched;
//   - the palette ascends strictly and each entry is used: a cell number is 0 (untouched) or
//     palette index + 1;
//   - the encoding has at most kClipboardBytesMax bytes.
//
// The axis order is part of a clipboard: the same cells in another order are another clipboard,
// because runs and bytes differ. Builders choose the order with the fewest runs. Thread: immutable,
// so any thread may read it.
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

/// The maximum size of an encoded clipboard. A byte encodes at most one run, so this bounds the
/// memory that one edit request takes at every client that sees it.
inline constexpr std::size_t kClipboardBytesMax = 48 * 1024;

/// A box of cells of a clipboard.
struct CellBox {
  LocalPos first;
  Extent extent;
  friend bool operator==(const CellBox&, const CellBox&) = default;
};

class Clipboard {
 public:
  /// Makes a clipboard. `cells` holds cell numbers in place of materials. Fails with bad_value,
  /// not_canonical, broken_invariant or limit_exceeded for the first broken invariant. Cost: O(runs
  /// + palette).
  static Result<std::shared_ptr<const Clipboard>> of(std::vector<Material> palette, RunChunk cells);

  Extent extent() const { return cells_.extent; }
  const RunChunk& cells() const { return cells_; }
  const std::vector<Material>& palette() const { return palette_; }
  /// Returns the material of a cell number. Requires number > 0.
  Material material(std::uint16_t number) const { return palette_[number - 1U]; }
  /// Returns the number of touched cells, at least 1.
  std::uint32_t touched() const { return touched_; }
  /// Returns the smallest box that holds the touched cells.
  const CellBox& touched_box() const { return touched_box_; }
  std::size_t byte_size() const { return byte_size_; }  // of the encoding
  /// Returns the bytes of memory that the clipboard takes.
  std::size_t memory_bytes() const {
    return sizeof(Clipboard) + cells_.runs.byte_capacity() + palette_.capacity() * sizeof(Material);
  }
  /// Returns the material of a cell, or nullopt if it is untouched. Requires a place inside the
  /// extent. Cost: O(log runs).
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

/// Reads all remaining bytes. Only canonical bytes pass. Returns null after a rejection. The memory
/// it allocates is proportional to the bytes present.
std::shared_ptr<const Clipboard> read_clipboard(ByteReader& r);

}  // namespace runstone
