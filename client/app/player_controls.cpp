#include "client/app/player_controls.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "client/app/tool_actions.hpp"
#include "client/body/shown_space.hpp"

namespace runstone {
namespace {

/// The log is divided into this many steps of `[` and `]`.
constexpr Sequence kScrubSteps = 100;
/// A stick of a gamepad that is wholly to the side turns as the mouse does by so many units a
/// second.
constexpr double kStickLook = 1'000;

}  // namespace

PlayerControls::PlayerControls(ClientSession& session, Player& player, EditTool& tool,
                               MeshPipeline& pipeline, ClientHud& hud, TerminalChat& chat,
                               ScriptActions& actions, Driver driver)
    : session_(session),
      player_(player),
      tool_(tool),
      pipeline_(pipeline),
      hud_(hud),
      chat_(chat),
      actions_(actions),
      driver_(driver) {}

void PlayerControls::set_materials(const MaterialTable& materials) {
  body_materials_ = body_materials(materials);
}

void PlayerControls::take(const WindowInput& input, double seconds, const ClientSettings& settings,
                          TimeUs now_us) {
  shows_players_ = input.shows_players;
  if (driver_ == Driver::person) move(input, seconds, settings);
  edit(input, now_us);
  if (input.scroll != 0) {
    if (input.resizes) {
      tool_.box().change_size(input.scroll);
    } else if (input.fast && !player_.is_walking()) {
      player_.change_flying_speed(input.scroll);
      hud_.notify(fmt::format("flying speed: {} voxels a second", player_.flying_speed()));
    } else {
      hud_.scroll(input.scroll);
    }
  }
  for (const Action action : input.actions) act(action, now_us);
  if (!input.actions.empty() || input.scroll != 0) pipeline_.moved();
}

void PlayerControls::move(const WindowInput& input, double seconds,
                          const ClientSettings& settings) {
  WindowInput turned = input;
  turned.look_dx += input.turn_x * kStickLook * seconds;
  turned.look_dy += input.turn_y * kStickLook * seconds;
  turned.look_dx *= settings.sensitivity;
  turned.look_dy *= settings.sensitivity * (settings.invert_y ? -1 : 1);
  player_.turn(turned);
  if (!player_.is_walking()) return player_.fly(input, seconds);
  const Replica& replica = session_.replica();
  if (!replica.opened()) return;
  player_.walk(input, seconds, ShownSpace(replica), body_materials_);
  if (player_.take_fallen_out())
    hud_.notify("you fell out of the world: you are at its spawn, and fly", NoticeKind::warning);
}

void PlayerControls::edit(const WindowInput& input, TimeUs now_us) {
  const auto note = [&](const Result<void, std::string>& done) {
    if (!done) hud_.notify(done.error(), NoticeKind::warning);
  };
  const bool repeats = tool_.repeats();
  int acts = remove_button_.acts(input.remove_clicks, input.remove_held && repeats, now_us);
  while (acts-- > 0) note(tool_.press(ToolButton::clear, now_us));
  acts = place_button_.acts(input.place_clicks, input.place_held && repeats, now_us);
  while (acts-- > 0) note(tool_.press(ToolButton::place, now_us));
  if (input.remove_held || input.place_held) {
    tool_.drag();
  } else if (driver_ != Driver::script || input.remove_clicks + input.place_clicks != 0) {
    note(tool_.release(now_us));
  }
  if (input.pick_clicks == 0) return;
  if (const auto hit = tool_.pick()) hud_.hold(hit->material);
}

void PlayerControls::act(Action action, TimeUs now_us) {
  if (hud_.act(action)) return;
  if (const auto done = act_on_tool(tool_, action, now_us)) {
    hud_.notify(*done ? **done : done->error(),
                *done ? NoticeKind::information : NoticeKind::warning);
    return;
  }
  switch (action) {
    case Action::release:
      is_released_ = true;
      return;
    case Action::walk_or_fly:
      return player_.set_walking(!player_.is_walking());
    case Action::undo:
      return chat_.send("/undo");  // the answer is shown
    case Action::redo:
      return chat_.send("/redo");
    case Action::earlier:
      return scrub(-1);
    case Action::later:
      return scrub(1);
    case Action::live:
      return static_cast<void>(session_.request_history({}));
    case Action::screenshot:
      return take_picture();
    case Action::ground:
      shows_ground_ = !shows_ground_;
      return;
    default:
      return;
  }
}

void PlayerControls::take_picture() {
  const TimeUs utc_us = actions_.utc_now_us();
  const std::string file = fmt::format("runstone-{:%Y-%m-%d-%H%M%S}-{:03}.png",
                                       fmt::gmtime(utc_us / 1'000'000), utc_us / 1'000 % 1'000);
  if (actions_.screenshot(file)) hud_.notify("picture: " + actions_.screenshot_path(file));
}

void PlayerControls::scrub(int steps) {
  const Sequence newest = std::min(session_.replica().newest(), kSequenceShownMax);
  Sequence from = newest;
  if (session_.loading_history()) {
    const HistoryRequest& under_way = session_.history_request();
    if (under_way.to == HistoryTarget::sequence) from = under_way.seq;
  } else if (session_.replica().past()) {
    from = session_.replica().past()->seq;
  }
  const auto step = static_cast<std::int64_t>(std::max<Sequence>(1, newest / kScrubSteps));
  const auto to = static_cast<Sequence>(
      std::max<std::int64_t>(0, static_cast<std::int64_t>(std::min(from, newest)) + steps * step));
  HistoryRequest request;  // the live world
  if (to < newest) {
    request.to = HistoryTarget::sequence;
    request.seq = to;
  }
  static_cast<void>(session_.request_history(request));
}

}  // namespace runstone
