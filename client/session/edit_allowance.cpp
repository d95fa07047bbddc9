#include "client/session/edit_allowance.hpp"

#include <algorithm>

namespace runstone {

void EditAllowance::set(const EditBudget& budget, std::uint16_t chunk_edge) {
  chunk_edge_ = chunk_edge;
  if (budget == budget_) return;
  budget_ = budget;
  left_ = TokenBucket(budget.per_second, budget.burst);
}

TimeUs EditAllowance::wait_us(const EditDescriptor& edit, TimeUs now_us, std::uint64_t left) {
  const std::uint64_t price = edit_price(edit, chunk_edge_, budget_, clipboard_bytes_);
  return left_.wait_us(std::max(price, std::min(price + left, budget_.burst)), now_us);
}

void EditAllowance::pay(const EditDescriptor& edit, TimeUs now_us) {
  left_.take(edit_price(edit, chunk_edge_, budget_, clipboard_bytes_), now_us);
}

}  // namespace runstone
