#include "protocol/rules/edit_price.hpp"

#include <algorithm>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/limits.hpp"

namespace runstone {

std::uint64_t edit_price(const EditDescriptor& edit, std::uint16_t chunk_edge,
                         const EditBudget& budget, std::size_t clipboard_bytes) {
  const std::uint64_t chunks =
      std::min<std::uint64_t>(touched_chunks_bound(edit, chunk_edge), kTouchedChunksMax);
  std::uint64_t price = std::max<std::uint64_t>(1, chunks * EditPrices::kChunk);
  if (const auto* paste = std::get_if<Paste>(&edit.shape)) {
    const std::uint64_t bytes = paste->clipboard->byte_size() + clipboard_bytes - 1;
    price += bytes / clipboard_bytes * EditPrices::kClipboardPart;
  }
  if (rights_change_of(edit) != nullptr) price += encode(edit).size() / EditPrices::kRightsBytes;
  return budget.is_limited() ? std::min(price, budget.burst) : price;
}

}  // namespace runstone
