#include "client/cache/cache_thread.hpp"

#include <algorithm>
#include <utility>

namespace runstone {

CacheThread::CacheThread(std::unique_ptr<ChunkCache> cache, std::function<void()> wake)
    : cache_(std::move(cache)), wake_(std::move(wake)), thread_([this] { run(); }) {}

CacheThread::~CacheThread() { stop(); }

void CacheThread::look_up(CacheLookup lookup) {
  {
    const std::lock_guard lock(mutex_);
    lookups_.push_back(std::move(lookup));
  }
  has_work_.notify_one();
}

std::size_t CacheThread::room() const {
  const std::lock_guard lock(mutex_);
  return waiting_bytes_ >= kKeepBytesMax ? 0 : kKeepMax - std::min(kKeepMax, waiting_);
}

void CacheThread::keep(const CachedWorld& world, std::vector<KeyedChunk> chunks) {
  if (chunks.empty()) return;
  std::size_t bytes = 0;
  for (const auto& [key, chunk] : chunks) bytes += chunk->voxels.runs.byte_capacity();
  {
    const std::lock_guard lock(mutex_);
    waiting_ += chunks.size();
    waiting_bytes_ += bytes;
    batches_.push_back({world, std::move(chunks), bytes});
  }
  has_work_.notify_one();
}

std::vector<std::vector<KeyedChunk>> CacheThread::drain_results() {
  const std::lock_guard lock(mutex_);
  return std::exchange(results_, {});
}

void CacheThread::stop() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  has_work_.notify_one();
  if (thread_.joinable()) thread_.join();
}

CacheCounters CacheThread::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

std::string CacheThread::take_warning() {
  const std::lock_guard lock(mutex_);
  return std::exchange(warning_, {});
}

void CacheThread::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    has_work_.wait(lock, [this] { return ends_ || !lookups_.empty() || !batches_.empty(); });
    if (!lookups_.empty()) {
      const CacheLookup lookup = std::move(lookups_.front());
      lookups_.pop_front();
      lock.unlock();
      auto found = cache_->find(lookup);
      lock.lock();
      results_.push_back(std::move(found));
      lock.unlock();
      wake_();
      lock.lock();
    } else if (!batches_.empty()) {
      const Batch batch = std::move(batches_.front());
      batches_.pop_front();
      lock.unlock();
      cache_->keep(batch.world, batch.chunks);
      lock.lock();
      waiting_ -= batch.chunks.size();
      waiting_bytes_ -= batch.bytes;
    } else {
      return;
    }
    counters_ = cache_->counters();
    if (std::string warning = cache_->take_warning(); !warning.empty())
      warning_ = std::move(warning);
  }
}

}  // namespace runstone
