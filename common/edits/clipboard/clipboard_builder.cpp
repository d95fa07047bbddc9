#include "common/edits/clipboard/clipboard_builder.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {

ClipboardBuilder::ClipboardBuilder(Extent extent, AxisOrder order)
    : extent_(extent), order_(order) {
  RUNSTONE_ASSERT(extent.valid_part());
}

void ClipboardBuilder::append(std::uint32_t count, std::optional<Material> cell) {
  if (count == 0) return;
  RUNSTONE_ASSERT(count <= extent_.volume() - filled_);
  filled_ += count;
  if (!stretches_.empty() && stretches_.back().cell == cell) {
    stretches_.back().end = filled_;
  } else {
    stretches_.push_back({filled_, cell});
  }
}

Result<std::shared_ptr<const Clipboard>> ClipboardBuilder::finish() {
  RUNSTONE_ASSERT(filled_ == extent_.volume());
  std::vector<Material> palette;
  for (const Stretch& stretch : stretches_) {
    if (stretch.cell) palette.push_back(*stretch.cell);
  }
  std::sort(palette.begin(), palette.end());
  palette.erase(std::unique(palette.begin(), palette.end()), palette.end());
  if (palette.empty()) return fail(ErrorCode::bad_value, "clipboard has no material");
  // A material takes at least one byte, so a larger palette cannot fit, and its entries could not
  // be numbered.
  if (palette.size() > kClipboardBytesMax) {
    return fail(ErrorCode::limit_exceeded, "clipboard has too many materials");
  }
  RunBuilder cells(extent_, order_);
  for (const Stretch& stretch : stretches_) {
    std::uint16_t number = 0;
    if (stretch.cell) {
      const auto entry = std::lower_bound(palette.begin(), palette.end(), *stretch.cell);
      number = static_cast<std::uint16_t>(entry - palette.begin() + 1);
    }
    cells.append_to(stretch.end, number);
  }
  stretches_.clear();
  filled_ = 0;
  return Clipboard::of(std::move(palette), in_cheapest_order(cells.finish()));
}

}  // namespace runstone
