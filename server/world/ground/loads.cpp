#include "server/world/ground/loads.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "common/core/key_text.hpp"

namespace runstone {
namespace {

constexpr std::size_t kReleasedPerTask = 4'096;  // takes about a millisecond
constexpr std::size_t kEvictionStepsPerTick = 2'048;
constexpr std::size_t kShareOfFree = 2;  // alpha of the dynamic thresholds

std::string mebibytes(std::size_t bytes) { return std::to_string(bytes >> 20); }

}  // namespace

void Loads::request(const ChunkKey& key, const Clocks& now) {
  if (base_.order.chunks().residency(key) != Residency::absent) return;
  queue_.request_for_world(key);
  start(now);
}

void Loads::start(const Clocks& now) {
  WorldChunks& chunks = base_.order.chunks();
  const auto next_load = [&] {
    return base_.order.do_views_wait_for_memory() ? queue_.next_for_world() : queue_.next(waiting_);
  };
  while (const auto next = next_load()) {
    // Another session may have requested the same chunk before.
    if (chunks.residency(next->key) != Residency::absent) continue;
    if (next->session) {
      const Viewer* viewer = base_.find(*next->session);
      if (viewer == nullptr) continue;  // closed in this task
      if (!base_.quotas.pay_load(viewer->session, now)) {
        queue_.put_back(*next->session, next->key);
        waiting_.insert(*next->session);
        continue;
      }
    }
    chunks.begin_load(next->key);
    queue_.load_started();
    base_.environment.load_chunk(next->key);
  }
}

void Loads::ended(const ChunkKey& key) {
  if (base_.order.chunks().residency(key) == Residency::loading) queue_.load_ended();
}

bool Loads::load_again(const ChunkKey& key, OperatorLogLevel level, const std::string& why,
                       const Clocks& now) {
  auto pause_us = retries_.failed(key, now.steady_us);
  // A server that follows never gives up, because the database may be away for long: failed() has
  // forgotten the chunk, so the second call begins to count again.
  if (!pause_us && base_.order.is_following()) pause_us = retries_.failed(key, now.steady_us);
  if (!pause_us) return false;
  base_.environment.report(level, "chunk=" + text_of(key) + " not read, again in " +
                                      std::to_string(*pause_us / 1'000'000) + " s: " + why);
  return true;
}

void Loads::retry(const Clocks& now) {
  for (const ChunkKey& key : retries_.take_due(now.steady_us)) {
    queue_.load_started();
    base_.environment.load_chunk(key);
  }
}

void Loads::collect_released() {
  for (const ChunkKey& key : base_.interest.take_released(kReleasedPerTask)) {
    if (!base_.interest.is_used(key)) base_.order.chunks().released(key);
  }
}

/// Returns the mean memory of a chunk.
std::size_t Loads::mean_chunk_bytes() const {
  const WorldChunks& chunks = base_.order.chunks();
  return chunks.resident_bytes() / std::max<std::size_t>(1, chunks.resident_count());
}

/// Returns the sessions that may load no chunk because their address sees more than its share. From
/// half of view_bytes_max on, an address may load chunks only while those that its sessions see
/// take less than twice the memory that is left. So however many addresses see as much as they can,
/// some memory is left for others. Source: the dynamic thresholds of A. K. Choudhury and E. L.
/// Hahne, "Dynamic queue length thresholds for shared-memory packet switches", 1998, with alpha =
/// 2. Cost: O(sessions).
std::set<SessionId> Loads::sessions_over_share(const WorldMemory& use) const {
  const std::size_t mean = mean_chunk_bytes();
  const std::size_t voxels = std::min(use.voxels, mean * base_.interest.used_count());
  const std::size_t in_use = voxels + use.stacked + use.queued;
  const std::size_t bound = base_.config.memory.view_bytes_max;
  if (in_use <= bound / 2) return {};
  const std::size_t share = kShareOfFree * (bound - std::min(bound, in_use));
  std::map<AddressBlock, std::size_t> seen;  // bytes; a chunk counts for each session
  for (const auto& [id, viewer] : base_.viewers) {
    const SessionInterest* interest = base_.interest.find(id);
    seen[viewer.session.address] += mean * interest->count(ChunkInterest::subscribed);
  }
  std::set<SessionId> over;
  for (const auto& [id, viewer] : base_.viewers) {
    if (seen[viewer.session.address] >= share) over.insert(id);
  }
  return over;
}

void Loads::keep_memory_bounds() {
  const WorldMemory use = base_.order.memory();
  const std::size_t edits = use.stacked + use.queued;
  const MemoryLimits& limits = base_.config.memory;
  const std::size_t seen = mean_chunk_bytes() * base_.interest.used_count();
  const std::size_t voxels_max =
      std::min(limits.idle_bytes_max - std::min(limits.idle_bytes_max, edits),
               seen + limits.unused_bytes_max);
  base_.order.chunks().evict(voxels_max, kEvictionStepsPerTick,
                             [&](const ChunkKey& key) { return base_.interest.is_used(key); });
  waiting_ = sessions_over_share(base_.order.memory());
  const bool is_short = base_.order.do_views_wait_for_memory();
  if (std::exchange(is_memory_short_, is_short) == is_short) return;
  if (!is_short)
    return base_.environment.report(OperatorLogLevel::info, "MEMORY: there is room again");
  base_.environment.report(OperatorLogLevel::warn,
                           "MEMORY: memory_mib is used up: voxels " + mebibytes(use.voxels) +
                               " MiB, waiting edits " + mebibytes(edits) +
                               " MiB: chunks are loaded later, and edits may be rejected");
}

}  // namespace runstone
