// LightSession: a client's side of the protocol without a world. It greets, edits, pings and resumes as ClientSession does,
// but keeps of each chunk only its version (VersionBook). Every message is decoded and verified as that of any server; what
// breaks a rule which no decoder can see is counted as a violation:
//   - commits are of the session's epoch, and their sequences ascend: none comes twice;
//   - versions continue from chunk to chunk (VersionBook);
//   - answers are to own edits that wait for one, and no edit is answered twice; the durable watermark never goes back.
// For each edit of a commit, own or not, it notes how long after its due time the commit was here and verified. Pure: time and
// randomness come in as arguments (microseconds of the process' steady clock). One thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/bots/crowd_book.hpp"
#include "client/bots/version_book.hpp"
#include "client/replica/client_session.hpp"
#include "client/replica/clock_offset.hpp"
#include "client/replica/own_edits.hpp"
#include "client/schedule/histogram.hpp"
#include "protocol/codec/commit_walk.hpp"

namespace runstone {

/// Counts since the session was made.
struct LightCounts {
  std::uint64_t commits = 0, edits = 0;  // verified
  std::uint64_t own_confirmed = 0, own_rejected = 0, own_durable = 0, own_unseen = 0;
  Histogram own_us;  // due -> own commit received and verified
};

class LightSession {
 public:
  /// `clock` is read once a commit is verified. `crowd` must outlive the session.
  LightSession(SessionConfig config, CrowdBook& crowd, TimeUs (*clock)());

  // As ClientSession.
  void connected(const Nonce& nonce, TimeUs now_us);
  void disconnected();
  void receive(Message message, const Arrival& arrival);
  void tick(TimeUs now_us);
  std::vector<Message> take_outgoing();
  bool wants_close() const { return wants_close_; }
  void close(GoodbyeReason reason, std::string text);
  Result<ClientSequence> submit(const EditDescriptor& edit, TimeUs submitted_us, TimeUs now_us);
  /// Until it is called no view is sent, and nothing comes.
  void set_view(const View& view);
  void set_pose(const Pose& pose) { pose_ = pose; }
  bool is_open() const { return state_ == SessionState::open; }
  const std::optional<SessionEnd>& end() const { return end_; }
  const std::optional<Welcome>& welcome() const { return welcome_; }
  View view() const;
  std::uint64_t openings() const { return openings_; }
  /// Every chunk of the view came, or is said not to be had, and none lacks edits.
  bool loaded() const;

  /// Takes commits without decoding them into a message; see LinkEvents::on_bytes(). Before Ready, everything else.
  Result<bool> receive_bytes(FrameClass frame_class, ByteView body, std::uint16_t chunk_edge,
                             TimeUs received_us);
  /// When tick() has something to do next.
  TimeUs tick_due_us() const;

  const OwnEdits& own_edits() const { return own_; }
  const VersionBook& book() const { return book_; }
  const LightCounts& counts() const { return counts_; }

 private:
  void on_welcome(Welcome welcome);
  void on_ready(const Ready& ready, TimeUs now_us);
  void on_reject(const Reject& reject);
  void on_durable(const Durable& durable);
  Result<void> on_edit(const WalkedEdit& edit);
  void on_own_edit(const WalkedEdit& edit);
  void settle_own();
  void send(ClientSequence seq, const OwnEdit& own);
  void fail_with(GoodbyeReason reason, std::string text, bool final);

  SessionConfig config_;
  CrowdBook& crowd_;
  TimeUs (*clock_now_)();
  SessionState state_ = SessionState::offline;
  std::vector<Message> outgoing_;
  bool wants_close_ = false;
  std::optional<SessionEnd> end_;
  Hello hello_;
  std::optional<Welcome> welcome_;
  AuthorId author_ = 0;
  std::uint64_t openings_ = 0;
  ClockOffset clock_;
  std::optional<View> view_wished_, view_sent_;
  Pose pose_;
  std::optional<Pose> pose_sent_;
  TimeUs ping_us_ = 0, heard_us_ = 0, move_us_ = 0;

  OwnEdits own_;
  VersionBook book_;
  CommitWalk walk_;
  CommitWalk::OnEdit on_walked_;
  TimeUs walked_us_ = 0;                                   // when the commit at hand was received
  std::vector<TimeUs> walked_due_us_, walked_own_due_us_;  // of its edits
  Sequence last_ = 0;                                      // of the newest edit on this connection
  Sequence durable_ = 0;
  LightCounts counts_;
};

}  // namespace runstone
