#include "client/cache/cache_thread.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace runstone {

CacheThread::CacheThread(std::unique_ptr<ChunkCache> cache, std::unique_ptr<TextureCache> textures,
                         std::function<void()> wake)
    : cache_(std::move(cache)),
      textures_(std::move(textures)),
      wake_(std::move(wake)),
      thread_([this] { run(); }) {}

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

void CacheThread::look_up_textures(std::vector<TextureHash> hashes) {
  {
    const std::lock_guard lock(mutex_);
    texture_lookups_.push_back(std::move(hashes));
  }
  has_work_.notify_one();
}

void CacheThread::keep_textures(std::vector<TexturePart> parts) {
  if (!textures_) return;
  {
    const std::lock_guard lock(mutex_);
    std::move(parts.begin(), parts.end(), std::back_inserter(texture_parts_));
  }
  has_work_.notify_one();
}

std::vector<std::vector<TexturePart>> CacheThread::drain_textures() {
  const std::lock_guard lock(mutex_);
  return std::exchange(texture_results_, {});
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
    has_work_.wait(lock, [this] {
      return ends_ || !lookups_.empty() || !texture_lookups_.empty() || !batches_.empty() ||
             !texture_parts_.empty();
    });
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
    } else if (!texture_lookups_.empty()) {
      const std::vector<TextureHash> hashes = std::move(texture_lookups_.front());
      texture_lookups_.pop_front();
      lock.unlock();
      auto found = textures_ ? textures_->find(hashes) : std::vector<TexturePart>();
      lock.lock();
      texture_results_.push_back(std::move(found));
      lock.unlock();
      wake_();
      lock.lock();
    } else if (!texture_parts_.empty()) {
      const std::vector<TexturePart> parts = std::exchange(texture_parts_, {});
      lock.unlock();
      textures_->keep(parts);
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
    if (std::string warning = textures_ ? textures_->take_warning() : std::string();
        !warning.empty())
      warning_ = std::move(warning);
  }
}

}  // namespace runstone
