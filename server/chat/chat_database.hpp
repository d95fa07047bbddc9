// ChatDatabase: the file with the log of the chat. It holds a bounded number of lines: each append
// removes the oldest ones beyond. What is removed is overwritten with zeros, because a line that is
// older than its retention must be gone. A line may be lost in a power failure; the file stays
// sound.
// Threads: one.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/sql/database.hpp"
#include "server/chat/chat_query.hpp"
#include "server/world/environment/chat_entry.hpp"

namespace runstone {

class ChatDatabase {
 public:
  /// Opens the file, or makes it for its owner only (mode 0600). Fails if it is damaged or is no
  /// log of the chat in this layout.
  static sql::Result<ChatDatabase> open(const std::string& file, std::uint64_t lines_max);

  /// Writes the lines, all or none.
  sql::Result<void> append(std::span<const ChatEntry> entries);
  /// Marks the lines of a player with these times as withdrawn, if they are among the 4,096 newest.
  /// Cost: O(times).
  sql::Result<void> withdraw(const PublicKey& key, std::span<const TimeUs> times);
  /// Removes the lines up to the newest one that is older. The lines before it are older too, whatever
  /// time a wrong clock has given them.
  sql::Result<void> forget_before(TimeUs utc_us);
  /// Returns the newest lines that the query selects, the last one last. Author numbers are 0. Rows
  /// with values that no line has are left out. Cost: O(lines in the file).
  sql::Result<std::vector<ChatEntry>> search(const ChatQuery& query);

 private:
  ChatDatabase(sql::Database database, std::uint64_t lines_max)
      : database_(std::move(database)), lines_max_(lines_max) {}
  sql::Result<void> prepare();
  sql::Result<void> insert(const ChatEntry& entry);

  sql::Database database_;
  std::uint64_t lines_max_;
  sql::Statement insert_, trim_, forget_, withdraw_, newest_;
};

/// Returns true if the failure means that the file is damaged, or is no log of the chat.
bool is_damage(const sql::Error& error);

}  // namespace runstone
