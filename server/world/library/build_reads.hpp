// BuildReads: answers the requests of clients for lists of builds and for the files of builds. A
// reader reads them; the world strand adds the names of the players who added the builds. A server
// that follows answers them itself. Bounds:
//   - a session has one list under way. A later request replaces the one that waits, and the lists
//     of a session begin view_interval_us apart;
//   - a session has kBuildPiecesMax requests for pieces under way, of which one is being read, so
//     that the answers have the order of the requests. Further ones are refused;
//   - kBuildListsRead lists and kBuildPiecesRead pieces of all sessions are read at a time. Sessions
//     take turns.
// Answers that found the queue of their session full wait until it has room, and nothing more is
// read for the session meanwhile.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "common/rights/right.hpp"
#include "server/world/order/order.hpp"
#include "server/world/rights/rights.hpp"
#include "server/world/sessions/sessions.hpp"

namespace runstone {

/// Requests for pieces of one session that are not answered.
inline constexpr std::size_t kBuildPiecesMax = 4;
/// Lists and pieces of all sessions that readers read at a time.
inline constexpr std::size_t kBuildListsRead = 2, kBuildPiecesRead = 4;
/// A listed build counts as so many bytes that were read from the session. Those of a piece count
/// as they are.
inline constexpr std::size_t kListedBuildBytes = 512;

class BuildReads {
 public:
  /// The arguments must outlive the object.
  BuildReads(const WorldConfig& config, WorldEnvironment& environment, Sessions& sessions,
             const Order& order, const Rights& rights)
      : config_(config),
        environment_(environment),
        sessions_(sessions),
        order_(order),
        rights_(rights) {}

  void on_request(Session& session, const BuildsRequest& request, const Clocks& now);
  void on_piece_request(Session& session, const BuildPieceRequest& request, const Clocks& now);
  /// Handles the answer to WorldEnvironment::find_builds(). The error is for the client.
  void found(SessionId session, std::uint32_t request, Result<FoundBuilds, std::string> found,
             const Clocks& now);
  /// Handles the answer to WorldEnvironment::read_build_piece(). The error is for the client.
  void piece_read(SessionId session, std::uint32_t request, Result<Bytes, std::string> piece,
                  const Clocks& now);
  /// Sends the answers and begins the reads that had to wait. Call it on every tick. Cost: O(sessions
  /// that used the library).
  void serve(const Clocks& now);
  void forget(SessionId session) { by_session_.erase(session); }

 private:
  struct SessionReads {
    std::optional<BuildsRequest> list;  // that waits
    bool is_list_read = false;
    TimeUs list_due_us = 0;                // when the next list may be read
    std::deque<BuildPieceRequest> pieces;  // under way; the first one is read if is_piece_read
    bool is_piece_read = false;
    std::deque<EncodedMessage> unsent;  // at most one list and kBuildPiecesMax pieces
  };
  std::optional<std::string> refusal(const Session& session) const;
  std::optional<std::string> refusal(const Session& session,
                                     const BuildPieceRequest& request) const;
  void send(const Session& session, SessionReads& reads, const Message& message);
  /// Returns true if no answer of the session waits any more.
  bool send_unsent(const Session& session, SessionReads& reads);
  void serve(const Session& session, SessionReads& reads, const Clocks& now);

  const WorldConfig& config_;
  WorldEnvironment& environment_;
  Sessions& sessions_;
  const Order& order_;
  const Rights& rights_;
  std::map<SessionId, SessionReads> by_session_;  // of the sessions that used the library
  SessionId last_served_ = 0;
  std::size_t lists_read_ = 0, pieces_read_ = 0;
};

}  // namespace runstone
