// EditAllowance: what is left of the player's edit budget, as far as this client knows. It predicts
// the Quotas of the server, so that the client does not show edits that the server will reject. The
// server may reject an edit nevertheless: other sessions of the same key use the same budget, and
// all players of an address share another one.
// Thread: one. Times are arguments (microseconds of the client's steady clock).
#pragma once
#include <cstdint>

#include "common/core/token_bucket.hpp"
#include "protocol/rules/edit_price.hpp"

namespace runstone {

class EditAllowance {
 public:
  /// Takes the budget of Welcome or Permissions. A budget that stays the same is not filled again,
  /// because the server remembers it over a reconnection, too.
  void set(const EditBudget& budget, std::uint16_t chunk_edge);
  /// Sets the price of a clipboard, see edit_price(). It is EditPrices::kClipboardBytes at first.
  void set_clipboard_bytes(std::size_t bytes) { clipboard_bytes_ = bytes; }
  /// The part of the budget that a large action leaves, in units. A click costs one.
  static constexpr std::uint64_t kLeftForClicks = 20;

  /// Returns how long the player must wait before this edit: 0 if it is paid by what is left, and
  /// `left` units remain or the budget is full.
  TimeUs wait_us(const EditDescriptor& edit, TimeUs now_us, std::uint64_t left = 0);
  /// Pays for an edit. Requires wait_us() == 0.
  void pay(const EditDescriptor& edit, TimeUs now_us);
  /// Call it when the server rejected an edit because a budget is used up.
  void refused(TimeUs now_us) { left_.drain(now_us); }

 private:
  EditBudget budget_;
  std::uint16_t chunk_edge_ = 32;
  std::size_t clipboard_bytes_ = EditPrices::kClipboardBytes;
  TokenBucket left_{0, 0};
};

}  // namespace runstone
