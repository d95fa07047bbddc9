// PlaceJob: places a build of any size in the world as one action of its author, while players go on
// building.
//   - A worker cuts the build into edits (PasteSource). The world strand orders them slice by slice, so
//     that the edits of others come in between.
//   - A slice is cut short by the room in the log, and by the budget of the payer. The rest waits.
//   - A part that the author may not place, for example on protected ground, is left out and counted.
// The edits are those of a player: they have one action (docs/edit-log.md), and one undo takes all of
// them back. An undo meanwhile ends the job. A job whose server stops leaves a part of the build,
// which an undo takes back.
// Threads: the world strand. It uses no clock, disk or thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/builds/paste_source.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

struct PlaceOrder {
  AuthorId author = 0;          // 0: the console
  ClientInstance instance = 0;  // drawn for this job alone
  AuthorId payer = 0;           // as for Changes::order_edits()
  BuildPtr build;               // of materials of the world
  VoxelPos at;                  // of its corner; the box of the build lies in the world
  Mask mask;
  EmptyCells empty = EmptyCells::pasted;
};

/// Some edits of a build that a worker has cut.
struct PlacedParts {
  std::vector<EditDescriptor> edits;
  std::uint64_t cells_done = 0;  // PasteSource::cells_done() behind them
  bool is_last = false;
};
/// Cuts the next edits. Cost: that of PasteSource::next() for each. Thread: any, one at a time for a
/// source.
PlacedParts cut_parts(PasteSource& source, std::int32_t chunk_edge);

struct PlaceLimits {
  std::size_t slice_work = 64 * 1024;  // edit_work() ordered per step; a single edit may have more
  std::size_t parts_waiting = 512;     // edits that are cut and not ordered
};

class PlaceJob {
 public:
  enum class State { placing, done, cancelled, undone, failed };

  PlaceJob(PlaceOrder order, const PasteLimits& paste, PlaceLimits limits = {});

  /// Returns the source from which a worker cuts next, or null while one cuts and when enough is cut.
  /// Call computed() or work_failed() with its outcome.
  std::shared_ptr<PasteSource> next_work();
  void computed(PlacedParts parts);
  void work_failed(std::string what);
  /// Orders a slice. Call it on each tick.
  void step(WorldServer& world, const Clocks& now);
  /// Ends the job. Edits that are ordered stay. Does nothing if the job has ended.
  void cancel();

  State state() const { return state_; }
  const PlaceOrder& order() const { return order_; }
  /// Returns true if an accepted edit of the job is not ordered yet. After the end of the job, too, such
  /// edits become part of the world.
  bool has_queued(const WorldServer& world) const;
  /// Notes in progress() which sequences the ordered edits have.
  void note_sequences(const WorldServer& world);
  struct Progress {
    std::uint64_t cells = 0, cells_done = 0;  // of the build, touched or not
    std::uint64_t edits = 0, voxels = 0;      // ordered; a masked edit may change fewer voxels
    std::uint64_t edits_refused = 0;          // that the author may not make
    std::string refusal;                      // the reason for the last of them
    Sequence first = 0;  // the action: the sequence of its first edit; 0: none is ordered
    Sequence last = 0;   // behind all edits ordered; 0 if there are none
    std::string error;
    std::string waits_for;  // the limit that cut the last slice short, or empty
  };
  const Progress& progress() const { return progress_; }

 private:
  struct Part {
    EditDescriptor edit;
    std::uint64_t cells_done = 0;  // behind it
  };
  void order_slice(WorldServer& world, const Clocks& now);
  /// Returns why the author may not make the edit, or nullopt.
  std::optional<std::string> refusal(const WorldServer& world, const EditDescriptor& edit) const;
  void fail(std::string what);
  void end_if_done(const WorldServer& world);

  PlaceOrder order_;
  PlaceLimits limits_;
  std::int32_t chunk_edge_;
  State state_ = State::placing;
  std::shared_ptr<PasteSource> source_;
  bool is_working_ = false;  // a worker cuts
  bool is_cut_ = false;      // the worker has cut all
  std::deque<Part> parts_;   // cut, in order
  ClientSequence next_seq_ = 1;
  std::optional<OperationId> first_op_;  // the action, once its first edit is accepted
  Progress progress_;
};

}  // namespace runstone
