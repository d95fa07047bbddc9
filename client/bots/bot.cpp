#include "client/bots/bot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace runstone {
namespace {

/// Bound of the edits of one step. A fleet that was delayed catches up in several steps.
constexpr int kStepEditsMax = 64;
constexpr TimeUs kJoinStepUs = 5'000;   // resolution of the join time
constexpr TimeUs kMoveStepUs = 50'000;  // between two positions of a walking bot
constexpr TimeUs kAwayStepUs = 20'000;  // while there is no open session

}  // namespace

void BotCounts::merge(const BotCounts& other) {
  due += other.due;
  submitted += other.submitted;
  not_ready += other.not_ready;
  refused += other.refused;
  confirmed += other.confirmed;
  rejected += other.rejected;
  durable += other.durable;
  others += other.others;
  confirm_us.merge(other.confirm_us);
  joins += other.joins;
  join_us.merge(other.join_us);
}

Bot::Bot(BotConfig config)
    : config_(std::move(config)), schedule_(config_.rate, config_.phase, config_.edits_max) {}

// Makes the behaviour once the world is known. It is kept when the bot connects again.
bool Bot::enter() {
  const Welcome* open = world();
  if (open == nullptr) return false;
  if (behaviour_) return true;
  if (open->materials.size() < 2) return false;  // no material to build with
  behaviour_ = make_behaviour(config_.role, {open->spawn, config_.site, config_.sites},
                              open->materials, config_.seed);
  return true;
}

void Bot::follow(TimeUs now_us) {
  const auto began_us = schedule_.began_us();
  const double seconds = began_us ? static_cast<double>(now_us - *began_us) / 1e6 : 0;
  const WorldPos at = behaviour_->position(seconds);
  set_pose({at, 0, 0});
  const auto down = [](double v) { return static_cast<std::int32_t>(std::floor(v)); };
  View requested = config_.session.view;
  requested.centre = chunk_of({down(at.x), down(at.y), down(at.z)}, world()->chunk_edge);
  if (requested_view_ == requested) return;
  requested_view_ = requested;
  set_view(requested);
}

void Bot::step(TimeUs now_us) {
  tick(now_us);
  if (!enter()) return;
  follow(now_us);
  drain_changes();
  if (joining_us_ && loaded()) {
    ++counts_.joins;
    counts_.join_us.add(now_us - *joining_us_);
    joining_us_.reset();
  }
  for (int i = 0; i < kStepEditsMax; ++i) {
    const auto due_us = schedule_.due_us();
    if (!due_us || *due_us > now_us) return;
    // A join storm disconnects when its view is loaded, and connects again at once.
    if (config_.role == BotRole::join_storm && joining_us_) return;
    schedule_.pass();
    ++counts_.due;
    act(*due_us, now_us);
  }
}

void Bot::act(TimeUs due_us, TimeUs now_us) {
  if (config_.role == BotRole::join_storm) {
    joining_us_ = now_us;
    return depart();
  }
  const auto edit = behaviour_->next_edit(ground());
  if (!edit) {
    ++counts_.not_ready;
  } else {
    ++(offer(*edit, due_us, now_us) ? counts_.submitted : counts_.refused);
  }
}

TimeUs Bot::due_us(TimeUs now_us) const {
  TimeUs due_us = tick_due_us(now_us);
  if (joining_us_) due_us = std::min(due_us, now_us + kJoinStepUs);
  if (config_.role == BotRole::walk || config_.role == BotRole::run_away) {
    due_us = std::min(due_us, now_us + kMoveStepUs);
  }
  if (world() == nullptr || !behaviour_) return std::min(due_us, now_us + kAwayStepUs);
  if (joining_us_ && config_.role == BotRole::join_storm) return due_us;
  return std::min(due_us, schedule_.due_us().value_or(due_us));
}

}  // namespace runstone
