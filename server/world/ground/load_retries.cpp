#include "server/world/ground/load_retries.hpp"

namespace runstone {
namespace {

constexpr TimeUs kFirstPauseUs = 1'000'000;
constexpr unsigned kRetriesMax = 6;  // the last pause is 32 s

}  // namespace

std::optional<TimeUs> LoadRetries::failed(const ChunkKey& key, TimeUs now_us) {
  Failure& failure = failures_[key];
  if (failure.count == kRetriesMax) {
    failures_.erase(key);
    return std::nullopt;
  }
  const TimeUs pause_us = kFirstPauseUs << failure.count;
  ++failure.count;
  failure.due_us = now_us + pause_us;
  return pause_us;
}

std::vector<ChunkKey> LoadRetries::take_due(TimeUs now_us) {
  std::vector<ChunkKey> due;
  for (auto& [key, failure] : failures_) {
    if (!failure.due_us || now_us < *failure.due_us) continue;
    failure.due_us.reset();
    due.push_back(key);
  }
  return due;
}

void LoadRetries::hurry() {
  for (auto& [key, failure] : failures_) {
    if (failure.due_us) failure.due_us = 0;
    failure.count = kRetriesMax;
  }
}

}  // namespace runstone
