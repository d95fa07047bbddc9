#include "client/app/script_actions.hpp"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include "client/replica/surface.hpp"
#include "common/materials/material_lookup.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

/// Returns the characters of a text. Requires well-formed UTF-8.
std::vector<char32_t> characters_of(std::string_view text) {
  std::vector<char32_t> out;
  for (const char byte : text) {
    const auto bits = static_cast<std::uint8_t>(byte);
    if (bits < 0x80) {
      out.push_back(bits);
    } else if (bits >= 0xC0) {
      out.push_back(bits >= 0xF0 ? bits & 0x07U : bits >= 0xE0 ? bits & 0x0FU : bits & 0x1FU);
    } else if (!out.empty()) {
      out.back() = out.back() << 6 | (bits & 0x3FU);
    }
  }
  return out;
}

}  // namespace

ScriptActions::ScriptActions(ClientSession& session, Player& player, MeshPipeline& pipeline,
                             EditTool& tool, const ViewFollower& view, TerminalChat& chat,
                             InputRouter& input, ClientHud& hud, WorldPanels& panels,
                             std::string screenshot_folder)
    : session_(session),
      player_(player),
      pipeline_(pipeline),
      tool_(tool),
      view_(view),
      chat_(chat),
      input_(input),
      hud_(hud),
      panels_(panels),
      screenshot_folder_(std::move(screenshot_folder)) {}

void ScriptActions::move_to(const WorldPos& eye) {
  player_.move_to(eye);
  pipeline_.moved();
}

void ScriptActions::look(double yaw, double pitch) {
  player_.look(yaw, pitch);
  pipeline_.moved();
}

void ScriptActions::set_time_of_day(double share) {
  pipeline_.look().set_time_of_day(share);
  pipeline_.moved();
}

Result<Material, std::string> ScriptActions::material(std::string_view name) const {
  const MaterialTable& materials = pipeline_.materials();
  std::size_t id = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), id);
  if (error == std::errc{} && end == name.data() + name.size() && id < materials.size())
    return static_cast<Material>(id);
  return find_material(materials, name);
}

std::optional<std::int32_t> ScriptActions::surface(std::int32_t x, std::int32_t z) const {
  return surface_of(session_.replica(), x, z);
}

void ScriptActions::finish_preview() {
  const Replica& shown = session_.replica();
  if (!shown.opened() || !tool_.box().is_preview_shown()) return;
  if (tool_.box().step_preview(shown, tool_.aim(), std::numeric_limits<std::size_t>::max()))
    pipeline_.moved();
}

bool ScriptActions::loaded() const {
  if (!view_.is_complete()) return false;
  const auto since_us = view_.complete_since_us();
  return pipeline_.is_up_to_date() || (since_us && steady_now_us() - *since_us >= kMeshWaitUsMax);
}

bool ScriptActions::sees_horizon() const {
  if (!loaded() || !pipeline_.is_far_meshed()) return false;
  const FarTiles::Missing missing = session_.replica().far_tiles().missing();
  return missing.roots + missing.others == 0;
}

bool ScriptActions::synced(std::uint64_t mark) const {
  // Two pongs are needed, because the first one may answer a ping that was sent before the mark.
  return view_.is_complete() && session_.pongs() >= mark + 2 &&
         session_.replica().local_edits().unanswered().empty();
}

void ScriptActions::travel(const HistoryRequest& request) {
  static_cast<void>(session_.request_history(request));
}

std::string ScriptActions::say(const std::string& text) {
  const auto sent = session_.chat(text);
  return sent ? std::string() : sent.error();
}

std::string ScriptActions::command(const std::string& text) {
  const auto given = session_.command(text);
  return given ? std::string() : given.error().what;
}

bool ScriptActions::show_answer() {
  for (const std::string& line : session_.command_lines()) fmt::print("{}\n", line);
  std::fflush(stdout);
  return session_.command_ok();
}

TimeUs ScriptActions::utc_now_us() const {
  const auto utc = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(utc).count();
}

void ScriptActions::press(const KeyChord& chord) {
  KeyEvent event;
  event.place = event.key = chord.key;
  event.control = chord.control;
  event.shift = chord.shift;
  event.alt = chord.alt;
  event.is_pressed = true;
  KeyEvent release = event;
  release.is_pressed = false;
  input_.push({event, release});
}

void ScriptActions::type(const std::string& text) {
  std::vector<InputEvent> events;
  for (const char32_t character : characters_of(text))
    events.emplace_back(CharacterEvent{character});
  input_.push(events);
}

void ScriptActions::click(double x, double y) {
  input_.push({CursorEvent{x, y, 0, 0}, ButtonEvent{MouseButton::left, true},
               ButtonEvent{MouseButton::left, false}});
}

void ScriptActions::inspect(InspectionMode mode, bool is_on) {
  InspectionModes modes = pipeline_.inspection().modes();
  modes.set(mode, is_on);
  pipeline_.inspect(modes);
}

void ScriptActions::show_map(bool is_shown, bool is_full) {
  hud_.map().set_full(is_full);
  hud_.map().set_open(is_shown);
  pipeline_.moved();
}

bool ScriptActions::show_rollback_answer() {
  for (const std::string& line : panels_.rollback().answer()) fmt::print("{}\n", line);
  std::fflush(stdout);
  return panels_.rollback().has_succeeded();
}

bool ScriptActions::screenshot(const std::string& file) {
  if (!pipeline_.draws()) return false;
  pipeline_.request_screenshot(screenshot_path(file), steady_now_us());
  return true;
}

std::string ScriptActions::screenshot_path(const std::string& file) const {
  return (std::filesystem::path(screenshot_folder_) / file).string();
}

std::optional<bool> ScriptActions::screenshot_written() const {
  if (!pipeline_.screenshots_done()) return std::nullopt;
  return pipeline_.screenshots_written();
}

}  // namespace runstone
