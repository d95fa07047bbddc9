// Hotbar: nine slots with a material each, of which one is chosen. The player holds its material. A
// player never holds an empty slot: the material held before stays. One thread.
#pragma once
#include <array>
#include <cstddef>
#include <optional>

#include "client/input/action.hpp"
#include "client/play/player.hpp"
#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

class Hotbar {
 public:
  /// `player` must outlive the object.
  explicit Hotbar(Player& player) : player_(player) {}

  /// Fills the slots for a world: first with what builders use most, as far as the world has it
  /// under one of their names and as a full block, and then with other full blocks in the order of
  /// the table. So the slots have blocks even if the table begins with plants. Chooses the first
  /// slot.
  void fill(const MaterialTable& materials);
  /// Fills the slots with these materials, and chooses a slot. A material that the world does not
  /// have leaves its slot as it is.
  void take(const std::array<Material, kSlotCount>& slots, std::size_t slot,
            const MaterialTable& materials);
  /// Chooses a slot. Does nothing if there is no such slot.
  void choose(std::size_t slot);
  /// Chooses the slot `steps` to the left. The first and the last slot are neighbours.
  void scroll(int steps);
  /// Puts a material into the player's hand. If a slot has it, chooses that slot; otherwise puts it
  /// into the chosen slot. Does nothing for kEmpty.
  void hold(Material material, TimeUs now_us);
  /// Puts the material of the voxel in sight into the player's hand, as hold() does. But if the
  /// chosen slot was set less than kFreshUs ago, puts it into the next slot that was not, so that
  /// several materials can be picked one after another.
  void pick(Material material, TimeUs now_us);
  static constexpr TimeUs kFreshUs = 3'000'000;
  /// Carries out the action of a key that chooses a slot. Returns false if it is another action.
  bool act(Action action);

  std::size_t slot() const { return slot_; }
  const std::array<Material, kSlotCount>& slots() const { return slots_; }

 private:
  bool is_fresh(std::size_t slot, TimeUs now_us) const {
    return set_us_[slot] && now_us - *set_us_[slot] < kFreshUs;
  }

  Player& player_;
  std::array<Material, kSlotCount> slots_{};
  std::array<std::optional<TimeUs>, kSlotCount> set_us_{};  // when hold() or pick() set the slot
  std::size_t slot_ = 0;
};

}  // namespace runstone
