#include "client/play/hotbar.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "common/materials/material_lookup.hpp"

namespace runstone {
namespace {

/// The materials that builders use most, one for each slot: the first name that the world has.
/// Names of Luanti's default game precede those of the built-in table, which an imported world gets
/// beside its own materials.
constexpr std::array<std::string_view, 2> kFirst[] = {
    {"stone"},           {"dirt_with_grass", "grass"},  {"dirt"},  {"wood", "planks"},
    {"brick"},           {"stonebrick", "stone_brick"}, {"glass"}, {"tree", "log"},
    {"meselamp", "lamp"}};

bool is_block(const MaterialInfo& material) {
  return material.visibility != Visibility::empty && material.body == MaterialBody::solid;
}

}  // namespace

void Hotbar::fill(const MaterialTable& materials) {
  slots_.fill(kEmpty);
  set_us_.fill(std::nullopt);
  std::size_t filled = 0;
  const auto add = [&](Material material) {
    const auto is_there = std::find(slots_.begin(), slots_.end(), material) != slots_.end();
    if (filled < kSlotCount && !is_there) slots_[filled++] = material;
  };
  for (const auto& names : kFirst) {
    for (const std::string_view name : names) {
      const auto found = find_material(materials, name);
      if (!found || !is_block(materials[*found])) continue;
      add(*found);
      break;
    }
  }
  // Full blocks hide what is behind them, unlike plants and fences.
  for (const Visibility visibility : {Visibility::opaque, Visibility::transparent}) {
    for (std::size_t id = 1; id < materials.size() && filled < kSlotCount; ++id) {
      const auto material = static_cast<Material>(id);
      if (is_block(materials[material]) && materials[material].visibility == visibility)
        add(material);
    }
  }
  choose(0);
}

void Hotbar::take(const std::array<Material, kSlotCount>& slots, std::size_t slot,
                  const MaterialTable& materials) {
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i] != kEmpty && slots[i] < materials.size()) slots_[i] = slots[i];
  }
  choose(slot);
}

void Hotbar::choose(std::size_t slot) {
  if (slot >= kSlotCount) return;
  slot_ = slot;
  if (slots_[slot_] != kEmpty) player_.hold(slots_[slot_]);
}

void Hotbar::scroll(int steps) {
  const auto count = static_cast<int>(kSlotCount);
  const int slot = (static_cast<int>(slot_) - steps) % count;
  choose(static_cast<std::size_t>((slot + count) % count));
}

void Hotbar::hold(Material material, TimeUs now_us) {
  if (material == kEmpty) return;
  const auto found = std::find(slots_.begin(), slots_.end(), material);
  if (found != slots_.end()) {
    slot_ = static_cast<std::size_t>(found - slots_.begin());
  } else {
    slots_[slot_] = material;
    set_us_[slot_] = now_us;
  }
  player_.hold(material);
}

void Hotbar::pick(Material material, TimeUs now_us) {
  const bool has_it = std::find(slots_.begin(), slots_.end(), material) != slots_.end();
  if (material != kEmpty && !has_it) {
    std::size_t slot = slot_;
    for (std::size_t i = 0; i < kSlotCount && is_fresh(slot, now_us); ++i)
      slot = (slot + 1) % kSlotCount;
    slot_ = slot;
  }
  hold(material, now_us);
}

bool Hotbar::act(Action action) {
  if (action < Action::hold_slot_1 || action > Action::hold_slot_9) return false;
  choose(static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::hold_slot_1));
  return true;
}

}  // namespace runstone
