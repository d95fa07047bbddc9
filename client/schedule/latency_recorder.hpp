// LatencyRecorder: times every edit on its path to this client's screen, stage by stage.
//   submit -> ordered -> received -> unpacked -> applied -> meshed -> uploaded -> presented
// Three paths are recorded separately:
//   - local_predicted: a local edit, as predicted: submit -> applied (to the shown runs) -> meshed
//     -> uploaded -> presented;
//   - local_confirmed: a local edit, as confirmed: submit -> ordered -> received -> unpacked ->
//     applied. The time until it is durable is recorded apart;
//   - remote: all stages. Times of the server's clock are converted with the offset known when the
//     edit arrived.
// An edit is in the first mesh made from runs that contain it. An edit of several chunks passes a
// stage when its last chunk does. Open loop: submit is the time for which an edit was scheduled,
// not the time at which the program submitted it. An edit that is never seen counts as infinite.
// All times are arguments, in microseconds of this client's steady clock. One thread.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "client/replica/replica_changes.hpp"
#include "client/schedule/histogram.hpp"
#include "client/session/clock_offset.hpp"
#include "common/core/ids.hpp"

namespace runstone {

enum class LatencyStage : std::uint8_t {
  ordered,
  received,
  unpacked,
  applied,
  meshed,
  uploaded,
  presented
};
inline constexpr std::size_t kLatencyStageCount = 7;
const char* to_string(LatencyStage stage);

enum class EditPath : std::uint8_t { local_predicted, local_confirmed, remote };
inline constexpr std::size_t kEditPathCount = 3;
/// Returns the name in reports: "local_predicted", "local_confirmed" or "remote".
const char* to_string(EditPath path);

struct PathReport {
  /// The times from submit to the end of each stage. `meshed` is latency-plus-mesh, `presented` is
  /// "to pixels".
  std::array<Histogram, kLatencyStageCount> since_submit;
  /// The times from the end of the previous recorded stage, or from submit for the first one.
  std::array<Histogram, kLatencyStageCount> step;
  std::uint64_t edits = 0;           // seen on this path, or due and never seen
  std::uint64_t without_effect = 0;  // no visible voxel changed: no later stage is recorded
  std::uint64_t left_view = 0;       // its chunks left the view before they were drawn
  /// Edits recorded in `step` only, because their sender or this client had no clock offset.
  std::uint64_t unknown_submit = 0;
};

/// One edit whose submit time is known, with the times of its stages. Times are those of
/// steady_now_us().
struct RecentEdit {
  EditPath path = EditPath::remote;
  TimeUs submitted_us = 0;
  std::array<TimeUs, kLatencyStageCount> at{};
  std::array<bool, kLatencyStageCount> reached{};
};

struct LatencyReport {
  std::array<PathReport, kEditPathCount> paths;
  // Local edits:
  Histogram durable;           // submit -> known to be on disk
  std::uint64_t rejected = 0;  // rejected by the server; in none of the above
  /// Resolved, but their commits did not arrive (ReplicaChanges::unseen). They are not in
  /// local_confirmed and durable.
  std::uint64_t unseen = 0;
  const PathReport& operator[](EditPath path) const {
    return paths[static_cast<std::size_t>(path)];
  }
};

class LatencyRecorder {
 public:
  /// `last`: the last recorded stage: presented, or meshed for a client that draws nothing.
  explicit LatencyRecorder(LatencyStage last = LatencyStage::presented) : last_(last) {}

  /// Records that a local edit was submitted. Call it before take() gets the changes that contain
  /// the edit.
  void submitted(ClientSequence seq, TimeUs scheduled_us) { local_[seq] = scheduled_us; }
  /// Records that a local edit was due and the session did not accept it. The edit counts as
  /// infinitely late.
  void not_submitted();
  void take(const ReplicaChanges& changes, const ClockOffset& clock, TimeUs now_us);

  /// Record that a mesh made from the chunk's shown runs is ready, and that it is on the GPU.
  /// `serial`: the Replica::shown_serial() of these runs.
  void meshed(const ChunkKey& key, std::uint64_t serial, TimeUs at_us);
  void uploaded(const ChunkKey& key, std::uint64_t serial, TimeUs at_us);
  /// Records that the frame with everything uploaded so far is on the screen.
  void presented(TimeUs at_us);

  /// Returns the number of edits that have not reached the last stage.
  std::size_t open_edits() const { return open_.size(); }
  /// Returns the last kRecentMax edits that passed the last stage, or that have none; the newest
  /// one is the last.
  const std::deque<RecentEdit>& recent() const { return recent_; }
  static constexpr std::size_t kRecentMax = 64;
  /// Returns everything recorded so far. Edits that are still open count as infinite.
  LatencyReport report() const;

 private:
  using EditKey = std::pair<OperationId, bool>;  // true: the prediction
  struct OpenEdit {
    EditPath path = EditPath::remote;
    std::optional<TimeUs> submitted_us;
    std::array<TimeUs, kLatencyStageCount> at{};
    std::array<bool, kLatencyStageCount> reached{};
    std::size_t chunks_left = 0;
    bool drawn = false;  // at least one chunk reached the last stage
  };
  struct Waiter {
    EditKey edit;
    std::uint64_t serial = 0;
    bool meshed = false, uploaded = false;
  };

  void take_edit(const EditChange& change, const std::map<ChunkKey, std::uint64_t>& serials,
                 const ClockOffset& clock);
  void chunk_done(const EditKey& key, bool drawn);
  void reach(OpenEdit& edit, LatencyStage stage, TimeUs at_us);
  void finish(const OpenEdit& edit);
  void remember(const EditKey& key);

  LatencyStage last_;
  LatencyReport done_;
  std::deque<RecentEdit> recent_;
  std::map<ClientSequence, TimeUs> local_;  // submit times, until durable or rejected
  std::set<ClientSequence> unconfirmed_;    // local edits that are predicted and not confirmed
  std::map<EditKey, OpenEdit> open_;
  std::map<ChunkKey, std::vector<Waiter>> waiters_;
  /// The last kFinishedMax edits, so that an edit whose chunks arrive late counts once.
  std::set<EditKey> finished_;
  std::deque<EditKey> finished_order_;
};

}  // namespace runstone
