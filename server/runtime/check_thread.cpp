#include "server/runtime/check_thread.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/os/low_priority.hpp"
#include "server/runtime/logging.hpp"

namespace runstone {
namespace {

using CheckClock = std::chrono::steady_clock;

constexpr std::chrono::hours kOpenAgain{1};
constexpr std::size_t kKeysAtOnce = 1'024;
// After damage, so many records are skipped at most: a tree that cannot be read at all must not
// cost an error for each record.
constexpr Sequence kSkippedMax = 65'536;

StoreResult<void> only_error(const auto& result) {
  if (!result) return failure(result.error());
  return {};
}

}  // namespace

CheckThread::CheckThread(std::string place, CheckPace pace)
    : place_(std::move(place)), pace_(pace), thread_([this] { run(); }) {}

void CheckThread::stop() {
  {
    const std::lock_guard guard(mutex_);
    stopping_ = true;
  }
  end_.notify_one();
  if (thread_.joinable()) thread_.join();
}

bool CheckThread::rest(std::chrono::nanoseconds time) {
  std::unique_lock lock(mutex_);
  return !end_.wait_for(lock, time, [this] { return stopping_; });
}

void CheckThread::note(const StoreError& error) {
  // An error that may pass says nothing about a row: the next round reads it again.
  if (error.may_pass()) return;
  faults_ = std::max(faults_.load(), ++round_faults_);
  if (round_faults_ > kCheckLinesMax) return;
  const bool is_last = round_faults_ == kCheckLinesMax;
  logger("store").error(
      "DAMAGE: {}{}: stop the server and run `runstone-server repair --world {} --to NEW`, with "
      "--from and the folder of a backup if there is one",
      error.message(), is_last ? " (further damage of this round is counted in `status`)" : "",
      place_);
}

std::optional<std::uint64_t> CheckThread::log_bytes() const {
  const std::int64_t counted = log_bytes_.load();
  if (counted < 0) return std::nullopt;
  return static_cast<std::uint64_t>(counted);
}

bool CheckThread::check(const std::function<StoreResult<void>()>& part) {
  const auto begun = CheckClock::now();
  if (const auto done = part(); !done) note(done.error());
  ++parts_;
  return rest(pace_.rest_parts * (CheckClock::now() - begun));
}

bool CheckThread::check_each(std::size_t count,
                             const std::function<StoreResult<void>(std::size_t)>& load) {
  for (std::size_t i = 0; i < count;) {
    const bool goes_on = check([&]() -> StoreResult<void> {
      const std::size_t end = std::min(count, i + kCheckPartChunks);
      const auto begun = CheckClock::now();
      do {
        if (auto loaded = load(i++); !loaded) return loaded;
      } while (i < end && CheckClock::now() - begun < kCheckPartMax);
      return {};
    });
    if (!goes_on) return false;
  }
  return true;
}

bool CheckThread::check_log(Store& reader) {
  std::optional<LogRange> range;
  const bool has_range = check([&]() -> StoreResult<void> {
    const auto found = reader.log_range();
    if (found) range = *found;
    return only_error(found);
  });
  if (!has_range) return false;
  if (!range) return true;
  Sequence skipped = 1;
  bool is_ended = false, is_whole = true;
  std::uint64_t bytes = 0;
  Bytes descriptor;
  for (Sequence next = range->first; !is_ended && next <= range->last.version.seq;) {
    const bool goes_on = check([&] {
      const auto begun = CheckClock::now();
      const Sequence first = next;
      auto read =
          reader.read_log(first, first + kCheckPartEdits - 1, [&](const EditRecord& record) {
            next = record.version.seq + 1;
            descriptor.clear();
            encode(record.edit, descriptor);
            bytes += descriptor.size() + kLogRowBytes;
            return CheckClock::now() - begun < kCheckPartMax;
          });
      if (!read) is_whole = false;
      // Says nothing about the records behind it. They are read in the next round.
      is_ended = !read && read.error().may_pass();
      if (is_ended) return read;
      // The record behind the last sound one is damaged.
      if (next != first) skipped = 1;
      if (read && next == first) {
        // Retention has moved the beginning of the log, or a repair has made it shorter.
        const auto now = reader.log_range();
        if (!now) return only_error(now);
        next = now->first > first ? now->first : range->last.version.seq + 1;
      } else if (!read) {
        next += skipped;
        skipped = std::min(2 * skipped, kSkippedMax);
      }
      return read;
    });
    if (!goes_on) return false;
  }
  if (is_whole) log_bytes_ = static_cast<std::int64_t>(bytes);
  return true;
}

bool CheckThread::check_chunks(Store& reader, Store::ChunkRows rows) {
  const bool is_base = rows == Store::ChunkRows::base;
  std::optional<ChunkKey> behind;
  for (;;) {
    std::vector<ChunkKey> keys;
    const bool has_keys = check([&]() -> StoreResult<void> {
      auto found = reader.chunk_keys(rows, behind, kKeysAtOnce);
      if (found) keys = *std::move(found);
      return only_error(found);
    });
    if (!has_keys) return false;
    if (keys.empty()) return true;
    behind = keys.back();
    const bool goes_on = check_each(keys.size(), [&](std::size_t i) {
      return only_error(is_base ? reader.load_base(keys[i]) : reader.load_snapshot(keys[i]));
    });
    if (!goes_on) return false;
  }
}

bool CheckThread::check_keyframes(Store& reader) {
  std::vector<StoredChunk> rows;
  const bool has_rows = check([&]() -> StoreResult<void> {
    auto found = reader.keyframe_chunks();
    if (found) rows = *std::move(found);
    return only_error(found);
  });
  return has_rows && check_each(rows.size(), [&](std::size_t i) {
           return only_error(reader.load_stored(rows[i]));
         });
}

bool CheckThread::check_all(Store& reader) {
  const auto any = [](const EditRecord&) { return true; };
  return check([&] { return only_error(reader.players()); }) &&
         check([&] { return only_error(reader.player_names()); }) &&
         check([&] { return only_error(reader.name_claims()); }) &&
         check([&] { return only_error(reader.high_waters()); }) &&
         check([&] { return only_error(reader.keyframes()); }) &&
         check([&] { return reader.read_rights(any); }) &&
         check([&] { return reader.read_textures(any); }) && check_log(reader) &&
         check_chunks(reader, Store::ChunkRows::base) &&
         check_chunks(reader, Store::ChunkRows::snapshot) && check_keyframes(reader);
}

void CheckThread::run() {
  lower_priority();
  lower_disk_priority();
  for (;;) {
    std::chrono::nanoseconds pause = pace_.between_rounds;
    {
      const auto reader = open_world(place_, StoreAccess::read_only);
      if (!reader) {
        logger("store").warn("the rows of the world are not checked now, and again in an hour: {}",
                             reader.error().message());
        pause = std::min<std::chrono::nanoseconds>(pause, kOpenAgain);
      } else if (!check_all(**reader)) {
        return;
      } else {
        faults_ = std::exchange(round_faults_, 0);
        ++rounds_;
        logger("store").debug("rows_checked faults={}", faults());
      }
    }
    if (!rest(pause)) return;
  }
}

}  // namespace runstone
