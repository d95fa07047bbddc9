#include "server/store/log_writer.hpp"

#include <algorithm>
#include <iterator>

#include "common/core/assert.hpp"
#include "common/edits/descriptor/edit_memory.hpp"
#include "common/os/steady_clock.hpp"
#include "server/store/build_table.hpp"

namespace runstone {
namespace {

std::size_t memory_of(const std::vector<EditRecord>& records) {
  std::size_t bytes = 0;
  for (const EditRecord& record : records) bytes += sizeof(EditRecord) + memory_bytes(record.edit);
  return bytes;
}

}  // namespace

LogWriter::LogWriter(WorldSink& world, Callbacks callbacks, Limits limits)
    : world_(world), callbacks_(std::move(callbacks)), limits_(limits) {
  check_space();
  thread_ = std::thread([this] { run(); });
}

LogWriter::~LogWriter() { stop(); }

bool LogWriter::has_room(std::size_t records) const {
  if (!world_.is_owned()) return false;
  const std::lock_guard guard(mutex_);
  return space_ == DiskSpace::enough && is_room_in_queue(records);
}

bool LogWriter::has_queue_room(std::size_t records) const {
  if (!world_.is_owned()) return false;
  const std::lock_guard guard(mutex_);
  return is_room_in_queue(records);
}

bool LogWriter::is_room_in_queue(std::size_t records) const {
  return !failed_ && !stopping_ && room_taken_ + records <= limits_.queued_records_max;
}

void LogWriter::append(std::vector<PlayerRow> players, std::vector<EditRecord> records) {
  if (players.empty() && records.empty()) return;
  Batch batch;
  batch.room = std::max<std::size_t>(records.size(), 1);
  batch.bytes = memory_of(records);
  batch.players = std::move(players);
  batch.records = std::move(records);
  queue(std::move(batch));
}

void LogWriter::change_names(std::vector<NameChange> names) {
  if (names.empty()) return;
  Batch batch;
  batch.room = 1;
  batch.names = std::move(names);
  queue(std::move(batch));
}

bool LogWriter::save_state(SavedState state) {
  if (!has_room(1)) return false;
  Batch batch;
  batch.room = 1;
  batch.state = std::move(state);
  return queue(std::move(batch));
}

bool LogWriter::queue(Batch batch) {
  {
    const std::lock_guard guard(mutex_);
    if (failed_ || stopping_) return false;
    RUNSTONE_ASSERT(room_taken_ + batch.room <= limits_.queued_records_max);
    room_taken_ += batch.room;
    bytes_taken_ += batch.bytes;
    batches_.push_back(std::move(batch));
  }
  work_.notify_one();
  return true;
}

bool LogWriter::save_snapshots(SnapshotChunks chunks, std::optional<Sequence> checkpoint) {
  return queue(Job{std::move(chunks), checkpoint, 0, std::nullopt, {}, std::nullopt});
}

bool LogWriter::save_keyframe(SnapshotChunks chunks, std::optional<Keyframe> keyframe,
                              JobDone done) {
  return queue(Job{std::move(chunks), std::nullopt, 0, keyframe, std::move(done), std::nullopt});
}

bool LogWriter::save_tiles(SnapshotChunks tiles, std::uint32_t rules, JobDone done) {
  return queue(Job{std::move(tiles), std::nullopt, 0, std::nullopt, std::move(done), rules});
}

bool LogWriter::save_build_file(std::uint64_t content, std::shared_ptr<const Bytes> file,
                                JobDone done) {
  RUNSTONE_ASSERT(file != nullptr && !file->empty());
  Job job;
  job.done = std::move(done);
  job.file = std::move(file);
  job.content = content;
  return queue(std::move(job));
}

void LogWriter::remove_build_file(std::uint64_t content) {
  Job job;
  job.done = [](const StoreResult<void>& /*removed*/) {};
  job.content = content;
  job.removes_file = true;
  queue(std::move(job));
}

bool LogWriter::fold_log(LogFold fold, JobDone done) {
  Job job;
  job.done = std::move(done);
  job.fold = std::move(fold);
  return queue(std::move(job));
}

bool LogWriter::give_back_space(std::uint32_t pages, SpaceDone done) {
  Job job;
  job.pages_back = pages;
  job.has_more_space = std::make_shared<bool>(false);
  job.done = [done = std::move(done),
              has_more = job.has_more_space](const StoreResult<void>& given) {
    done(given ? StoreResult<bool>(*has_more) : failure(given.error()));
  };
  return queue(std::move(job));
}

std::size_t LogWriter::Job::size() const {
  if (removes_file || fold || pages_back) return 1;
  return file ? (file->size() + kBuildPartBytes - 1) / kBuildPartBytes : chunks.size();
}

void LogWriter::write_part(Job& job) {
  const std::size_t begin = job.written * kBuildPartBytes;
  const ByteView part =
      ByteView(*job.file).subspan(begin, std::min(kBuildPartBytes, job.file->size() - begin));
  const auto saved =
      world_.save_build_part(job.content, static_cast<std::uint32_t>(job.written), part);
  job.written = saved ? job.written + 1 : job.size();  // an error ends the job
  if (!job.is_over()) return;
  {
    const std::lock_guard guard(mutex_);
    has_file_job_ = false;
    --file_jobs_;
  }
  job.done(saved);
}

void LogWriter::remove_file(Job& job) {
  const auto removed = world_.remove_build_file(job.content);
  job.written = job.size();
  {
    const std::lock_guard guard(mutex_);
    --file_jobs_;
  }
  job.done(removed);
}

void LogWriter::write_fold(Job& job) {
  const auto begun = std::chrono::steady_clock::now();
  const auto folded = world_.fold_log(*job.fold);
  const auto taken = std::chrono::duration_cast<std::chrono::microseconds>(
      std::chrono::steady_clock::now() - begun);
  job.written = job.size();
  {
    const std::lock_guard guard(mutex_);
    const auto taken_us = static_cast<std::uint64_t>(taken.count());
    counters_.fold_us += taken_us;
    counters_.fold_us_max = std::max(counters_.fold_us_max, taken_us);
    if (folded) {
      ++counters_.folds;
      counters_.folded_edits += job.fold->to.version.seq - job.fold->from;
    }
  }
  job.done(folded);
}

void LogWriter::write_space(Job& job) {
  const auto given = world_.give_back_space(*job.pages_back);
  *job.has_more_space = given && *given;
  job.written = job.size();
  job.done(given ? StoreResult<void>() : failure(given.error()));
}

bool LogWriter::queue(Job job) {
  {
    const std::lock_guard guard(mutex_);
    // The file of a build takes no place of the others, because these are not offered again.
    const std::size_t jobs = jobs_.size() + (job_is_running_ ? 1U : 0U) - file_jobs_;
    const bool is_full =
        job.is_of_file() ? job.file != nullptr && has_file_job_ : jobs >= limits_.jobs_max;
    if (failed_ || stopping_ || is_full) return false;
    if (job.file) has_file_job_ = true;
    if (job.is_of_file()) ++file_jobs_;
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
    std::move(next.names.begin(), next.names.end(), std::back_inserter(group.names));
    std::move(next.players.begin(), next.players.end(), std::back_inserter(group.players));
    std::move(next.records.begin(), next.records.end(), std::back_inserter(group.records));
    if (next.state) group.state = std::move(next.state);
    group.room += next.room;
    group.bytes += next.bytes;
    batches_.pop_front();
  }
  return group;
}

void LogWriter::run() {
  Batch group;
  std::optional<Job> job;
  while (take_work(group, job)) {
    StoreResult<void> written = write(group);
    // One slice per round: records that were queued meanwhile are written before the next slice.
    if (written && job) written = write_slice(*job);
    if (!written && can_be_repeated(written.error())) {
      if (!wait_for_room(written.error(), group, job)) return;
      continue;
    }
    if (!written) return fail(written.error(), job);
    check_space();
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

bool LogWriter::take_work(Batch& group, std::optional<Job>& job) {
  std::unique_lock lock(mutex_);
  const auto must_go_on = [&] { return group.room > 0 || job || !jobs_.empty() || stopping_; };
  const auto has_work = [&] { return must_go_on() || !batches_.empty(); };
  if (space_ == DiskSpace::enough) {
    work_.wait(lock, has_work);
  } else {
    work_.wait_for(lock, limits_.space_interval, has_work);
  }
  if (!batches_.empty()) work_.wait_until(lock, group_due_, must_go_on);
  const auto now = std::chrono::steady_clock::now();
  if (group.room == 0 && (stopping_ || now >= group_due_)) {
    group = take_group();
    if (group.room > 0) group_due_ = now + limits_.commit_interval;
  }
  if (!job && !jobs_.empty()) {
    job = std::move(jobs_.front());
    jobs_.pop_front();
    job_is_running_ = true;
  }
  return group.room > 0 || job || !stopping_;
}

StoreResult<void> LogWriter::write(Batch& group) {
  if (group.room == 0) return {};
  if (!group.names.empty()) {
    if (auto changed = world_.change_names(group.names); !changed) return changed;
    const std::size_t count = std::exchange(group.names, {}).size();
    if (callbacks_.on_names_written) callbacks_.on_names_written(count);
  }
  if (!group.players.empty() || !group.records.empty()) {
    if (auto appended = world_.append(group.players, group.records); !appended) return appended;
  }
  // A state that is left takes room for one record.
  std::optional<SavedState> state = std::exchange(group.state, std::nullopt);
  Batch written = std::exchange(group, {});
  if (state) {
    group.room = 1;
    group.state = std::move(state);
    written.room -= group.room;
  }
  if (written.room > 0) {
    {
      const std::lock_guard guard(mutex_);
      room_taken_ -= written.room;
      bytes_taken_ -= written.bytes;
      counters_.commits += 1;
      counters_.records += written.records.size();
    }
    if (!written.records.empty() && callbacks_.on_durable)
      callbacks_.on_durable(written.records.back().version.seq);
  }
  if (group.state) {
    if (auto saved = world_.save_state(*group.state); !saved) return saved;
    group = {};
    const std::lock_guard guard(mutex_);
    room_taken_ -= 1;
  }
  return {};
}

StoreResult<void> LogWriter::write_slice(Job& job) {
  if (job.is_of_file()) {
    if (job.file) {
      write_part(job);
    } else {
      remove_file(job);
    }
    return {};
  }
  if (job.fold) {
    write_fold(job);
    return {};
  }
  if (job.pages_back) {
    write_space(job);
    return {};
  }
  const std::size_t count = std::min(limits_.slice_chunks_max, job.chunks.size() - job.written);
  const ChunkSpan slice(job.chunks.data() + job.written, count);
  const bool last = job.written + count == job.chunks.size();
  if (job.done) {
    const auto saved = job.tile_rules
                           ? world_.save_tiles(slice, *job.tile_rules)
                           : world_.save_keyframe(slice, last ? job.keyframe : std::nullopt);
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

void LogWriter::check_space() {
  const TimeUs now_us = steady_now_us();
  // Only this thread writes it.
  const bool was_full = space_ == DiskSpace::full || space_ == DiskSpace::read_only;
  const TimeUs interval_us = std::chrono::microseconds(limits_.space_interval).count();
  if (!was_full && looked_us_ != 0 && now_us - looked_us_ < interval_us) return;
  looked_us_ = now_us;
  const bool has_reserve = limits_.reserve_bytes > 0 && callbacks_.free_bytes;
  const auto free = has_reserve ? callbacks_.free_bytes() : std::nullopt;
  // A disk that was too full is used again when a quarter more than the reserve is free, so that
  // the mode does not change every second.
  const bool was_enough = space_ == DiskSpace::enough;
  const std::uint64_t needed = limits_.reserve_bytes + (was_enough ? 0 : limits_.reserve_bytes / 4);
  if (!free || *free >= needed) return set_space(DiskSpace::enough, "");
  set_space(DiskSpace::low, "the world's disk has " + std::to_string(*free >> 20) +
                                " MiB free, and its reserve is " +
                                std::to_string(limits_.reserve_bytes >> 20) + " MiB");
}

void LogWriter::set_space(DiskSpace space, const std::string& reason) {
  {
    const std::lock_guard guard(mutex_);
    if (std::exchange(space_, space) == space) return;
  }
  if (callbacks_.on_space) callbacks_.on_space(space, reason);
}

bool LogWriter::wait_for_room(const StoreError& error, const Batch& group,
                              std::optional<Job>& job) {
  const bool is_read_only = error.kind == StoreError::Kind::read_only;
  set_space(is_read_only ? DiskSpace::read_only : DiskSpace::full, error.message());
  end_optional_jobs(error, job);
  std::unique_lock lock(mutex_);
  if (stopping_) {
    if (group.room > 0) return false;
    // Only the snapshots found no room. Records need less of it, and more may be queued.
    job.reset();
    jobs_.clear();
    job_is_running_ = false;
    return true;
  }
  // A job that ends with an error ends the wait, so that its error does not wait.
  const auto ends = [](const Job& one) { return one.done != nullptr; };
  work_.wait_for(lock, limits_.space_interval,
                 [&] { return stopping_ || std::any_of(jobs_.begin(), jobs_.end(), ends); });
  return true;
}

void LogWriter::end_optional_jobs(const StoreError& error, std::optional<Job>& job) {
  std::deque<Job> ended;
  {
    const std::lock_guard guard(mutex_);
    std::deque<Job> jobs = std::exchange(jobs_, {});
    for (Job& one : jobs) (one.done ? ended : jobs_).push_back(std::move(one));
    if (job && job->done) {
      ended.push_back(std::move(*job));
      job.reset();
      job_is_running_ = false;
    }
    has_file_job_ = false;
    file_jobs_ = 0;
  }
  for (const Job& one : ended) one.done(failure(error));
}

void LogWriter::fail(const StoreError& error, std::optional<Job>& job) {
  {
    const std::lock_guard guard(mutex_);
    failed_ = true;
    batches_.clear();
  }
  end_optional_jobs(error, job);
  if (callbacks_.on_failed) callbacks_.on_failed(error);
}

}  // namespace runstone
