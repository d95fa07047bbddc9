#include "client/bots/bot.hpp"

#include <cmath>
#include <utility>

namespace runstone {
namespace {

/// Edits handed in by one step at most: a fleet that was held up catches up little by little.
constexpr int kStepEditsMax = 64;

}  // namespace

Bot::Bot(BotConfig config) : config_(std::move(config)), session_(config_.session) {}

bool Bot::settled() const {
  return (ended_ || (config_.edits_max && counts_.due >= *config_.edits_max)) &&
         session_.replica().own_edits().all().empty();
}

// The behaviour is made when the world is known, and lives through reconnections.
bool Bot::enter() {
  if (behaviour_) return true;
  if (!session_.is_open()) return false;
  const Welcome& world = *session_.welcome();
  if (world.materials.size() < 2) return false;  // nothing to build with
  behaviour_ =
      make_behaviour(config_.role, {world.spawn, config_.site, config_.sites}, world.materials, config_.seed);
  return true;
}

void Bot::follow(TimeUs now_us) {
  const double seconds = began_us_ ? static_cast<double>(now_us - *began_us_) / 1e6 : 0;
  const WorldPos at = behaviour_->position(seconds);
  session_.set_pose({at, 0, 0});
  const auto down = [](double v) { return static_cast<std::int32_t>(std::floor(v)); };
  View view = config_.session.view;
  view.centre = chunk_of({down(at.x), down(at.y), down(at.z)}, session_.welcome()->chunk_edge);
  if (session_.view().centre != view.centre) session_.set_view(view);
}

void Bot::step(TimeUs now_us) {
  session_.tick(now_us);
  if (!enter()) return;
  follow(now_us);
  take_news();
  if (!began_us_ || ended_) return;
  for (int i = 0; i < kStepEditsMax; ++i) {
    if (config_.edits_max && counts_.due >= *config_.edits_max) return;
    const auto due_us =
        *began_us_ + static_cast<TimeUs>(static_cast<double>(counts_.due) / config_.rate * 1e6);
    if (due_us > now_us) return;
    ++counts_.due;
    const auto edit = behaviour_->next_edit(session_.replica());
    if (!edit) {
      ++counts_.not_ready;
      continue;
    }
    const auto sequence = session_.submit(*edit, due_us, now_us);
    if (!sequence) {
      ++counts_.refused;
      continue;
    }
    ++counts_.submitted;
    ledger_.add(*edit);
    open_[*sequence] = {due_us, *edit};
  }
}

void Bot::take_news() {
  const ReplicaNews news = session_.replica().take_news();
  for (const EditNews& edit : news.edits) {
    if (edit.predicted) continue;
    if (!edit.own) {
      ++counts_.others;
      continue;
    }
    const auto found = open_.find(edit.op.seq);
    if (found == open_.end()) continue;  // a chunk of it came later than the others
    counts_.own_us.add(edit.applied_us - found->second.due_us);
    ++counts_.confirmed;
    open_.erase(found);
  }
  for (const RejectNews& reject : news.rejects) {
    ++counts_.rejected;
    if (const auto found = open_.find(reject.seq); found != open_.end()) {
      ledger_.forget(found->second.edit);
      open_.erase(found);
    }
  }
  counts_.durable += news.durable.size();
}

}  // namespace runstone
