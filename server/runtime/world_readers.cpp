#include "server/runtime/world_readers.hpp"

#include <asio/post.hpp>
#include <memory>
#include <utility>

#include "protocol/limits.hpp"
#include "server/admin/build_file.hpp"
#include "server/history/log_marks.hpp"
#include "server/history/voxel_mark.hpp"
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

constexpr const char* kNotReadNow = "the library cannot be read now";

// A file of 64 MiB has fewer, unless it was made to keep the reader busy. They take some 5 s of one
// core.
constexpr std::uint64_t kUploadedRunsMax = std::uint64_t{1} << 29;
// The runs of an uploaded file of any size, and what each of its bytes may unpack to besides.
constexpr std::uint64_t kSmallFileRuns = std::uint64_t{1} << 21, kRunsOfByte = 256;

StoreResult<FoundBuilds> read_builds(LibraryReader& reader, const BuildsRequest& request) {
  LibraryQuery query{request.name, request.author, request.tag, request.before, request.count};
  ++query.count_max;  // shows whether there are more
  auto builds = reader.builds(query);
  if (!builds) return failure(builds.error());
  FoundBuilds found;
  found.has_more = builds->size() > request.count;
  if (found.has_more) builds->resize(request.count);
  for (StoredBuild& build : *builds) {
    const AddBuild& added = build.build();
    found.builds.push_back(
        {build.number(), added.info, added.touched, added.file_bytes, build.record.op.author, ""});
  }
  return found;
}

/// Returns no bytes if there is no such build.
StoreResult<Bytes> read_piece(LibraryReader& reader, const BuildPieceRequest& request) {
  const auto build = reader.build(request.number);
  if (!build) return failure(build.error());
  if (!*build || request.offset >= (*build)->build().file_bytes) return Bytes();
  return reader.read_build_piece(**build, request.offset, kBuildPieceBytes);
}

/// Joins the parts, and frees each of them.
Bytes joined(std::vector<Bytes> parts) {
  std::size_t size = 0;
  for (const Bytes& part : parts) size += part.size();
  Bytes out;
  out.reserve(size);
  for (Bytes& part : parts) {
    const Bytes taken = std::exchange(part, {});
    out.insert(out.end(), taken.begin(), taken.end());
  }
  return out;
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

template <class T>
void WorldReaders::read_history(std::string refusal,
                                std::function<StoreResult<T>(WorldReader&)> read,
                                std::function<void(Result<T, std::string>)> then) {
  asio::post(*history_readers_, [this, refusal = std::move(refusal), read = std::move(read),
                                 then = std::move(then)]() mutable {
    Result<T, std::string> found = failure(std::move(refusal));
    const auto had_reader = chunks_.with_reader([&](WorldReader& reader) {
      auto outcome = read(reader);
      if (outcome) {
        found = *std::move(outcome);
      } else {
        logger("store").error("{}", outcome.error().message());
      }
    });
    if (!had_reader) logger("store").error("{}", had_reader.error().message());
    strand_.post([then, found = std::move(found)]() mutable { then(std::move(found)); });
  });
}

void WorldReaders::read_log_marks(const LogMarksRequest& request,
                                  std::function<void(FoundLogMarksResult)> then) {
  read_history<FoundLogMarks>(
      "the log cannot be read now",
      [this, request](WorldReader& reader) {
        return request.at ? read_voxel_mark(reader, generator_, *request.at)
                          : runstone::read_log_marks(reader, request);
      },
      std::move(then));
}

void WorldReaders::find_builds(const BuildsRequest& request,
                               std::function<void(FoundBuildsResult)> then) {
  read_history<FoundBuilds>(
      kNotReadNow, [request](WorldReader& reader) { return read_builds(reader, request); },
      std::move(then));
}

void WorldReaders::read_build_piece(const BuildPieceRequest& request,
                                    std::function<void(BuildPieceResult)> then) {
  asio::post(*history_readers_, [this, request, then = std::move(then)] {
    BuildPieceResult piece = failure(kNotReadNow);
    const auto read = chunks_.with_reader([&](WorldReader& reader) {
      auto bytes = read_piece(reader, request);
      if (!bytes) {
        logger("store").error("{}", bytes.error().message());
      } else if (bytes->empty()) {
        piece = failure("the library has no build " + std::to_string(request.number) +
                        ", or it is not on disk yet");
      } else {
        piece = *std::move(bytes);
      }
    });
    if (!read) logger("store").error("{}", read.error().message());
    strand_.post([then, piece = std::move(piece)]() mutable { then(std::move(piece)); });
  });
}

void WorldReaders::verify_build(std::vector<Bytes> parts,
                                std::function<void(VerifiedBuildResult)> then) {
  asio::post(*file_readers_, [this, parts = std::move(parts), then = std::move(then)]() mutable {
    auto file = std::make_shared<const Bytes>(joined(std::move(parts)));
    VerifiedBuildResult verified = failure("");
    // A file of some KiB that unpacks to any amount must not keep the thread from the files of others.
    const std::uint64_t runs_max =
        std::min(kUploadedRunsMax, kSmallFileRuns + kRunsOfByte * std::uint64_t{file->size()});
    if (auto build =
            runstone::verify_build(*file, runs_max, [this] { return !is_stopping_.load(); })) {
      verified = VerifiedBuild{*std::move(build), std::move(file)};
    } else {
      verified = failure("the file is no sound .rsb: " + build.error());
    }
    strand_.post([then, verified = std::move(verified)]() mutable { then(std::move(verified)); });
  });
}

void WorldReaders::run_on_log_reader(RollbackService::Workers::Work work,
                                     std::function<void(std::string)> then) {
  asio::post(*log_readers_, [this, work = std::move(work), then = std::move(then)] {
    const auto read = chunks_.with_reader([&](WorldReader& reader) { work(reader, generator_); });
    strand_.post([then, error = read ? std::string() : read.error().message()] { then(error); });
  });
}

void WorldReaders::stop() {
  moments_.cancel();
  is_stopping_.store(true);
  log_readers_->stop();
  history_readers_->stop();
  file_readers_->stop();
  log_readers_->join();
  history_readers_->join();
  file_readers_->join();
}

}  // namespace runstone
