#include "server/runtime/world_readers.hpp"

#include <asio/post.hpp>
#include <memory>
#include <utility>

#include "server/history/log_marks.hpp"
#include "server/runtime/logging.hpp"

namespace runstone {
namespace {

WorldReaders::OpenedHistoryResult open(Moments& moments, const HistoryRequest& request) {
  const auto end = request.to == HistoryTarget::time ? moments.open_at_time(request.utc_us)
                                                     : moments.open(request.seq);
  if (end) return OpenedHistory{end->version.seq, end->time_us};
  if (end.error().kind != StoreError::Kind::bad_request &&
      end.error().kind != StoreError::Kind::cancelled)
    logger("store").error("{}", end.error().message());
  return failure(end.error().what);
}

}  // namespace

WorldReaders::WorldReaders(WorldStrand& strand, asio::thread_pool& workers, ChunkSource& chunks,
                           const std::string& place, const Generator& generator)
    : strand_(strand),
      workers_(workers),
      chunks_(chunks),
      generator_(generator),
      moments_(place, generator) {}

void WorldReaders::load_chunk(const ChunkKey& key, std::function<void(StoreResult<Chunk>)> then) {
  asio::post(workers_, [this, key, then = std::move(then)] {
    strand_.post([then, loaded = chunks_.load(key)]() mutable { then(std::move(loaded)); });
  });
}

void WorldReaders::open_history(const HistoryRequest& request,
                                std::function<void(OpenedHistoryResult)> then) {
  asio::post(*history_readers_, [this, request, then = std::move(then)] {
    strand_.post([then, opened = open(moments_, request)]() mutable { then(std::move(opened)); });
  });
}

void WorldReaders::load_history_chunk(Sequence at, const ChunkKey& key,
                                      std::function<void(Result<ChunkPtr, std::string>)> then) {
  asio::post(*history_readers_, [this, at, key, then = std::move(then)] {
    auto loaded = moments_.chunk(at, key);
    Result<ChunkPtr, std::string> chunk = ChunkPtr();
    if (!loaded && loaded.error().kind == StoreError::Kind::cancelled) return;  // the server stops
    if (loaded) {
      chunk = std::make_shared<const Chunk>(*std::move(loaded));
    } else {
      chunk = failure(loaded.error().message());
    }
    strand_.post([then, chunk = std::move(chunk)]() mutable { then(std::move(chunk)); });
  });
}

void WorldReaders::read_log_marks(const LogMarksRequest& request,
                                  std::function<void(FoundLogMarksResult)> then) {
  asio::post(*history_readers_, [this, request, then = std::move(then)] {
    FoundLogMarksResult found = failure("the log cannot be read now");
    const auto read = chunks_.with_reader([&](WorldReader& reader) {
      auto marks = runstone::read_log_marks(reader, request);
      if (marks) {
        found = *std::move(marks);
      } else {
        logger("store").error("{}", marks.error().message());
      }
    });
    if (!read) logger("store").error("{}", read.error().message());
    strand_.post([then, found = std::move(found)]() mutable { then(std::move(found)); });
  });
}

void WorldReaders::read_log(RollbackService::Workers::Work work,
                            std::function<void(std::string)> then) {
  asio::post(*log_readers_, [this, work = std::move(work), then = std::move(then)] {
    const auto read = chunks_.with_reader([&](WorldReader& reader) { work(reader, generator_); });
    strand_.post([then, error = read ? std::string() : read.error().message()] { then(error); });
  });
}

void WorldReaders::stop() {
  moments_.cancel();
  log_readers_->stop();
  history_readers_->stop();
  log_readers_->join();
  history_readers_->join();
}

}  // namespace runstone
