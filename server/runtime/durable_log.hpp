// DurableLog: the log writer, the keyframe thread, the retention and the check of the rows of a
// running world. It reports their progress on the world strand. Several group commits become one
// report if the strand has not run in between.
// Threads: writer() as LogWriter says; the events run on the world strand.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/generate/generator.hpp"
#include "server/runtime/check_thread.hpp"
#include "server/runtime/keyframe_thread.hpp"
#include "server/runtime/retention_thread.hpp"
#include "server/runtime/world_strand.hpp"
#include "server/store/log_writer.hpp"
#include "server/store/world_sink.hpp"

namespace runstone {

class DurableLog {
 public:
  struct Options {
    std::size_t queued_records_max = 65'536;
    std::uint64_t reserve_bytes = 0;          // LogWriter::Limits::reserve_bytes
    Sequence durable = 0;                     // what the log holds already
    std::optional<KeyframePolicy> keyframes;  // nullopt: no keyframes are made
    bool checks_rows = false;                 // all rows are read and verified meanwhile
    std::uint64_t retention_days = 0;         // for which edits stay, 0: for ever
  };
  struct Events {
    /// Reports that every edit up to the sequence is on disk.
    std::function<void(Sequence)> on_durable;
    /// Reports that so many changes of names are on disk, the oldest first.
    std::function<void(std::size_t)> on_names_written;
    /// Reports that the snapshots of the oldest save_snapshots() not reported yet are on disk.
    std::function<void()> on_snapshots_saved;
    /// Reports that the disk has no more space for new edits, or has space again.
    std::function<void(DiskSpace)> on_space;
    /// Reports, at most once, that the log cannot be written any more, or that another program owns
    /// the world.
    std::function<void()> on_failed;
    /// Reports, at once and on any thread, that the log cannot be written any more, or that another
    /// program owns the world.
    std::function<void()> on_failed_in_writer;
  };

  /// Starts the threads. `strand`, `store` and `generator` must outlive the object. Only the writer
  /// writes `store` until stop() has returned. `place`: of the world; the keyframe thread opens its
  /// own reader there.
  DurableLog(WorldStrand& strand, WorldSink& store, const std::string& place,
             const Generator& generator, const Options& options, Events events);

  ~DurableLog() { stop(); }
  DurableLog(const DurableLog&) = delete;
  DurableLog& operator=(const DurableLog&) = delete;

  LogWriter& writer() { return *writer_; }
  /// Thread: any.
  bool has_failed() const { return has_failed_.load(); }
  /// Returns false while another program may own the world. Thread: any.
  bool is_owned() const { return store_.is_owned(); }
  /// Returns true while writes wait because the disk is full or the database takes none. Thread:
  /// any.
  bool is_full() const { return is_full_.load(); }
  /// Returns the last edit that is on disk. Thread: any.
  Sequence durable() const { return durable_.load(); }
  /// Returns how many faults the check of the rows has found. Thread: any.
  std::uint64_t row_faults() const { return check_ ? check_->faults() : 0; }
  /// Returns CheckThread::log_bytes(), or nullopt without a check. Thread: any.
  std::optional<std::uint64_t> log_bytes() const {
    return check_ ? check_->log_bytes() : std::nullopt;
  }
  RetentionThread& retention() { return *retention_; }
  const RetentionThread& retention() const { return *retention_; }
  /// Stops making keyframes, checking and removing edits, writes the queued records, and ends the
  /// threads. On a full disk the edits behind durable() are lost. It may be called again.
  void stop();

 private:
  void on_durable(Sequence seq);
  void on_failed(const StoreError& error);
  void on_space(DiskSpace space, const std::string& reason);

  WorldStrand& strand_;
  WorldSink& store_;
  const Events events_;
  std::atomic<Sequence> durable_;
  std::atomic<bool> is_report_posted_{false};
  std::atomic<bool> has_failed_{false};
  std::atomic<bool> is_full_{false};
  std::unique_ptr<LogWriter> writer_;
  std::unique_ptr<KeyframeThread> keyframes_;   // null without a policy; uses writer_
  std::unique_ptr<CheckThread> check_;          // null without checks_rows
  std::unique_ptr<RetentionThread> retention_;  // uses writer_
};

}  // namespace runstone
