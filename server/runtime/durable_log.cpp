#include "server/runtime/durable_log.hpp"

#include <chrono>
#include <utility>

#include "common/os/free_space.hpp"
#include "server/runtime/logging.hpp"
#include "server/runtime/read_clocks.hpp"

namespace runstone {
namespace {

// With less, single edits cost about 32 KB of disk each; with more, players wait longer until their
// edits are safe. The others see an edit before it is durable.
constexpr std::chrono::milliseconds kCommitInterval{50};

}  // namespace

DurableLog::DurableLog(WorldStrand& strand, WorldSink& store, const std::string& place,
                       const Generator& generator, const Options& options, Events events)
    : strand_(strand), store_(store), events_(std::move(events)), durable_(options.durable) {
  LogWriter::Callbacks callbacks;
  callbacks.on_durable = [this](Sequence seq) { on_durable(seq); };
  callbacks.on_snapshots_saved = [this](const LogWriter::SnapshotChunks& /*chunks*/,
                                        std::optional<Sequence> /*seq*/) {
    strand_.post([this] { events_.on_snapshots_saved(); });
  };
  callbacks.on_names_written = [this](std::size_t count) {
    strand_.post([this, count] { events_.on_names_written(count); });
  };
  callbacks.on_failed = [this](const StoreError& error) { on_failed(error); };
  callbacks.on_space = [this](DiskSpace space, const std::string& why) { on_space(space, why); };
  callbacks.free_bytes = [place] { return free_bytes(place); };
  LogWriter::Limits limits;
  limits.queued_records_max = options.queued_records_max;
  limits.reserve_bytes = options.reserve_bytes;
  limits.commit_interval = kCommitInterval;
  writer_ = std::make_unique<LogWriter>(store, std::move(callbacks), limits);
  // on_durable() reads keyframes_. Nobody can append before this constructor returns, so it does
  // not run before.
  if (options.keyframes) {
    keyframes_ = std::make_unique<KeyframeThread>(place, generator, *options.keyframes, *writer_);
  }
  retention_ = std::make_unique<RetentionThread>(place, generator, *writer_, options.retention_days,
                                                 [] { return read_clocks().utc_us; });
  if (options.checks_rows) check_ = std::make_unique<CheckThread>(place);
  store_.watch_ownership([this](const StoreError& error) { on_failed(error); });
}

void DurableLog::on_durable(Sequence seq) {
  durable_.store(seq);
  if (keyframes_) keyframes_->durable(seq);
  if (is_report_posted_.exchange(true)) return;
  strand_.post([this] {
    is_report_posted_.store(false);
    events_.on_durable(durable_.load());
  });
}

void DurableLog::on_failed(const StoreError& error) {
  // A writer that meets the new owner's lease and the watch of the lease both report it.
  if (has_failed_.exchange(true)) return;
  logger("store").error("{}", error.message());
  strand_.post([this] { events_.on_failed(); });
  events_.on_failed_in_writer();
}

void DurableLog::on_space(DiskSpace space, const std::string& reason) {
  is_full_.store(space == DiskSpace::full || space == DiskSpace::read_only);
  switch (space) {
    case DiskSpace::enough:
      logger("store").info("the world can be written again: edits are accepted");
      break;
    case DiskSpace::low:
      logger("store").warn("READ-ONLY: {}: edits are rejected until there is space", reason);
      break;
    case DiskSpace::full:
      logger("store").error(
          "READ-ONLY: {}: edits are rejected, and accepted ones wait until they can be written",
          reason);
      break;
    case DiskSpace::read_only:
      logger("store").error(
          "READ-ONLY: {}: edits are rejected, and accepted ones are written when the database takes "
          "writes again",
          reason);
      break;
  }
  strand_.post([this, space] { events_.on_space(space); });
}

void DurableLog::stop() {
  store_.watch_ownership({});
  if (check_) check_->stop();
  if (keyframes_) keyframes_->stop();
  retention_->stop();
  writer_->stop();
}

}  // namespace runstone
