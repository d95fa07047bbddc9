// ClipboardBuilder: makes a clipboard from stretches of cells in index order, in any axis order.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/edits/clipboard/clipboard.hpp"

namespace runstone {

class ClipboardBuilder {
 public:
  /// Requires extent.valid_part(). Cells will come in the index order of `order`.
  explicit ClipboardBuilder(Extent extent, AxisOrder order = AxisOrder::xyz);

  /// Cells appended so far.
  std::uint32_t filled() const { return filled_; }
  /// Appends `count` cells (0 is allowed and does nothing); nothing is untouched. Requires filled() + count <=
  /// volume. O(1) amortised.
  void append(std::uint32_t count, std::optional<Material> cell);
  /// The cells in the axis order with the fewest runs. Requires filled() == volume. bad_value if nothing is
  /// touched, limit_exceeded if it would take more than kClipboardBytesMax. The builder is used up. O(runs log
  /// runs + lines).
  Result<std::shared_ptr<const Clipboard>> finish();

 private:
  struct Stretch {
    std::uint32_t end = 0;
    std::optional<Material> cell;
  };
  Extent extent_;
  AxisOrder order_;
  std::uint32_t filled_ = 0;
  std::vector<Stretch> stretches_;  // neighbours differ
};

}  // namespace runstone
