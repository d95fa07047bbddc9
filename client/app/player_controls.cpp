#include "client/app/player_controls.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "client/play/time_travel.hpp"
#include "client/play/tool_actions.hpp"
#include "client/play/wheel_actions.hpp"

namespace runstone {
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
      driver_(driver),
      motion_(session.replica(), player),
      clicks_(tool) {}

void PlayerControls::set_materials(const MaterialTable& materials) {
  motion_.set_materials(materials);
}

void PlayerControls::take(const WindowInput& input, double seconds, const ClientSettings& settings,
                          TimeUs now_us) {
  shows_players_ = input.shows_players;
  if (driver_ == Driver::person) move(input, seconds, settings);
  edit(input, now_us);
  if (const auto line = act_on_wheel(input, tool_, player_, hud_.hotbar())) hud_.notify(*line);
  for (const Action action : input.actions) act(action, now_us);
  if (!input.actions.empty() || input.scroll != 0) pipeline_.moved();
}

void PlayerControls::move(const WindowInput& input, double seconds,
                          const ClientSettings& settings) {
  motion_.step(input, seconds, {settings.sensitivity, settings.invert_y});
  if (player_.take_fallen_out())
    hud_.notify("you fell out of the world: you are at its spawn, and fly", NoticeKind::warning);
}

void PlayerControls::edit(const WindowInput& input, TimeUs now_us) {
  for (const std::string& why : clicks_.step(input, driver_ != Driver::script, now_us))
    hud_.notify(why, NoticeKind::warning);
  if (input.pick_clicks == 0) return;
  if (const auto hit = tool_.pick()) hud_.hotbar().hold(hit->material);
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
      return step_in_time(session_, -1);
    case Action::later:
      return step_in_time(session_, 1);
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

}  // namespace runstone
