// NamedHotbars: hotbars that the player has kept under names. They hold the names of materials, so
// that they serve in every world. One thread.
#pragma once
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "client/input/action.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// The names of the materials of hotbars, by slot, by the name of the hotbar. An empty name, or one
/// that is missing at the end, is an empty slot.
using HotbarLists = std::map<std::string, std::vector<std::string>>;

class NamedHotbars {
 public:
  using Slots = std::array<Material, kSlotCount>;
  static constexpr std::size_t kCountMax = 32, kNameBytesMax = 32;

  explicit NamedHotbars(HotbarLists lists = {}) : lists_(std::move(lists)) {}

  /// Keeps these slots under a name, in place of those that had it. Fails with words for the player
  /// if the name is not 1 to kNameBytesMax bytes of text, or if kCountMax others are kept.
  Result<void, std::string> keep(const std::string& name, const Slots& slots,
                                 const MaterialTable& materials);
  /// Returns the slots of that name. Materials that the world lacks are kEmpty. Fails with words for
  /// the player if there is no such hotbar.
  Result<Slots, std::string> take(const std::string& name, const MaterialTable& materials) const;
  /// Fails with words for the player if there is no such hotbar.
  Result<void, std::string> forget(const std::string& name);

  const HotbarLists& lists() const { return lists_; }
  /// Returns true if a hotbar was kept or forgotten since the last call.
  bool take_changed() { return std::exchange(is_changed_, false); }

 private:
  HotbarLists lists_;
  bool is_changed_ = false;
};

}  // namespace runstone
