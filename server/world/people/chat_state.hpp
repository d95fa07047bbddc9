// ChatState: the chat on the world strand: the newest lines, and what players may still write.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "common/core/budget.hpp"
#include "common/core/token_bucket.hpp"
#include "protocol/codec/chat_messages.hpp"
#include "protocol/limits.hpp"
#include "server/limits/budget_ledger.hpp"

namespace runstone {

/// Lines that a player who joins gets. One more is the message of the day.
inline constexpr std::size_t kChatRecentMax = 50;
static_assert(kChatRecentMax + 1 <= kChatLinesMax);
/// The lines that all players together may write. The bound exists because each line is sent to
/// every session.
inline constexpr std::uint64_t kChatLinesPerSecond = 20, kChatLinesAtOnce = 60;
/// A line costs so much, of chat_per_minute units a second.
inline constexpr std::uint64_t kChatPrice = 60;

/// Returns the budget of a player who may write so many lines a minute, a few of them at once; 0:
/// no limit.
constexpr Budget chat_budget(std::uint64_t per_minute) {
  constexpr std::uint64_t kAtOnceMax = 10;
  return {per_minute, kChatPrice * (per_minute < kAtOnceMax ? per_minute : kAtOnceMax)};
}

struct ChatState {
  ChatState(const Budget& of_key, std::uint64_t budgets_per_address)
      : ledger(of_key, budgets_per_address) {}

  /// Adds a line to `recent`.
  void add(const ChatLine& line) {
    recent.push_back(line);
    if (recent.size() > kChatRecentMax) recent.pop_front();
  }

  std::deque<ChatLine> recent;    // that were sent, at most kChatRecentMax, the newest last
  std::vector<ChatLine> waiting;  // for the next broadcast_chat(), fewer than kChatLinesMax
  BudgetLedger ledger;
  TokenBucket all{kChatLinesPerSecond, kChatLinesAtOnce};
};

}  // namespace runstone
