// HeadlessBot: a bot without voxels. It verifies all messages and measures. One thread can step a
// thousand of them.
#pragma once
#include "client/bots/bot.hpp"
#include "client/bots/headless_session.hpp"

namespace runstone {

class HeadlessBot final : public Bot {
 public:
  /// `fleet` must outlive the bot. `clock`: see HeadlessSession.
  HeadlessBot(BotConfig config, FleetStatistics& fleet, TimeUs (*clock)());

  HeadlessSession& session() { return session_; }
  const HeadlessSession& session() const { return session_; }
  bool loaded() const override { return session_.loaded(); }
  Sequence durable() const override { return session_.durable(); }
  BotCounts counts() const override;

 private:
  const Welcome* world() const override {
    return session_.is_open() ? &*session_.welcome() : nullptr;
  }
  void set_view(const View& view) override { session_.set_view(view); }
  void set_pose(const Pose& pose) override { session_.set_pose(pose); }
  const GroundHeight& ground() const override { return fleet_.ground; }
  void tick(TimeUs now_us) override { session_.tick(now_us); }
  TimeUs tick_due_us(TimeUs /*now_us*/) const override { return session_.tick_due_us(); }
  bool offer(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us) override;
  bool is_answered() const override { return session_.local_edits().all().empty(); }
  void depart() override { session_.close(GoodbyeReason::closing, ""); }

  FleetStatistics& fleet_;
  HeadlessSession session_;
};

}  // namespace runstone
