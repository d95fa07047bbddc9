// LightBot: a bot without voxels, of which one thread carries a thousand: it verifies all that comes, and measures.
#pragma once
#include "client/bots/bot.hpp"
#include "client/bots/light_session.hpp"

namespace runstone {

class LightBot final : public Bot {
 public:
  /// `crowd` must outlive the bot; `clock` as in LightSession.
  LightBot(BotConfig config, CrowdBook& crowd, TimeUs (*clock)());

  LightSession& session() { return session_; }
  const LightSession& session() const { return session_; }
  bool loaded() const override { return session_.loaded(); }
  BotCounts counts() const override;

 private:
  const Welcome* world() const override { return session_.is_open() ? &*session_.welcome() : nullptr; }
  void set_view(const View& view) override { session_.set_view(view); }
  void set_pose(const Pose& pose) override { session_.set_pose(pose); }
  const Ground& ground() const override { return crowd_.ground; }
  void tick(TimeUs now_us) override { session_.tick(now_us); }
  TimeUs tick_due_us(TimeUs /*now_us*/) const override { return session_.tick_due_us(); }
  bool submit(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us) override;
  bool is_answered() const override { return session_.own_edits().all().empty(); }
  void depart() override { session_.close(GoodbyeReason::closing, ""); }

  CrowdBook& crowd_;
  LightSession session_;
};

}  // namespace runstone
