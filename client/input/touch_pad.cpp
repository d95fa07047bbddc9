#include "client/input/touch_pad.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace runstone {

void TouchPad::begin(std::int64_t id, double x, double y, TimeUs now_us) {
  const bool has_stick = std::any_of(touches_.begin(), touches_.end(), [](const auto& entry) {
    return entry.second.kind == Kind::stick;
  });
  const bool is_stick = !has_stick && x < kStickShare * width_ && y > kStickShare * height_;
  touches_[id] = {is_stick ? Kind::stick : Kind::resting, x, y, x, y, now_us};
}

void TouchPad::move(std::int64_t id, double x, double y) {
  const auto found = touches_.find(id);
  if (found == touches_.end()) return;
  Touch& touch = found->second;
  const double dx = x - std::exchange(touch.x, x), dy = y - std::exchange(touch.y, y);
  if (touch.kind == Kind::stick)
    return set_stick((x - touch.first_x) / kStickReach, (y - touch.first_y) / kStickReach);
  const double moved = std::hypot(x - touch.first_x, y - touch.first_y);
  if (touch.kind == Kind::resting && moved > kTapMoveMax) touch.kind = Kind::turning;
  if (touch.kind != Kind::resting)
    events_.emplace_back(CursorEvent{x, y, dx * kTurnPerPixel, dy * kTurnPerPixel});
}

void TouchPad::end(std::int64_t id, TimeUs now_us) {
  step(now_us);
  const auto found = touches_.find(id);
  if (found == touches_.end()) return;
  const Kind kind = found->second.kind;
  touches_.erase(found);
  if (kind == Kind::stick) return set_stick(0, 0);
  if (kind == Kind::resting) {
    events_.emplace_back(ButtonEvent{button(), true});
    events_.emplace_back(ButtonEvent{button(), false});
  }
  if (kind == Kind::holding) events_.emplace_back(ButtonEvent{held_, false});
}

void TouchPad::cancel() {
  for (const auto& [id, touch] : std::exchange(touches_, {})) {
    if (touch.kind == Kind::stick) set_stick(0, 0);
    if (touch.kind == Kind::holding) events_.emplace_back(ButtonEvent{held_, false});
  }
}

void TouchPad::step(TimeUs now_us) {
  for (auto& [id, touch] : touches_) {
    if (touch.kind != Kind::resting || now_us - touch.since_us < kHoldUs) continue;
    touch.kind = Kind::holding;
    held_ = button();
    events_.emplace_back(ButtonEvent{held_, true});
  }
}

std::vector<InputEvent> TouchPad::take_events() { return std::exchange(events_, {}); }

void TouchPad::set_stick(double x, double y) {
  StickEvent stick;
  stick.move_x = std::clamp(x, -1.0, 1.0);
  stick.move_y = std::clamp(y, -1.0, 1.0);
  events_.emplace_back(stick);
}

}  // namespace runstone
