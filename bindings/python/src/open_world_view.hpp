// OpenWorldView: a world that is open for reading, shown at one moment or at the end of its log. It
// knows nothing of Python.
// Threads: any; calls wait for each other. Calls block on the disk. After close() every call fails.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/generate/generator.hpp"
#include "server/history/named_moment.hpp"
#include "server/history/world_at.hpp"
#include "server/store/store.hpp"

namespace runstone::python {

/// Why a call failed.
struct ViewError {
  enum class Kind {
    closed,       // close() was called
    bad_request,  // the world does not have what was asked for
    unreadable    // the world cannot be read
  };
  Kind kind = Kind::unreadable;
  std::string text;
};

template <class T>
using ViewResult = Result<T, ViewError>;

class OpenWorldView {
 public:
  /// Opens the world at a place. A server may be running it. With a moment the view shows the world
  /// of that moment; without one it follows the log. Fails if there is no world, if it cannot be
  /// read, if this program lacks its generator, or if the world does not have the moment.
  static ViewResult<std::shared_ptr<OpenWorldView>> open(const std::string& place,
                                                         const std::optional<NamedMoment>& moment);

  /// Opens the world of a moment beside this one.
  ViewResult<std::shared_ptr<OpenWorldView>> at(const NamedMoment& moment);
  void close();
  bool is_closed();
  /// Fails if the view is closed.
  ViewResult<void> require_open();

  const std::string& place() const { return place_; }
  bool is_pinned() const { return is_pinned_; }
  const WorldMeta& meta() const { return meta_; }

  /// Returns the last edit that the view shows. A view that follows the log moves to its end first.
  ViewResult<LogEnd> end();
  /// Returns the text of the loss of durable edits, or an empty one.
  ViewResult<std::string> loss();
  /// Returns the materials after the last edit that the view shows.
  ViewResult<MaterialTable> materials();
  ViewResult<std::vector<PlayerRow>> players();
  /// Returns a chunk. Requires a chunk inside the world.
  ViewResult<Chunk> chunk(ChunkCoord at);
  /// Fills `out` as read_voxels() does, with up to kThreadsMax threads. Requires a box inside the
  /// world that is not empty.
  ViewResult<void> voxels(const VoxelBox& box, std::span<Material> out);
  /// Returns up to `count` records of the log from `first` on, in order, none behind the last edit
  /// that the view shows.
  ViewResult<std::vector<EditRecord>> records(Sequence first, Sequence last, std::size_t count);

  static constexpr std::size_t kThreadsMax = 4;

 private:
  OpenWorldView(std::string place, bool is_pinned)
      : place_(std::move(place)), is_pinned_(is_pinned) {}
  /// Opens one more reader. The first one gives the generator and the moment.
  ViewResult<void> add_reader();
  /// Moves a view that follows the log to its end. Requires the lock.
  ViewResult<void> refresh();
  ViewResult<void> check_open() const;
  /// Opens the moment again if the log was compacted beyond it meanwhile.
  ViewResult<void> reopen(Sequence at);

  const std::string place_;
  const bool is_pinned_;
  WorldMeta meta_;
  std::mutex mutex_;                             // guards all below
  std::vector<std::unique_ptr<Store>> readers_;  // empty when it is closed
  std::unique_ptr<Generator> generator_;
  std::optional<WorldAt> world_;
};

}  // namespace runstone::python
