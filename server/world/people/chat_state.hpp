// ChatState: the chat on the world strand: the newest lines, and what players may still write.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "common/core/budget.hpp"
#include "common/core/token_bucket.hpp"
#include "protocol/limits.hpp"
#include "server/limits/budget_ledger.hpp"
#include "server/world/environment/chat_entry.hpp"

namespace runstone {

/// Lines that a player who joins gets. One more is the message of the day.
inline constexpr std::size_t kChatRecentMax = 50;
static_assert(kChatRecentMax + 1 <= kChatLinesMax);
/// The greatest number of sent lines that are kept. Only these can be withdrawn.
inline constexpr std::size_t kChatKeptMax = 128;
static_assert(kChatRecentMax <= kChatKeptMax && kChatKeptMax <= kChatWithdrawnMax);
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

  /// Adds a line to `sent`.
  void add(ChatEntry line) {
    sent.push_back(std::move(line));
    if (sent.size() > kChatKeptMax) sent.pop_front();
  }

  std::deque<ChatEntry> sent;      // at most kChatKeptMax, the newest last
  std::vector<ChatEntry> waiting;  // for the next broadcast(), fewer than kChatLinesMax
  BudgetLedger ledger;
  TokenBucket all{kChatLinesPerSecond, kChatLinesAtOnce};
};

}  // namespace runstone
