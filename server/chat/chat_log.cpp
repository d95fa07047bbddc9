#include "server/chat/chat_log.hpp"

#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

#include "common/os/low_priority.hpp"

namespace runstone {
namespace {

std::string chat_file(const std::string& folder) { return folder + "/chat.sqlite"; }
std::string damaged_file(const std::string& file) { return file + ".damaged"; }

void remove_files(const std::string& file) {
  std::error_code ignored;
  for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(file + end, ignored);
}

/// Removes the file if nothing was written to it since `utc_us`.
void remove_if_older(const std::string& file, TimeUs utc_us) {
  std::error_code missing, ignored;
  const auto written = std::filesystem::last_write_time(file, missing);
  if (missing) return;
  const auto since = std::chrono::file_clock::to_sys(written).time_since_epoch();
  if (std::chrono::floor<std::chrono::microseconds>(since).count() < utc_us)
    std::filesystem::remove(file, ignored);
}

}  // namespace

ChatLog::ChatLog(const std::string& folder, TimeUs forget_before_us, OnWarning on_warning,
                 Limits limits)
    : file_(chat_file(folder)), on_warning_(std::move(on_warning)), limits_(limits) {
  Work begin;
  begin.forget_before_us = forget_before_us;
  carry_out(begin);
  if (!failure_.empty()) on_warning_("the chat is not logged for now: " + file_ + ": " + failure_);
  thread_ = std::thread([this] { run(); });
}

ChatLog::~ChatLog() { stop(); }

void ChatLog::append(const ChatEntry& entry) {
  {
    const std::lock_guard guard(mutex_);
    if (stopping_ || waiting_.lines.size() >= limits_.queued_lines_max) {
      ++missing_;
      return;
    }
    waiting_.lines.push_back(entry);
  }
  work_.notify_one();
}

void ChatLog::withdraw(const PublicKey& key, const std::vector<TimeUs>& times) {
  {
    const std::lock_guard guard(mutex_);
    if (stopping_ || waiting_.withdrawals.size() >= limits_.queued_withdrawals_max) return;
    waiting_.withdrawals.push_back({key, times});
  }
  work_.notify_one();
}

void ChatLog::forget_before(TimeUs utc_us) {
  {
    const std::lock_guard guard(mutex_);
    waiting_.forget_before_us = utc_us;
  }
  work_.notify_one();
}

bool ChatLog::search(const ChatQuery& query, std::function<void(const Found&)> done) {
  {
    const std::lock_guard guard(mutex_);
    if (stopping_ || waiting_.searches.size() >= limits_.queued_searches_max) return false;
    waiting_.searches.push_back({query, std::move(done)});
  }
  work_.notify_one();
  return true;
}

void ChatLog::stop() {
  {
    const std::lock_guard guard(mutex_);
    stopping_ = true;
  }
  work_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void ChatLog::run() {
  lower_priority();
  lower_disk_priority();
  while (auto work = take_work()) {
    carry_out(*work);
    warn_of_missing(false);
  }
  warn_of_missing(true);
}

std::optional<ChatLog::Work> ChatLog::take_work() {
  std::unique_lock lock(mutex_);
  const auto is_hurried = [this] { return stopping_ || !waiting_.searches.empty(); };
  const auto has_work = [&] {
    return is_hurried() || !waiting_.lines.empty() || !waiting_.withdrawals.empty() ||
           waiting_.forget_before_us;
  };
  if (missing_ == 0) {
    work_.wait(lock, has_work);
  } else {
    work_.wait_for(lock, limits_.warning_interval, has_work);
  }
  work_.wait_until(lock, written_ + limits_.commit_interval, is_hurried);
  Work work = std::exchange(waiting_, {});
  const bool is_over = stopping_ && work.lines.empty() && work.withdrawals.empty() &&
                       work.searches.empty() && !work.forget_before_us;
  if (is_over) return std::nullopt;
  return work;
}

void ChatLog::carry_out(Work& work) {
  if (work.forget_before_us) {
    static_cast<void>(with_database(
        [&](ChatDatabase& database) { return database.forget_before(*work.forget_before_us); }));
    remove_if_older(damaged_file(file_), *work.forget_before_us);
  }
  if (!work.lines.empty()) {
    const bool is_written =
        with_database([&](ChatDatabase& database) { return database.append(work.lines); });
    written_ = Clock::now();
    if (!is_written) {
      const std::lock_guard guard(mutex_);
      missing_ += work.lines.size();
    }
  }
  carry_out(std::move(work.withdrawals));
  for (const Search& search : work.searches) {
    Found found = std::vector<ChatEntry>();
    const bool is_read = with_database([&](ChatDatabase& database) -> sql::Result<void> {
      auto entries = database.search(search.query);
      if (!entries) return failure(entries.error());
      found = *std::move(entries);
      return {};
    });
    search.done(is_read ? found : Found(failure(file_ + ": " + failure_)));
  }
}

void ChatLog::carry_out(std::vector<Withdrawal>&& withdrawals) {
  std::vector<Withdrawal> left;
  for (Withdrawal& each : withdrawals) {
    const bool is_written = with_database(
        [&](ChatDatabase& database) { return database.withdraw(each.key, each.times); });
    if (!is_written) left.push_back(std::move(each));
  }
  if (left.empty()) return;
  written_ = Clock::now();  // the next attempt waits as long as a commit
  std::size_t lost = 0;
  {
    const std::lock_guard guard(mutex_);
    // A stop does not wait until the disk has space.
    if (stopping_) {
      lost = left.size();
    } else {
      left.insert(left.end(), std::make_move_iterator(waiting_.withdrawals.begin()),
                  std::make_move_iterator(waiting_.withdrawals.end()));
      waiting_.withdrawals = std::move(left);
    }
  }
  if (lost != 0) {
    on_warning_(
        "the log of the chat could not mark lines as withdrawn: players get them again "
        "after the restart (" +
        file_ + ": " + failure_ + ")");
  }
}

bool ChatLog::open() {
  if (database_) return true;
  if (retry_ && Clock::now() < *retry_) return false;
  for (const bool is_first : {true, false}) {
    auto opened = ChatDatabase::open(file_, limits_.lines_max);
    if (opened) {
      database_ = *std::move(opened);
      return true;
    }
    failure_ = opened.error().what;
    if (!is_first || !is_damage(opened.error())) break;
    set_aside(opened.error());
  }
  retry_ = Clock::now() + limits_.warning_interval;
  return false;
}

bool ChatLog::with_database(const std::function<sql::Result<void>(ChatDatabase&)>& step) {
  for (const bool is_first : {true, false}) {
    if (!open()) return false;
    const auto done = step(*database_);
    if (done) {
      failure_.clear();
      return true;
    }
    failure_ = done.error().what;
    if (!is_first || !is_damage(done.error())) return false;
    set_aside(done.error());
  }
  return false;
}

void ChatLog::set_aside(const sql::Error& why) {
  database_.reset();
  on_warning_("the log of the chat is damaged (" + file_ + ": " + why.what + "): renamed to " +
              damaged_file(file_) + ", and a new one is begun");
  std::error_code ignored;
  std::filesystem::rename(file_, damaged_file(file_), ignored);
  remove_files(file_);
}

void ChatLog::warn_of_missing(bool is_last) {
  const bool is_recent = warned_ && Clock::now() < *warned_ + limits_.warning_interval;
  if (is_recent && !is_last) return;
  std::uint64_t missing = 0;
  {
    const std::lock_guard guard(mutex_);
    missing = std::exchange(missing_, 0);
  }
  if (missing == 0) return;
  warned_ = Clock::now();
  on_warning_("chat lines were sent and not logged: lines=" + std::to_string(missing) +
              " file=" + file_ + ": " + (failure_.empty() ? "too many waited" : failure_));
}

void remove_chat_log(const std::string& folder) {
  remove_files(chat_file(folder));
  std::error_code ignored;
  std::filesystem::remove(damaged_file(chat_file(folder)), ignored);
}

}  // namespace runstone
