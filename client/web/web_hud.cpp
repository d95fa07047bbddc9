#include "client/web/web_hud.hpp"

#include <utility>

#include "client/web/page.hpp"
#include "common/core/text.hpp"
#include "common/materials/readable_name.hpp"

namespace runstone {
namespace {

/// Returns a text that is the same for equal names of lines. It is empty for a line of no player.
std::string text_of(const ChatLineId& id) {
  return id.name.empty() ? "" : std::to_string(id.utc_us) + " " + id.name;
}

}  // namespace

void WebHud::show_materials() {
  if (!play_.was_opened()) return;
  const WorldId& world = play_.session().welcome()->world_id;
  if (world_ != world) {
    world_ = world;
    page_clear_materials();
    materials_ = 1;
    slots_.reset();  // their colours may be others
  }
  const MaterialTable& materials = play_.pipeline().materials();
  for (; materials_ < materials.size(); ++materials_) {
    const MaterialInfo& info = materials[static_cast<Material>(materials_)];
    const std::uint32_t colour =
        std::uint32_t{info.colour[0]} << 16 | std::uint32_t{info.colour[1]} << 8 | info.colour[2];
    page_material(static_cast<int>(materials_),
                  with_unseen_replaced(readable_name(info.name)).c_str(), colour);
  }
}

void WebHud::show_slots() {
  const Slots now{play_.hotbar().slots(), play_.hotbar().slot()};
  if (slots_ == now) return;
  slots_ = now;
  for (std::size_t i = 0; i < kSlotCount; ++i)
    page_slot(static_cast<int>(i), now.materials[i], i == now.chosen ? 1 : 0);
}

void WebHud::show_walking() {
  const bool is_walking = play_.player().is_walking();
  if (std::exchange(is_walking_, is_walking) != is_walking) page_walking(is_walking ? 1 : 0);
}

void WebHud::notify(std::string_view text, NoticeKind kind) {
  page_notice(std::string(text).c_str(), kind == NoticeKind::warning ? 1 : 0);
}

void WebHud::step() {
  show_materials();
  show_slots();
  show_walking();
  for (const PlayerNotice& notice : play_.take_notices()) notify(notice.text, notice.kind);
  for (const ShownLine& line : play_.chat().take_lines())
    page_chat(line.text.c_str(), text_of(line.id).c_str());
  for (const ChatLineId& id : play_.chat().take_withdrawn())
    page_withdraw_chat(text_of(id).c_str());
  show_players();
  show_time();
}

void WebHud::show_time() {
  const ShownSequence now = shown_sequence(play_.session());
  const bool is_past = play_.session().replica().past().has_value();
  if (time_ == now && is_past_ == is_past) return;
  time_ = now;
  is_past_ = is_past;
  page_time(static_cast<double>(now.newest), static_cast<double>(now.shown), is_past ? 1 : 0);
}

void WebHud::show_players() {
  std::string names;
  int count = 0;
  for (const auto& [author, other] : play_.session().others()) {
    if (other.name.empty()) continue;  // the pose of a player whose name has not come yet
    names += (names.empty() ? "" : "\n") + with_unseen_replaced(other.name);
    ++count;
  }
  if (names == players_) return;
  page_players(count, names.c_str());
  players_ = std::move(names);
}

void WebHud::set_state(const std::string& text) {
  if (text == state_) return;
  page_state(text.c_str());
  state_ = text;
}

}  // namespace runstone
