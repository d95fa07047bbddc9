// TextureSending: answers the requests of clients for pictures. A server that follows answers them
// itself. The pictures are of the class chunks, so the link's pace, the budgets of bytes and the
// order of the queue hold for them as for terrain. Bounds:
//   - a session has kTexturesUnansweredMax pictures unanswered, otherwise it is closed;
//   - a picture is sent to a session kTextureAnswersMax times. Later answers are empty;
//   - a message that found the queue of its session full is kept, encoded, until it is sent;
//   - a call sends a session as much as its queue takes, kPartsAtOnce messages at most.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "server/world/order/order.hpp"
#include "server/world/sessions/sessions.hpp"

namespace runstone {

inline constexpr std::size_t kTexturesUnansweredMax = 2 * kTexturesWantedMax;
inline constexpr std::uint8_t kTextureAnswersMax = 2;
/// The bytes of a message of pictures, unless one picture has more. So chunks follow soon.
inline constexpr std::size_t kTextureMessageBytes = 16 * 1024;
/// A picture that is wanted counts as so many bytes that were read from the session.
inline constexpr std::size_t kWantedTextureBytes = 256;

class TextureSending {
 public:
  /// The arguments must outlive the object.
  TextureSending(Sessions& sessions, const Order& order) : sessions_(sessions), order_(order) {}

  void on_wanted(Session& session, const TexturesWanted& wanted);
  /// Sends the session one message of its pictures. Call it when its queue has room again, before
  /// chunks are queued.
  void drained(const Session& session);
  /// Sends pictures that had to wait. Call it on every tick. Cost: O(sessions that wait).
  void tick();
  void forget(SessionId session) { by_session_.erase(session); }

 private:
  static constexpr std::size_t kPartsAtOnce = 16;
  struct Wanting {
    std::deque<TextureHash> waiting;
    std::optional<EncodedMessage> unsent;  // the next message; its pictures do not wait any more
    std::size_t unsent_parts = 0;          // pictures of `unsent`
    std::vector<std::uint8_t> answers;     // by entry of the table; `unsent` included
    bool is_answered() const { return waiting.empty() && !unsent; }
  };
  /// Sends at most `count` messages, as many as the queue takes.
  void send(const Session& session, Wanting& wanting, std::size_t count);
  /// Makes the next message: `unsent`. Requires that there is none, and that a picture waits.
  void encode_next(Wanting& wanting) const;

  Sessions& sessions_;
  const Order& order_;
  std::map<SessionId, Wanting> by_session_;  // of the sessions that wanted pictures
};

}  // namespace runstone
