// Receipts: what each session was told of its edits and of the log: rejects, how far the log is
// durable, its epoch, and new materials. Bounds: a session with too many rejects that do not fit
// its queue is closed.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "server/world/order/order.hpp"
#include "server/world/sessions/sessions.hpp"

namespace runstone {

/// Why a session ends if its client cannot resume.
inline constexpr const char* kConnectAgain =
    "another server has taken the world over: connect again";

class Receipts {
 public:
  Receipts(const WorldConfig& config, Sessions& sessions, const Order& order)
      : config_(config), sessions_(sessions), order_(order) {}

  /// Reports that the session gets `welcome`, which says the epoch, the durable watermark, and the
  /// materials.
  void welcomed(const Session& session, const Welcome& welcome);
  void forget(SessionId session) { sent_.erase(session); }

  // Rejects.
  /// Sends a reject. If the session's queue is full, the reject is sent later, in order. A session
  /// with too many pending rejects is closed.
  void reject(Session& session, Reject reject);
  /// Sends pending rejects as far as they fit, then the durable watermark if the session awaits it.
  void send_pending(Session& session);
  bool has_pending(const Session& session) const;

  // The durable watermark.
  Durable durable() const { return {order_.epoch(), order_.durable(), order_.is_disk_full()}; }
  /// Notes that the session's client has an edit up to `seq`. The session gets every watermark at
  /// once until one covers `seq`.
  void expect_durable(const Session& session, Sequence seq);
  /// Sends the watermark to the sessions whose client has edits that are not yet acknowledged.
  void send_durable_to_authors();
  /// Sends the watermark to every session, once in durable_interval_us. Sessions without edits need
  /// it only to resume, so they do not get a message for every group commit of the log.
  void broadcast_durable(const Clocks& now);
  /// The next broadcast_durable() sends it.
  void hurry_durable() { durable_due_us_ = 0; }

  // The epoch.
  /// Tells an open session of the epoch, unless it knows it. Closes the session if its client
  /// cannot go on in another epoch.
  void send_epoch(Session& session);
  void send_epoch_to_all();

  // Materials.
  /// Sends the materials that an open session lacks, then the shapes, then the list of textures.
  /// Closes a session without the feature materials, and one whose queue is full. A session without
  /// the feature shapes or textures gets none of them.
  void send_materials(Session& session);
  void send_materials_to_all();

 private:
  struct Sent {
    Epoch epoch = 0;
    Sequence durable = 0;
    bool is_read_only = false;
    std::size_t materials = 0;    // rows of the material table that it has
    std::size_t shaped = 0;       // entries of Order::shaped() that it has
    std::size_t textures = 0;     // entries of WorldTextures::given() that it has
    Sequence awaits_durable = 0;  // of its client's last edit
    std::vector<Reject> rejects;  // that did not fit the session's queue, in order
  };
  /// Returns true if the session lacks the watermark and may get it. While rejects are pending it
  /// may not, because they precede it.
  bool lacks_durable(const Session& session, const Sent& sent) const;
  /// The messages about materials, by what a session has. They are made once for all sessions.
  struct News {
    std::map<std::size_t, std::vector<EncodedMessage>> rows, shapes, textures;
  };
  void send_materials(Session& session, News& news);
  /// Sends messages. Returns false if the session is closed then.
  bool send_news(Session& session, const std::vector<EncodedMessage>& messages);
  /// Returns the rows from `known` on, without shapes.
  std::vector<EncodedMessage> messages_of_rows(std::size_t known) const;
  /// Returns the shapes of Order::shaped() from `known` on.
  std::vector<EncodedMessage> messages_of_shapes(std::size_t known) const;
  /// Returns the entries of WorldTextures::given() from `known` on.
  std::vector<EncodedMessage> messages_of_textures(std::size_t known) const;
  /// Sends the watermark to sessions, in one round. If the queue of a session is full, a later call
  /// sends it. Requires ascending numbers.
  void send_durable(std::span<const SessionId> sessions);

  const WorldConfig& config_;
  Sessions& sessions_;
  const Order& order_;
  std::map<SessionId, Sent> sent_;
  TimeUs durable_due_us_ = 0;  // when every session gets the watermark next
};

}  // namespace runstone
