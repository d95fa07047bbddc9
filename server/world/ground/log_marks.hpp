// LogMarkReads: answers the requests of clients for marks of the log. A reader reads them; the
// world strand adds the names of their authors. A session has one read under way, and its requests
// take effect view_interval_us apart, as its views and moments of the past. Who may not see the
// past may not see its authors either.
// Thread: the world strand.
#pragma once
#include <string>
#include <vector>

#include "protocol/codec/log_mark_messages.hpp"
#include "server/world/ground/ground_base.hpp"

namespace runstone {

/// All sessions together.
inline constexpr std::size_t kLogMarkReadsMax = 2;
/// A mark counts as so many bytes that were read from the session.
inline constexpr std::size_t kLogMarkBytes = 128;
/// The mark of a voxel counts as so many, because the records near the voxel are read for it.
inline constexpr std::size_t kVoxelMarkBytes = 4096;

class LogMarkReads {
 public:
  explicit LogMarkReads(GroundBase& base) : base_(base) {}

  /// Replaces the session's earlier request, if that is still waiting.
  void on_request(Viewer& viewer, const LogMarksRequest& request, const Clocks& now);
  /// Carries out requests that had to wait. Call it on every tick.
  void read_waiting(const Clocks& now);
  /// Handles the answer to WorldEnvironment::read_log_marks(). The error is for the client.
  void finished(SessionId session, std::uint32_t request,
                const Result<FoundLogMarks, std::string>& found, const Clocks& now);

 private:
  void read_next(Viewer& viewer, const Clocks& now);
  std::vector<LogAuthor> authors_of(const std::vector<LogMark>& marks) const;

  GroundBase& base_;
  std::size_t reads_ = 0;  // requests that readers read
};

}  // namespace runstone
