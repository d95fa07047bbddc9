// WorldReaders: reads the stored world for the world strand: chunks, chunks of the past, and the
// log. Each call returns at once; `then` runs later on the world strand. There are four groups of
// threads, so that one kind of read does not wait for another:
//   - the workers, shared with encoding, load chunks;
//   - the history readers open moments of the past and make their chunks, and read marks of the
//     log and builds of the library;
//   - one file reader verifies files that players have sent, which takes seconds for a large one;
//   - the log readers run the queries of commands and rollbacks.
// All have a low priority.
// Threads: any, until stop().
#pragma once
#include <asio/thread_pool.hpp>
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/runs/chunk.hpp"
#include "server/history/chunk_source.hpp"
#include "server/history/moments.hpp"
#include "server/rollback/rollback_service.hpp"
#include "server/runtime/low_priority_threads.hpp"
#include "server/runtime/world_strand.hpp"
#include "server/world/environment/world_environment.hpp"

namespace runstone {

class WorldReaders {
 public:
  /// All must outlive the object. The workers must have ended when it is destroyed.
  WorldReaders(WorldStrand& strand, asio::thread_pool& workers, ChunkSource& chunks,
               const std::string& place, const Generator& generator);

  void load_chunk(const ChunkKey& key, std::function<void(StoreResult<Chunk>)> then);

  using OpenedHistoryResult = Result<OpenedHistory, std::string>;
  /// Opens the moment that the request names. The error is for the client, so it names no file of
  /// this machine.
  void open_history(const HistoryRequest& request, std::function<void(OpenedHistoryResult)> then);
  /// Makes a chunk as it was after edit `at`, at once. The error is Kind::cancelled after stop().
  StoreResult<Chunk> past_chunk(Sequence at, const ChunkKey& key) {
    return moments_.chunk(at, key);
  }
  /// Makes a chunk as it was after edit `at`. The error names file, table and row.
  void load_history_chunk(Sequence at, const ChunkKey& key,
                          std::function<void(Result<ChunkPtr, std::string>)> then);

  using FoundLogMarksResult = Result<FoundLogMarks, std::string>;
  /// Reads marks of the log. The error is for the client, so it names no file of this machine.
  void read_log_marks(const LogMarksRequest& request,
                      std::function<void(FoundLogMarksResult)> then);

  // The errors of these are for the client, so they name no file of this machine.
  using FoundBuildsResult = Result<FoundBuilds, std::string>;
  void find_builds(const BuildsRequest& request, std::function<void(FoundBuildsResult)> then);
  using BuildPieceResult = Result<Bytes, std::string>;
  /// Reads kBuildPieceBytes of the file of a build, or those up to its end: at least one byte.
  void read_build_piece(const BuildPieceRequest& request,
                        std::function<void(BuildPieceResult)> then);
  using VerifiedBuildResult = Result<VerifiedBuild, std::string>;
  /// Joins the parts of an uploaded file and verifies all of it.
  void verify_build(std::vector<Bytes> parts, std::function<void(VerifiedBuildResult)> then);

  /// Runs `work` on a thread for reads of the log, with a reader of its own. The text is empty, or
  /// says why there was no reader and `work` did not run.
  void run_on_log_reader(RollbackService::Workers::Work work,
                         std::function<void(std::string)> then);

  /// Ends the threads of the history readers, the log readers and the file reader. Waits for the
  /// reads under way, which end soon, and drops the queued ones: their `then` is not called.
  /// Requires that RollbackService::stop() was called.
  void stop();

 private:
  /// Calls `read` on a history reader, and `then` on the world strand: with `refusal` if there is
  /// no reader, or if `read` fails. The cause is logged.
  template <class T>
  void read_history(std::string refusal, std::function<StoreResult<T>(WorldReader&)> read,
                    std::function<void(Result<T, std::string>)> then);

  static constexpr std::size_t kLogReaders = 2;
  static constexpr std::size_t kHistoryReaders = 2;
  static constexpr std::size_t kFileReaders = 1;

  WorldStrand& strand_;
  asio::thread_pool& workers_;
  ChunkSource& chunks_;
  const Generator& generator_;
  Moments moments_;
  const std::unique_ptr<asio::thread_pool> log_readers_ = low_priority_threads(kLogReaders);
  const std::unique_ptr<asio::thread_pool> history_readers_ = low_priority_threads(kHistoryReaders);
  const std::unique_ptr<asio::thread_pool> file_readers_ = low_priority_threads(kFileReaders);
  std::atomic<bool> is_stopping_{false};
};

}  // namespace runstone
