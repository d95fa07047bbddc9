#include "server/runtime/check_thread.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/os/low_priority.hpp"
#include "server/runtime/logging.hpp"
#include "server/store/store.hpp"

namespace runstone {
namespace {

constexpr std::chrono::hours kBetweenRounds{24};
constexpr Sequence kEditsAtOnce = 256;
constexpr std::size_t kChunksAtOnce = 16;
constexpr int kRestParts = 19;  // for each part of reading

StoreResult<void> only_error(const auto& result) {
  if (!result) return failure(result.error());
  return {};
}

}  // namespace

CheckThread::CheckThread(std::string place)
    : place_(std::move(place)), thread_([this] { run(); }) {}

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

bool CheckThread::check(const std::function<StoreResult<void>()>& part) {
  const auto begun = std::chrono::steady_clock::now();
  // An error that may pass says nothing about a row: the next round reads it again.
  if (const auto done = part(); !done && !done.error().may_pass()) {
    faults_ = std::max(faults_.load(), ++round_faults_);
    logger("store").error(
        "DAMAGE: {}: stop the server and run `runstone-server repair --world {} --to NEW`, with "
        "--from and the folder of a backup if there is one",
        done.error().message(), place_);
  }
  return rest(kRestParts * (std::chrono::steady_clock::now() - begun));
}

std::optional<std::uint64_t> CheckThread::log_bytes() const {
  const std::int64_t counted = log_bytes_.load();
  if (counted < 0) return std::nullopt;
  return static_cast<std::uint64_t>(counted);
}

bool CheckThread::check_log(WorldReader& reader) {
  const auto range = reader.log_range();
  if (!range) return check([&] { return only_error(range); });
  std::uint64_t bytes = 0;
  Bytes descriptor;
  for (Sequence seq = range->first; seq <= range->last.version.seq; seq += kEditsAtOnce) {
    const bool goes_on = check([&] {
      return reader.read_log(seq, seq + kEditsAtOnce - 1, [&](const EditRecord& record) {
        descriptor.clear();
        encode(record.edit, descriptor);
        bytes += descriptor.size() + kLogRowBytes;
        return true;
      });
    });
    if (!goes_on) return false;
  }
  log_bytes_ = static_cast<std::int64_t>(bytes);
  return true;
}

bool CheckThread::check_chunks(WorldReader& reader) {
  using Load = std::function<StoreResult<void>()>;
  std::vector<Load> loads;
  const auto keyframes = reader.keyframe_chunks();
  const auto base = reader.base_chunks();
  const auto snapshots = reader.snapshot_keys();
  if (!check([&] { return only_error(keyframes); })) return false;
  if (!check([&] { return only_error(base); })) return false;
  if (!check([&] { return only_error(snapshots); })) return false;
  if (base) {
    for (const StoredChunk& row : *base)
      loads.emplace_back([&] { return only_error(reader.load_base(row.key)); });
  }
  if (snapshots) {
    for (const auto& row : *snapshots)
      loads.emplace_back([&] { return only_error(reader.load_snapshot(row.first)); });
  }
  if (keyframes) {
    for (const StoredChunk& row : *keyframes)
      loads.emplace_back([&] { return only_error(reader.load_stored(row)); });
  }
  for (std::size_t i = 0; i < loads.size();) {
    const bool goes_on = check([&]() -> StoreResult<void> {
      for (std::size_t end = i + kChunksAtOnce; i < end && i < loads.size();) {
        if (auto loaded = loads[i++](); !loaded) return loaded;
      }
      return {};
    });
    if (!goes_on) return false;
  }
  return true;
}

bool CheckThread::check_all(WorldReader& reader) {
  const auto any = [](const EditRecord&) { return true; };
  return check([&] { return only_error(reader.players()); }) &&
         check([&] { return only_error(reader.player_names()); }) &&
         check([&] { return only_error(reader.name_claims()); }) &&
         check([&] { return only_error(reader.high_waters()); }) &&
         check([&] { return reader.read_rights(any); }) &&
         check([&] { return reader.read_textures(any); }) && check_log(reader) &&
         check_chunks(reader);
}

void CheckThread::run() {
  lower_priority();
  lower_disk_priority();
  for (;;) {
    {
      const auto reader = open_world(place_, StoreAccess::read_only);
      if (!reader) {
        logger("store").warn("the rows of the world are not checked: {}", reader.error().message());
      } else if (!check_all(**reader)) {
        return;
      } else {
        faults_ = std::exchange(round_faults_, 0);
        ++rounds_;
        logger("store").debug("rows_checked faults={}", faults());
      }
    }
    if (!rest(kBetweenRounds)) return;
  }
}

}  // namespace runstone
