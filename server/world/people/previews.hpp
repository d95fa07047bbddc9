// Previews: passes on what a player is about to do to those who see the place. A preview is in no
// log and changes nothing. It is dropped, not queued, where it does not fit: the sender's next one
// replaces it.
// Thread: the world strand.
#pragma once
#include <map>
#include <vector>

#include "common/core/token_bucket.hpp"
#include "server/world/ground/ground.hpp"
#include "server/world/order/receipts.hpp"

namespace runstone {

/// The sessions that get one preview, at most.
inline constexpr std::size_t kPreviewReadersMax = 32;
/// Previews that a session may send, and that it is sent, each second.
inline constexpr std::uint64_t kPreviewsPerSecond = 6, kPreviewBurst = 12;
inline constexpr std::uint64_t kPreviewsReadPerSecond = 20, kPreviewsReadBurst = 40;

class Previews {
 public:
  Previews(const WorldConfig& config, Sessions& sessions, const Order& order,
           const Receipts& receipts, const Ground& ground)
      : config_(config), sessions_(sessions), order_(order), receipts_(receipts), ground_(ground) {}

  /// Sends the preview to the sessions that see, together with the sender, a chunk that it touches:
  /// sessions with the feature that are in the live world, whose queue is not full, of other
  /// players. Sessions that got the sender's last preview and do not get this one are told that it
  /// is gone. A stroke goes to those who have the feature, unless one of its places is out of reach
  /// or a material is unknown: then they get the edits alone. A preview that the server would refuse
  /// as an edit, because of reach, heights, size or materials, is passed on as none; rights are not
  /// checked. What is passed on counts as read from the sender, and so does a share of the work of
  /// a stroke. Cost: O(touched chunks + their subscribers + places).
  void on_share(Session& session, const PreviewShare& share, const Clocks& now);
  void forget(SessionId session) { by_session_.erase(session); }

 private:
  struct SessionPreviews {
    TokenBucket sent{kPreviewsPerSecond, kPreviewBurst};
    TokenBucket read{kPreviewsReadPerSecond, kPreviewsReadBurst};
    std::vector<SessionId> readers;  // sessions that show its last preview, ascending
  };
  bool is_possible(Session& session, const EditDescriptor& edit, const Clocks& now) const;
  bool is_possible(Session& session, const BrushStroke& stroke, const Clocks& now) const;
  bool reads_previews(const Session& other, const Session& sender) const;
  std::vector<SessionId> viewers(SessionId session, const std::vector<EditDescriptor>& edits) const;
  void pass_on(const Session& sender, const std::vector<SessionId>& to,
               const PlayerPreview& preview);

  const WorldConfig& config_;
  Sessions& sessions_;
  const Order& order_;
  const Receipts& receipts_;
  const Ground& ground_;
  std::map<SessionId, SessionPreviews> by_session_;  // of the sessions that send or read previews
};

}  // namespace runstone
