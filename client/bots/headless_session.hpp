// HeadlessSession: a client's side of the protocol without a world. It edits and reconnects as
// ClientSession does, with the same ServerConnection and LocalEdits, but keeps only the version of
// each chunk (VersionTracker). It decodes and verifies every message. It counts as a violation what
// no decoder can see:
//   - a commit of another epoch, or a sequence that comes twice;
//   - a version that does not continue that of its chunk (VersionTracker);
//   - an answer to a local edit that waits for none, or a durable watermark that decreases.
// For each edit of a commit it records how long after the edit's due time the commit was received
// and verified. Pure: time and randomness are arguments, in microseconds of the process' steady
// clock. One thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/bots/fleet_statistics.hpp"
#include "client/bots/version_tracker.hpp"
#include "client/replica/local_edits.hpp"
#include "client/schedule/histogram.hpp"
#include "client/session/server_connection.hpp"
#include "protocol/codec/commit_walk.hpp"

namespace runstone {

/// Counts since the session was made. Those of its local edits are in local_edits().counters().
struct HeadlessCounts {
  std::uint64_t commits = 0, edits = 0;  // verified
  /// Local edits: from the due time until the commit was received and verified.
  Histogram confirm_us;
};

class HeadlessSession {
 public:
  /// `clock` is read once a commit is verified. `fleet` must outlive the session.
  HeadlessSession(SessionConfig config, FleetStatistics& fleet, TimeUs (*clock)());

  // As the functions of ClientSession.
  void connected(const Nonce& nonce, const std::optional<ChannelBinding>& binding, TimeUs now_us,
                 bool is_listed = false) {
    connection_.connected(nonce, binding, now_us, is_listed);
  }
  void disconnected() { connection_.disconnected(); }
  void receive(Message message, const Arrival& arrival);
  void tick(TimeUs now_us);
  std::vector<Message> take_outgoing() { return connection_.take_outgoing(); }
  bool wants_close() const { return connection_.wants_close(); }
  void close(GoodbyeReason reason, std::string text) { connection_.close(reason, std::move(text)); }
  Result<ClientSequence> offer(const EditDescriptor& edit, TimeUs submitted_us, TimeUs now_us);
  /// Until the first call no view is sent, and the server sends no chunks.
  void set_view(const View& view);
  void set_pose(const Pose& pose) { connection_.set_pose(pose); }
  bool is_open() const { return connection_.is_open(); }
  const std::optional<SessionEnd>& end() const { return connection_.end(); }
  const std::optional<Welcome>& welcome() const { return connection_.welcome(); }
  const Servers& servers() const { return connection_.servers(); }
  std::uint64_t servers_number() const { return connection_.servers_number(); }
  View view() const { return connection_.view(); }
  std::uint64_t connect_count() const { return connection_.connect_count(); }
  /// Returns true if every chunk of the view arrived or is unavailable, none lacks edits, and all
  /// tiles arrived.
  bool loaded() const;

  /// Reads a commit without decoding it into a message, see LinkCallbacks::on_bytes(). Returns true
  /// if it was a commit of an open connection and was read. Returns false, and reads nothing, for
  /// other messages. Fails if the commit is malformed.
  Result<bool> receive_bytes(MessageKind kind, ByteView body, std::uint16_t chunk_edge,
                             TimeUs received_us);
  /// Returns when tick() has something to do next.
  TimeUs tick_due_us() const { return connection_.tick_due_us(kPingEveryUs); }

  Sequence durable() const { return durable_; }
  const LocalEdits& local_edits() const { return local_edits_; }
  const VersionTracker& versions() const { return versions_; }
  const HeadlessCounts& counts() const { return counts_; }

 private:
  void on_session_accepted(const SessionAccepted& accepted, TimeUs now_us);
  /// Ends the connection because of a message that answers nothing.
  void fail_unrequested();
  void on_chunks(const Chunks& chunks, TimeUs now_us);
  void on_uniform_chunks(const UniformChunks& uniform, TimeUs now_us);
  void on_view_state(const ViewState& state);
  void on_reject(const Reject& reject);
  void on_resume(const Resume& resume);
  void on_durable(const Durable& durable);
  Result<void> on_edit(const WalkedEdit& edit);
  void on_local_edit(const WalkedEdit& edit);
  void send_view();

  ServerConnection connection_;
  FleetStatistics& fleet_;
  TimeUs (*clock_now_)();
  bool has_view_ = false;

  LocalEdits local_edits_;
  VersionTracker versions_;
  CommitWalk walk_;
  CommitWalk::OnEdit on_walked_;
  // These members describe the commit that is being read.
  TimeUs walked_us_ = 0;                     // when it was received
  std::vector<TimeUs> walked_due_us_;        // due times of its edits
  std::vector<TimeUs> walked_local_due_us_;  // due times of its local edits
  Sequence last_ = 0;                        // newest edit on this connection
  Sequence durable_ = 0;
  HeadlessCounts counts_;
};

}  // namespace runstone
