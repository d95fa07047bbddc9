#include "client/web/web_hud.hpp"

#include <utility>

#include "client/web/page.hpp"
#include "common/materials/readable_name.hpp"

namespace runstone {

void WebHud::set_materials(const MaterialTable& materials, bool fills) {
  page_clear_materials();
  for (std::size_t i = 1; i < materials.size(); ++i) {
    const MaterialInfo& info = materials[static_cast<Material>(i)];
    const std::uint32_t colour =
        std::uint32_t{info.colour[0]} << 16 | std::uint32_t{info.colour[1]} << 8 | info.colour[2];
    page_material(static_cast<int>(i), readable_name(info.name).c_str(), colour);
  }
  if (fills) {
    hotbar_.fill(materials);
    player_.hold(hotbar_.held());
  }
  show_slots();
}

void WebHud::show_slots() {
  for (std::size_t i = 0; i < kSlotCount; ++i)
    page_slot(static_cast<int>(i), hotbar_.slots()[i], i == hotbar_.slot() ? 1 : 0);
}

void WebHud::choose(std::size_t slot) {
  if (slot >= kSlotCount) return;
  hotbar_.choose(slot);
  player_.hold(hotbar_.held());
  show_slots();
}

void WebHud::scroll(int steps) {
  hotbar_.scroll(steps);
  player_.hold(hotbar_.held());
  show_slots();
}

void WebHud::hold(Material material) {
  hotbar_.hold(material);
  player_.hold(material);
  show_slots();
}

void WebHud::notify(std::string_view text, bool is_warning) {
  page_notice(std::string(text).c_str(), is_warning ? 1 : 0);
}

void WebHud::take(const ReplicaChanges& changes) {
  const bool is_read_only = session_.is_server_read_only();
  if (std::exchange(told_read_only_, is_read_only) != is_read_only) {
    notify(is_read_only ? "the server is read-only: its disk is full"
                        : "the server accepts edits again",
           is_read_only);
  }
  for (const RejectedEdit& reject : changes.rejects) {
    notify(std::string("the server refused an edit: ") + to_string(reject.reason) + ' ' +
               reject.detail,
           true);
  }
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
  for (const ChatLine& line : session_.drain_chat())
    page_chat(line.name.c_str(), line.text.c_str());
  if (is_answer_due_ && !session_.commanding()) {
    is_answer_due_ = false;
    for (const std::string& line : session_.command_lines()) page_chat("", line.c_str());
  }
  std::string names;
  int count = 0;
  for (const auto& [author, other] : session_.others()) {
    if (other.name.empty()) continue;  // the pose of a player whose name has not come yet
    names += (names.empty() ? "" : "\n") + other.name;
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
