// Hotbar: nine slots with a material each, of which one is chosen. One thread.
#pragma once
#include <array>
#include <cstddef>

#include "client/input/action.hpp"
#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

class Hotbar {
 public:
  /// Fills the slots for a world: first with what builders use most, as far as the world has it
  /// under one of their names and as a full block, and then with other full blocks in the order of
  /// the table. So the slots have blocks even if the table begins with plants.
  void fill(const MaterialTable& materials);
  /// Chooses a slot, 0 to kSlotCount - 1.
  void choose(std::size_t slot) { slot_ = slot; }
  /// Chooses the slot `steps` to the left. The first and the last slot are neighbours.
  void scroll(int steps);
  /// Puts a material into the chosen slot. If another slot has it, chooses that slot instead.
  void hold(Material material);

  Material held() const { return slots_[slot_]; }
  std::size_t slot() const { return slot_; }
  const std::array<Material, kSlotCount>& slots() const { return slots_; }

 private:
  std::array<Material, kSlotCount> slots_{};
  std::size_t slot_ = 0;
};

}  // namespace runstone
