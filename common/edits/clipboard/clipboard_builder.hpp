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
  /// The cells are appended in the index order of `order`. Requires extent.valid_part().
  explicit ClipboardBuilder(Extent extent, AxisOrder order = AxisOrder::xyz);

  /// Returns the number of cells appended so far.
  std::uint32_t filled() const { return filled_; }
  /// Appends `count` cells; 0 is allowed and does nothing. nullopt is an untouched cell. Requires
  /// filled() + count <= volume. Cost: O(1) amortised.
  void append(std::uint32_t count, std::optional<Material> cell);
  /// Returns the cells in the axis order with the fewest runs. Requires filled() == volume. Fails
  /// with bad_value if no cell is touched, and with limit_exceeded if the encoding would exceed
  /// kClipboardBytesMax. The builder is empty afterwards. Cost: O(runs log runs + lines).
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
