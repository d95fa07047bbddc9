// ReplicaBot: a bot with a whole replica. It applies every edit, compares digests, and knows which
// voxels that it built are intact.
#pragma once
#include <map>

#include "client/bots/bot.hpp"
#include "client/bots/fleet_statistics.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

class ReplicaBot final : public Bot {
 public:
  /// `fleet` must outlive the bot.
  ReplicaBot(BotConfig config, FleetStatistics& fleet);

  ClientSession& session() { return session_; }
  const ClientSession& session() const { return session_; }
  bool loaded() const override { return session_.loaded(); }
  Sequence durable() const override { return session_.replica().durable(); }
  BotCounts counts() const override;
  PlacedVoxels::Standing standing() const override { return placed_.compare(session_.replica()); }

 private:
  const Welcome* world() const override {
    return session_.is_open() ? &*session_.welcome() : nullptr;
  }
  void set_view(const View& view) override { session_.set_view(view); }
  void set_pose(const Pose& pose) override { session_.set_pose(pose); }
  const GroundHeight& ground() const override { return ground_; }
  void tick(TimeUs now_us) override { session_.tick(now_us); }
  TimeUs tick_due_us(TimeUs now_us) const override;
  void drain_changes() override;
  bool offer(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us) override;
  bool is_answered() const override { return is_answered_; }
  void depart() override { session_.close(GoodbyeReason::closing, ""); }

  FleetStatistics& fleet_;
  ClientSession session_;
  ReplicaGround ground_{session_.replica()};
  PlacedVoxels placed_;
  struct Open {
    TimeUs due_us = 0;
    EditDescriptor edit;
  };
  std::map<ClientSequence, Open> open_;  // edits without an answer
  bool is_answered_ = true;              // all edits, as of the last drain_changes()
};

}  // namespace runstone
