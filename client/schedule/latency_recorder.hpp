// LatencyRecorder: the way of every edit to this client's screen, stage by stage (design: latency-plus-mesh).
//   submit -> ordered -> received -> unpacked -> applied -> meshed -> uploaded -> presented
// Three ways are kept apart:
//   own_predicted  submit -> applied (to the shown runs) -> meshed -> uploaded -> presented
//   own_confirmed  submit -> ordered -> received -> unpacked -> applied; then durable, on its own
//   remote         all stages; times of the server's clock are converted with the offset known when it
//   arrived
// An edit takes the first mesh that contains it; one that changes several chunks is through a stage when the
// last of them is. Open loop: submit is the time an edit was scheduled for, not when the program got round to
// it. An edit that is never seen counts as infinite. Microseconds of this client's steady clock, all of them
// arguments. One thread.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "client/replica/clock_offset.hpp"
#include "client/replica/replica_changes.hpp"
#include "client/schedule/histogram.hpp"
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

enum class EditPath : std::uint8_t { own_predicted, own_confirmed, remote };
inline constexpr std::size_t kLatencyWayCount = 3;
const char* to_string(EditPath way);

struct WayReport {
  /// From submit to the end of each stage; `meshed` is latency-plus-mesh, `presented` is "to pixels".
  std::array<Histogram, kLatencyStageCount> since_submit;
  /// From the end of the stage before (submit, for the first one recorded).
  std::array<Histogram, kLatencyStageCount> step;
  std::uint64_t edits = 0;           // seen on this way, or due and never seen
  std::uint64_t without_effect = 0;  // no visible voxel changed: nothing to mesh, in no later stage
  std::uint64_t left_view = 0;       // its chunks left the view before it was drawn
  std::uint64_t unknown_submit = 0;  // its sender or we had no clock offset: in `step` only
};

struct LatencyReport {
  std::array<WayReport, kLatencyWayCount> ways;
  Histogram durable;           // own edits: submit -> known to be on disk
  std::uint64_t rejected = 0;  // own edits the server refused; in none of the above
  std::uint64_t unseen =
      0;  // own edits decided while we could not listen; not in own_confirmed and durable
  const WayReport& operator[](EditPath way) const { return ways[static_cast<std::size_t>(way)]; }
};

class LatencyRecorder {
 public:
  /// `last`: the stage that ends an edit: presented, or meshed for a client that draws nothing.
  explicit LatencyRecorder(LatencyStage last = LatencyStage::presented) : last_(last) {}

  /// An own edit was handed in; call before take() sees its news.
  void submitted(ClientSequence seq, TimeUs scheduled_us) { own_[seq] = scheduled_us; }
  /// An own edit was due but could not even be handed in: it is infinitely late.
  void not_submitted();
  void take(const ReplicaChanges& news, const ClockOffset& clock, TimeUs now_us);

  /// A mesh made from the chunk's shown runs of this serial is ready / on the GPU. Serials:
  /// Replica::shown_serial().
  void meshed(const ChunkKey& key, std::uint64_t serial, TimeUs at_us);
  void uploaded(const ChunkKey& key, std::uint64_t serial, TimeUs at_us);
  /// The frame with everything uploaded so far is on the screen.
  void presented(TimeUs at_us);

  /// Edits still on their way.
  std::size_t open_edits() const { return open_.size(); }
  /// All of it, with what is still open counted as infinite.
  LatencyReport report() const;

 private:
  using EditKey = std::pair<OperationId, bool>;  // and whether it is the prediction
  struct OpenEdit {
    EditPath way = EditPath::remote;
    std::optional<TimeUs> submitted_us;
    std::array<TimeUs, kLatencyStageCount> at{};
    std::array<bool, kLatencyStageCount> reached{};
    std::size_t chunks_left = 0;
    bool drawn = false;  // at least one chunk went all the way
  };
  struct Waiter {
    EditKey edit;
    std::uint64_t serial = 0;
    bool meshed = false, uploaded = false;
  };

  void take_edit(const EditNews& news, const std::map<ChunkKey, std::uint64_t>& serials,
                 const ClockOffset& clock);
  void chunk_done(const EditKey& key, bool drawn);
  void reach(OpenEdit& edit, LatencyStage stage, TimeUs at_us);
  void finish(const OpenEdit& edit);
  void remember(const EditKey& key);

  LatencyStage last_;
  LatencyReport done_;
  std::map<ClientSequence, TimeUs> own_;  // until durable or rejected
  std::set<ClientSequence> unconfirmed_;  // own edits, predicted and not yet confirmed
  std::map<EditKey, OpenEdit> open_;
  std::map<ChunkKey, std::vector<Waiter>> waiters_;
  std::set<EditKey> finished_;  // the last kFinishedMax, so that late parts count once
  std::deque<EditKey> finished_order_;
};

}  // namespace runstone
