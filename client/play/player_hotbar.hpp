// PlayerHotbar: the hotbar of a player, who holds the material of the chosen slot. A player never
// holds an empty slot: the material held before stays. One thread.
#pragma once
#include <cstddef>

#include "client/input/action.hpp"
#include "client/play/hotbar.hpp"
#include "client/play/player.hpp"

namespace runstone {

class PlayerHotbar {
 public:
  /// `player` must outlive the object.
  explicit PlayerHotbar(Player& player) : player_(player) {}

  /// Fills the slots for a world, as Hotbar::fill() does.
  void fill(const MaterialTable& materials);
  /// Chooses a slot. Does nothing if there is no such slot.
  void choose(std::size_t slot);
  /// Chooses the slot `steps` to the left.
  void scroll(int steps);
  /// Puts a material into the player's hand, and into the chosen slot unless another slot has it.
  /// Does nothing for kEmpty.
  void hold(Material material);
  /// Carries out the action of a key that chooses a slot. Returns false if it is another action.
  bool act(Action action);

  const Hotbar& slots() const { return hotbar_; }

 private:
  void hold_chosen();

  Player& player_;
  Hotbar hotbar_;
};

}  // namespace runstone
