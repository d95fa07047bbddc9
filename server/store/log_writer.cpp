#include "server/store/log_writer.hpp"

#include <algorithm>
#include <iterator>

#include "common/core/assert.hpp"

namespace runstone {

LogWriter::LogWriter(WorldSink& world, Callbacks callbacks, Limits limits)
    : world_(world),
      callbacks_(std::move(callbacks)),
      limits_(limits),
      thread_([this] { run(); }) {}

LogWriter::~LogWriter() { stop(); }

bool LogWriter::has_room(std::size_t records) const {
  const std::lock_guard guard(mutex_);
  return !failed_ && !stopping_ && room_taken_ + records <= limits_.queued_records_max;
}

void LogWriter::append(std::vector<PlayerRow> players, std::vector<EditRecord> records) {
  if (players.empty() && records.empty()) return;
  {
    const std::lock_guard guard(mutex_);
    if (failed_ || stopping_) return;
    const std::size_t room = std::max<std::size_t>(records.size(), 1);
    RUNSTONE_ASSERT(room_taken_ + room <= limits_.queued_records_max);
    room_taken_ += room;
    batches_.push_back({std::move(players), std::move(records), room});
  }
  work_.notify_one();
}

bool LogWriter::save_snapshots(SnapshotChunks chunks, std::optional<Sequence> checkpoint) {
  return queue({std::move(chunks), checkpoint, 0, std::nullopt, {}});
}

bool LogWriter::save_keyframe(SnapshotChunks chunks, std::optional<Keyframe> keyframe,
                              KeyframeDone done) {
  return queue({std::move(chunks), std::nullopt, 0, keyframe, std::move(done)});
}

bool LogWriter::queue(Job job) {
  {
    const std::lock_guard guard(mutex_);
    const std::size_t jobs = jobs_.size() + (job_is_running_ ? 1 : 0);
    if (failed_ || stopping_ || jobs >= limits_.jobs_max) return false;
    jobs_.push_back(std::move(job));
  }
  work_.notify_one();
  return true;
}

void LogWriter::stop() {
  {
    const std::lock_guard guard(mutex_);
    stopping_ = true;
  }
  work_.notify_one();
  if (thread_.joinable()) thread_.join();
}

LogWriter::Counters LogWriter::counters() const {
  const std::lock_guard guard(mutex_);
  Counters now = counters_;
  now.queued_records = room_taken_;
  return now;
}

LogWriter::Batch LogWriter::take_group() {
  Batch group;
  while (!batches_.empty()) {
    Batch& next = batches_.front();
    const bool first = group.room == 0;
    if (!first && group.records.size() + next.records.size() > limits_.commit_records_max) break;
    std::move(next.players.begin(), next.players.end(), std::back_inserter(group.players));
    std::move(next.records.begin(), next.records.end(), std::back_inserter(group.records));
    group.room += next.room;
    batches_.pop_front();
  }
  return group;
}

void LogWriter::run() {
  std::optional<Job> job;
  for (;;) {
    Batch group;
    {
      std::unique_lock lock(mutex_);
      work_.wait(lock, [&] { return job || !batches_.empty() || !jobs_.empty() || stopping_; });
      group = take_group();
      if (!job && !jobs_.empty()) {
        job = std::move(jobs_.front());
        jobs_.pop_front();
        job_is_running_ = true;
      }
      if (group.room == 0 && !job) return;  // the writer stops, and the queues are empty
    }
    if (const auto written = write(group); !written)
      return fail(written.error(), job ? &*job : nullptr);
    // One slice per round: records that were queued meanwhile are written before the next slice.
    if (job) {
      if (const auto written = write_slice(*job); !written) return fail(written.error(), nullptr);
    }
    if (job && job->is_over()) {
      {
        const std::lock_guard guard(mutex_);
        job_is_running_ = false;
      }
      if (!job->done && callbacks_.on_snapshots_saved)
        callbacks_.on_snapshots_saved(std::move(job->chunks), job->checkpoint);
      job.reset();
    }
  }
}

StoreResult<void> LogWriter::write(const Batch& group) {
  if (group.room == 0) return {};
  if (auto appended = world_.append(group.players, group.records); !appended) return appended;
  {
    const std::lock_guard guard(mutex_);
    room_taken_ -= group.room;
    counters_.commits += 1;
    counters_.records += group.records.size();
  }
  if (!group.records.empty() && callbacks_.on_durable)
    callbacks_.on_durable(group.records.back().version.seq);
  return {};
}

StoreResult<void> LogWriter::write_slice(Job& job) {
  const std::size_t count = std::min(limits_.slice_chunks_max, job.chunks.size() - job.written);
  const ChunkSpan slice(job.chunks.data() + job.written, count);
  const bool last = job.written + count == job.chunks.size();
  if (job.done) {
    const auto saved = world_.save_keyframe(slice, last ? job.keyframe : std::nullopt);
    job.written = saved ? job.written + count : job.chunks.size();  // an error ends the job
    if (saved && last && job.keyframe) {
      const std::lock_guard guard(mutex_);
      ++counters_.keyframes;
    }
    if (job.is_over()) job.done(saved);
    return {};
  }
  if (auto saved = world_.save_snapshots(slice, last ? job.checkpoint : std::nullopt); !saved)
    return saved;
  job.written += count;
  const std::lock_guard guard(mutex_);
  counters_.snapshots += count;
  return {};
}

void LogWriter::fail(const StoreError& error, Job* job) {
  std::deque<Job> dropped;
  {
    const std::lock_guard guard(mutex_);
    failed_ = true;
    batches_.clear();
    dropped.swap(jobs_);
  }
  if (job != nullptr) dropped.push_back(std::move(*job));
  for (const Job& one : dropped) {
    if (one.done) one.done(Unexpected<StoreError>{error});
  }
  if (callbacks_.on_failed) callbacks_.on_failed(error);
}

}  // namespace runstone
