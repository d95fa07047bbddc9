#include "client/app/script_actions.hpp"

#include <spdlog/spdlog.h>

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include "client/build/action_progress.hpp"
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

ScriptActions::ScriptActions(Play& play, TerminalChat& chat, ClientHud& hud,
                             std::string screenshot_folder)
    : play_(play),
      session_(play.session()),
      chat_(chat),
      hud_(hud),
      screenshot_folder_(std::move(screenshot_folder)) {}

void ScriptActions::move_to(const WorldPos& eye) {
  play_.player().move_to(eye);
  play_.pipeline().moved();
}

void ScriptActions::look(double yaw, double pitch) {
  play_.player().look(yaw, pitch);
  play_.pipeline().moved();
}

void ScriptActions::set_time_of_day(double share) {
  play_.set_own_time(share);
  play_.pipeline().look().set_time_of_day(share);  // also for a picture of this turn
  play_.pipeline().moved();
}

void ScriptActions::set_antialiasing(Antialiasing antialiasing) {
  play_.pipeline().look().set_antialiasing(antialiasing);
  play_.pipeline().moved();
}

Result<Material, std::string> ScriptActions::material(std::string_view name) const {
  const MaterialTable& materials = play_.pipeline().materials();
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
  if (!shown.opened() || !play_.tool().box().is_preview_shown()) return;
  if (play_.tool().box().step_preview(shown, play_.tool().aim(),
                                      std::numeric_limits<std::size_t>::max()))
    play_.pipeline().moved();
}

Result<void, std::string> ScriptActions::load_clipboard(const std::string& file,
                                                        const ModelChoices& model) {
  const auto said = read_clipboard(file, play_.tool().box(), model);
  if (!said) return failure(said.error());
  if (!said->empty()) spdlog::info("{}", *said);
  return {};
}

bool ScriptActions::loaded() const {
  if (!play_.view().is_complete()) return false;
  const auto since_us = play_.view().complete_since_us();
  return play_.pipeline().is_up_to_date() ||
         (since_us && steady_now_us() - *since_us >= kMeshWaitUsMax);
}

bool ScriptActions::sees_horizon() const {
  if (!loaded() || !play_.pipeline().is_far_meshed()) return false;
  const FarTiles::Missing missing = session_.replica().far_tiles().missing();
  return missing.roots + missing.others == 0;
}

std::optional<Result<void, std::string>> ScriptActions::built() const {
  const EditTool& tool = play_.tool();
  if (tool.is_building()) return std::nullopt;
  const ActionProgress& last = tool.last_build();
  if (last.stop_reason.empty() && last.edits_refused == 0) return Result<void, std::string>();
  return Result<void, std::string>(failure(end_text_of("action", last)));
}

bool ScriptActions::synced(std::uint64_t mark) const {
  // Two pongs are needed, because the first one may answer a ping that was sent before the mark.
  return play_.view().is_complete() && session_.pongs() >= mark + 2 &&
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
  play_.input().push({event, release});
}

void ScriptActions::type(const std::string& text) {
  std::vector<InputEvent> events;
  for (const char32_t character : characters_of(text))
    events.emplace_back(CharacterEvent{character});
  play_.input().push(events);
}

void ScriptActions::click(double x, double y) {
  play_.input().push({CursorEvent{x, y, 0, 0}, ButtonEvent{MouseButton::left, true},
                      ButtonEvent{MouseButton::left, false}});
}

void ScriptActions::inspect(InspectionMode mode, bool is_on) {
  InspectionModes modes = play_.pipeline().inspection().modes();
  modes.set(mode, is_on);
  play_.pipeline().inspect(modes);
}

void ScriptActions::show_map(bool is_shown, bool is_full) {
  hud_.map().set_full(is_full);
  hud_.map().set_open(is_shown);
  play_.pipeline().moved();
}

bool ScriptActions::show_rollback_answer() {
  for (const std::string& line : play_.panels().rollback().answer()) fmt::print("{}\n", line);
  std::fflush(stdout);
  return play_.panels().rollback().has_succeeded();
}

std::string ScriptActions::show_library_answer() {
  const LibraryControl& library = play_.panels().library();
  std::string failed;
  for (const std::string& line : library.answer()) {
    if (library.has_succeeded()) {
      fmt::print("{}\n", line);
    } else {
      failed += (failed.empty() ? "" : "; ") + line;
    }
  }
  std::fflush(stdout);
  return failed;
}

void ScriptActions::hold(Material material) { play_.hotbar().hold(material, steady_now_us()); }

Result<void, std::string> ScriptActions::use_hotbar(const script::NamedHotbar& order) {
  using What = script::NamedHotbar::What;
  const HotbarOrder::What what = order.what == What::keep   ? HotbarOrder::What::keep
                                 : order.what == What::take ? HotbarOrder::What::take
                                                            : HotbarOrder::What::forget;
  const auto done = play_.carry_out(HotbarOrder{what, order.name});
  if (!done) return failure(done.error());
  return {};
}

bool ScriptActions::screenshot(const std::string& file) {
  if (!play_.pipeline().draws()) return false;
  play_.pipeline().request_screenshot(screenshot_path(file), steady_now_us());
  return true;
}

std::string ScriptActions::screenshot_path(const std::string& file) const {
  return (std::filesystem::path(screenshot_folder_) / file).string();
}

std::optional<Result<void, std::string>> ScriptActions::screenshot_written() const {
  if (!play_.pipeline().screenshots_done()) return std::nullopt;
  return play_.pipeline().screenshots_written();
}

}  // namespace runstone
