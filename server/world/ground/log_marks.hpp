// LogMarkReads: answers the requests of clients for marks of the log. A reader reads them; the
// world strand adds the names of their authors. Players who may not see the past may not see its
// authors either. These bounds keep a client from delaying others:
//   - A session has one read under way. A later request replaces the one that waits.
//   - Its requests take effect view_interval_us apart, as its views and moments of the past. After
//     a mark of a voxel it also waits kMarkPauseUs for each unit of its cost.
//   - All sessions together have kLogMarkReadsMax reads under way, and take turns.
// Thread: the world strand.
#pragma once
#include <string>
#include <vector>

#include "protocol/codec/log_mark_messages.hpp"
#include "server/world/ground/ground_base.hpp"

namespace runstone {

/// All sessions together. There are two history readers, so one is left for moments of the past.
inline constexpr std::size_t kLogMarkReadsMax = 1;
/// About ten times as long as a reader needs for a unit of FoundLogMarks::cost.
inline constexpr TimeUs kMarkPauseUs = 40;
/// A mark counts as so many bytes that were read from the session.
inline constexpr std::size_t kLogMarkBytes = 128;
/// The mark of a voxel counts as so many bytes, because the records near the voxel are read for it.
inline constexpr std::size_t kVoxelMarkBytes = 4096;

class LogMarkReads {
 public:
  explicit LogMarkReads(GroundBase& base) : base_(base) {}

  /// Replaces the session's earlier request, if that is still waiting.
  void on_request(Viewer& viewer, const LogMarksRequest& request, const Clocks& now);
  /// Carries out requests that had to wait, in turns. Call it on every tick.
  void read_waiting(const Clocks& now);
  /// Handles the answer to WorldEnvironment::read_log_marks(). The error is for the client.
  void finished(SessionId session, std::uint32_t request,
                const Result<FoundLogMarks, std::string>& found, const Clocks& now);

 private:
  void read_next(Viewer& viewer, const Clocks& now);
  std::vector<LogAuthor> authors_of(const std::vector<LogMark>& marks) const;

  GroundBase& base_;
  std::size_t reads_ = 0;  // requests that readers read
  SessionId last_ = 0;     // the session whose request was read last
};

}  // namespace runstone
