#include "client/web/web_hud.hpp"

#include <utility>

#include "client/play/printed_line.hpp"
#include "client/web/page.hpp"
#include "common/core/text.hpp"
#include "common/materials/readable_name.hpp"

namespace runstone {

void WebHud::enter(const MaterialTable& materials) {
  page_clear_materials();
  materials_ = 1;
  add_materials(materials);
  hotbar_.fill(materials);
  slots_.reset();  // their colours may be others
}

void WebHud::add_materials(const MaterialTable& materials) {
  for (; materials_ < materials.size(); ++materials_) {
    const MaterialInfo& info = materials[static_cast<Material>(materials_)];
    const std::uint32_t colour =
        std::uint32_t{info.colour[0]} << 16 | std::uint32_t{info.colour[1]} << 8 | info.colour[2];
    page_material(static_cast<int>(materials_),
                  with_unseen_replaced(readable_name(info.name)).c_str(), colour);
  }
}

void WebHud::show_slots() {
  const Hotbar& slots = hotbar_.slots();
  if (slots_ && slots_->slots() == slots.slots() && slots_->slot() == slots.slot()) return;
  slots_ = slots;
  for (std::size_t i = 0; i < kSlotCount; ++i)
    page_slot(static_cast<int>(i), slots.slots()[i], i == slots.slot() ? 1 : 0);
}

void WebHud::notify(std::string_view text, bool is_warning) {
  page_notice(std::string(text).c_str(), is_warning ? 1 : 0);
}

void WebHud::take(const ReplicaChanges& changes) {
  for (const ServerNotice& notice : notices_.take_state()) notify(notice.text, notice.is_warning);
  for (const RejectedEdit& reject : changes.rejects) notify(notice_of(reject).text, true);
}

void WebHud::say(const std::string& line) {
  if (line.find_first_not_of(' ') == std::string::npos) return;
  if (line.starts_with('/')) {
    const auto given = session_.command(line.substr(1));
    is_answer_due_ = is_answer_due_ || given.has_value();
    if (!given) notify(given.error().what, true);
  } else if (const auto sent = session_.chat(line); !sent) {
    notify(sent.error(), true);
  }
}

void WebHud::step() {
  show_slots();
  for (const ChatLine& line : session_.drain_chat()) page_chat(printed_line(line).c_str());
  if (is_answer_due_ && !session_.commanding()) {
    is_answer_due_ = false;
    for (const std::string& line : session_.command_lines())
      page_chat(with_unseen_replaced(line).c_str());
  }
  show_players();
  show_time();
}

void WebHud::show_time() {
  const ShownSequence now = shown_sequence(session_);
  const bool is_past = session_.replica().past().has_value();
  if (time_ == now && is_past_ == is_past) return;
  time_ = now;
  is_past_ = is_past;
  page_time(static_cast<double>(now.newest), static_cast<double>(now.shown), is_past ? 1 : 0);
}

void WebHud::show_players() {
  std::string names;
  int count = 0;
  for (const auto& [author, other] : session_.others()) {
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
