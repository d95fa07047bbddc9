#include "client/play/player_hotbar.hpp"

namespace runstone {

void PlayerHotbar::fill(const MaterialTable& materials) {
  hotbar_.fill(materials);
  hold_chosen();
}

void PlayerHotbar::choose(std::size_t slot) {
  if (slot >= kSlotCount) return;
  hotbar_.choose(slot);
  hold_chosen();
}

void PlayerHotbar::scroll(int steps) {
  hotbar_.scroll(steps);
  hold_chosen();
}

void PlayerHotbar::hold(Material material) {
  if (material == kEmpty) return;
  hotbar_.hold(material);
  player_.hold(material);
}

bool PlayerHotbar::act(Action action) {
  if (action < Action::hold_slot_1 || action > Action::hold_slot_9) return false;
  choose(static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::hold_slot_1));
  return true;
}

void PlayerHotbar::hold_chosen() {
  if (hotbar_.held() != kEmpty) player_.hold(hotbar_.held());
}

}  // namespace runstone
