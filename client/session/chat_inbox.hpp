// ChatInbox: the lines of the chat that arrived and were not drained yet. The server sends the
// newest lines anew to each connection. Those that an earlier connection brought are left out.
// Full: the oldest line is dropped. One thread.
#pragma once
#include <algorithm>
#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include "protocol/codec/chat_messages.hpp"
#include "protocol/limits.hpp"

namespace runstone {

class ChatInbox {
 public:
  static constexpr std::size_t kLinesMax = 256;

  void receive(ChatLines message) {
    const bool may_repeat = std::exchange(is_new_connection_, false);
    for (ChatLine& line : message.lines) {
      if (may_repeat && has_seen(line)) continue;
      if (line.kind == ChatLineKind::player || line.kind == ChatLineKind::server)
        add(seen_, line, kChatLinesMax);
      add(waiting_, std::move(line), kLinesMax);
    }
  }
  /// Drops the lines that were not drained yet, and keeps the rest for take_withdrawn().
  void receive(const ChatWithdrawn& message) {
    for (const ChatLineId& id : message.lines) {
      std::erase_if(waiting_, [&](const ChatLine& line) { return is_meant(line, id); });
      withdrawn_.push_back(id);
      if (withdrawn_.size() > kLinesMax) withdrawn_.pop_front();
    }
  }
  /// Returns the lines that were withdrawn since the last call, kLinesMax at most.
  std::vector<ChatLineId> take_withdrawn() {
    std::vector<ChatLineId> lines(withdrawn_.begin(), withdrawn_.end());
    withdrawn_.clear();
    return lines;
  }
  void disconnected() { is_new_connection_ = true; }
  /// Forgets which lines arrived. Call it when another world opens, because its lines are others.
  void clear() { seen_.clear(); }
  /// Returns the lines in their order, and forgets them.
  std::vector<ChatLine> drain() {
    std::vector<ChatLine> lines(std::make_move_iterator(waiting_.begin()),
                                std::make_move_iterator(waiting_.end()));
    waiting_.clear();
    return lines;
  }

 private:
  static void add(std::deque<ChatLine>& lines, ChatLine line, std::size_t count_max) {
    lines.push_back(std::move(line));
    if (lines.size() > count_max) lines.pop_front();
  }
  /// A restarted server may not know the author number of a line any more.
  bool has_seen(const ChatLine& line) const {
    return std::any_of(seen_.begin(), seen_.end(), [&](const ChatLine& known) {
      return known.utc_us == line.utc_us && known.kind == line.kind && known.name == line.name &&
             known.text == line.text;
    });
  }

  static bool is_meant(const ChatLine& line, const ChatLineId& id) {
    return line.kind == ChatLineKind::player && id_of(line) == id;
  }

  std::deque<ChatLine> waiting_;      // kLinesMax at most
  std::deque<ChatLineId> withdrawn_;  // kLinesMax at most
  std::deque<ChatLine> seen_;         // the newest lines that arrived, kChatLinesMax at most
  bool is_new_connection_ = true;
};

}  // namespace runstone
