// ChatLog: the log of the chat, `chat.sqlite` in the world's folder, and the thread that writes it.
// It is apart from the edit log: another file, another thread of low priority, no fsync in a
// commit.
//   - Group commit: the lines of a second become one transaction.
//   - Full: a line that finds queued_lines_max lines waiting is not logged.
//   - Failure: lines that cannot be written, on a full disk for example, are not logged. A file
//     that is damaged is renamed to chat.sqlite.damaged, which is removed when its lines would have
//     been, and a new one is begun. Nobody waits for the log, and the server never stops for it. A
//     warning, at most once a minute, counts the missing lines.
// Threads: append(), withdraw(), forget_before() and search() may be called from any thread; they
// never wait for the disk. The thread of the log calls `on_warning` and the answers of searches.
#pragma once
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/core/result.hpp"
#include "server/chat/chat_database.hpp"
#include "server/chat/chat_query.hpp"
#include "server/world/environment/chat_entry.hpp"

namespace runstone {

class ChatLog {
 public:
  struct Limits {
    std::size_t queued_lines_max = 1'024;
    std::size_t queued_searches_max = 8;
    std::size_t queued_withdrawals_max = 1'024;
    std::uint64_t lines_max = 100'000;  // in the file, some 70 MB at most
    std::chrono::milliseconds commit_interval{1'000};
    std::chrono::milliseconds warning_interval{60'000};
  };
  using OnWarning = std::function<void(const std::string&)>;

  /// Opens or makes the file, removes the lines before `forget_before_us`, and starts the thread.
  /// Blocks on the disk.
  ChatLog(const std::string& folder, TimeUs forget_before_us, OnWarning on_warning, Limits limits);
  ChatLog(const std::string& folder, TimeUs forget_before_us, OnWarning on_warning)
      : ChatLog(folder, forget_before_us, std::move(on_warning), Limits{}) {}
  /// Calls stop().
  ~ChatLog();
  ChatLog(const ChatLog&) = delete;
  ChatLog& operator=(const ChatLog&) = delete;

  void append(const ChatEntry& entry);
  /// Marks lines of a player that were appended before, by their times, as withdrawn. Does nothing
  /// if too many such calls wait.
  void withdraw(const PublicKey& key, const std::vector<TimeUs>& times);
  /// Removes the lines that are older, and a damaged file that was last written before, soon.
  void forget_before(TimeUs utc_us);
  using Found = Result<std::vector<ChatEntry>, std::string>;
  /// Looks for lines (ChatDatabase::search), those included that were appended before. Returns
  /// false, and never calls `done`, if too many searches wait or the log has stopped.
  bool search(const ChatQuery& query, std::function<void(const Found&)> done);
  /// Writes what is queued, and ends the thread. It may be called again.
  void stop();

 private:
  struct Search {
    ChatQuery query;
    std::function<void(const Found&)> done;
  };
  struct Withdrawal {
    PublicKey key{};
    std::vector<TimeUs> times;
  };
  struct Work {
    std::vector<ChatEntry> lines;
    std::vector<Withdrawal> withdrawals;  // of these lines and earlier ones
    std::optional<TimeUs> forget_before_us;
    std::deque<Search> searches;
  };
  using Clock = std::chrono::steady_clock;

  void run();
  /// Waits for work and takes all of it. Returns nullopt if the log stops and nothing is left. May
  /// return without work, so that a warning is written.
  std::optional<Work> take_work();
  void carry_out(Work& work);
  /// Marks lines as withdrawn. Lines for which the disk has no space are tried again later.
  void carry_out(std::vector<Withdrawal>&& withdrawals);
  /// Opens the file unless it is open. Returns true if it is. After a failure it waits for
  /// warning_interval before it tries again.
  bool open();
  /// Calls `step` with the open file, and once more with a new one if the file is damaged. Returns
  /// true if it succeeded. Sets failure_.
  bool with_database(const std::function<sql::Result<void>(ChatDatabase&)>& step);
  void set_aside(const sql::Error& why);
  /// Warns about lines that are missing, unless the last warning is recent or there are none.
  void warn_of_missing(bool is_last);

  const std::string file_;
  const OnWarning on_warning_;
  const Limits limits_;
  // These members belong to the constructor, and then to the thread.
  std::optional<ChatDatabase> database_;
  std::string failure_;                     // of the last access; empty: it succeeded
  std::optional<Clock::time_point> retry_;  // when the file may be opened again after a failure
  std::optional<Clock::time_point> warned_;
  Clock::time_point written_;

  std::mutex mutex_;  // a leaf
  std::condition_variable work_;
  // mutex_ guards all members from here on.
  Work waiting_;
  std::uint64_t missing_ = 0;  // lines that were not logged since the last warning
  bool stopping_ = false;
  std::thread thread_;  // starts last
};

/// Removes the log of the chat from a world's folder.
void remove_chat_log(const std::string& folder);

}  // namespace runstone
