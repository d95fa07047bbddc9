// HeadlessSession: a client's side of the protocol without a world. It edits and resumes as ClientSession does, upon the same
// ServerConnection, but keeps of each chunk only its version (VersionTracker). Every message is decoded and verified as that of
// any server; what breaks a rule which no decoder can see is counted as a violation:
//   - commits are of the session's epoch, and their sequences ascend: none comes twice;
//   - versions continue from chunk to chunk (VersionTracker);
//   - answers are to own edits that wait for one, and no edit is answered twice; the durable watermark never goes back.
// For each edit of a commit, own or not, it notes how long after its due time the commit was here and verified. Pure: time and
// randomness come in as arguments (microseconds of the process' steady clock). One thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/bots/fleet_statistics.hpp"
#include "client/bots/version_tracker.hpp"
#include "client/replica/local_edits.hpp"
#include "client/replica/server_connection.hpp"
#include "client/schedule/histogram.hpp"
#include "protocol/codec/commit_walk.hpp"

namespace runstone {

/// Counts since the session was made.
struct LightCounts {
  std::uint64_t commits = 0, edits = 0;  // verified
  std::uint64_t own_confirmed = 0, own_rejected = 0, own_durable = 0, own_unseen = 0;
  Histogram own_us;  // due -> own commit received and verified
};

class HeadlessSession {
 public:
  /// `clock` is read once a commit is verified. `crowd` must outlive the session.
  HeadlessSession(SessionConfig config, FleetStatistics& fleet, TimeUs (*clock)());

  // As ClientSession.
  void connected(const Nonce& nonce, TimeUs now_us) { connection_.connected(nonce, now_us); }
  void disconnected() { connection_.disconnected(); }
  void receive(Message message, const Arrival& arrival);
  void tick(TimeUs now_us);
  std::vector<Message> take_outgoing() { return connection_.take_outgoing(); }
  bool wants_close() const { return connection_.wants_close(); }
  void close(GoodbyeReason reason, std::string text) { connection_.close(reason, std::move(text)); }
  Result<ClientSequence> submit(const EditDescriptor& edit, TimeUs submitted_us, TimeUs now_us);
  /// Until it is called no view is sent, and nothing comes.
  void set_view(const View& view);
  void set_pose(const Pose& pose) { connection_.set_pose(pose); }
  bool is_open() const { return connection_.is_open(); }
  const std::optional<SessionEnd>& end() const { return connection_.end(); }
  const std::optional<Welcome>& welcome() const { return connection_.welcome(); }
  View view() const { return connection_.view(); }
  std::uint64_t connect_count() const { return connection_.connect_count(); }
  /// Every chunk of the view came, or is said not to be had, and none lacks edits.
  bool loaded() const;

  /// Takes commits without decoding them into a message; see LinkEvents::on_bytes(). Before Ready, everything else.
  Result<bool> receive_bytes(FrameClass frame_class, ByteView body, std::uint16_t chunk_edge,
                             TimeUs received_us);
  /// When tick() has something to do next.
  TimeUs tick_due_us() const { return connection_.tick_due_us(kPingEveryUs); }

  const LocalEdits& local_edits() const { return own_; }
  const VersionTracker& book() const { return book_; }
  const LightCounts& counts() const { return counts_; }

 private:
  void on_session_accepted(const SessionAccepted& ready, TimeUs now_us);
  void on_reject(const Reject& reject);
  void on_durable(const Durable& durable);
  Result<void> on_edit(const WalkedEdit& edit);
  void on_own_edit(const WalkedEdit& edit);
  void settle_own();
  void send_view();

  ServerConnection connection_;
  FleetStatistics& crowd_;
  TimeUs (*clock_now_)();
  bool is_view_wished_ = false;

  LocalEdits own_;
  VersionTracker book_;
  CommitWalk walk_;
  CommitWalk::OnEdit on_walked_;
  TimeUs walked_us_ = 0;                                   // when the commit at hand was received
  std::vector<TimeUs> walked_due_us_, walked_own_due_us_;  // of its edits
  Sequence last_ = 0;                                      // of the newest edit on this connection
  Sequence durable_ = 0;
  LightCounts counts_;
};

}  // namespace runstone
