// PaletteWindow: a list of all materials of the world, with a field that searches their names, the
// materials that were used last, and the hotbars that the player has kept. One thread.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "client/ui/hud_state.hpp"
#include "client/ui/material_order.hpp"
#include "client/ui/ui_action.hpp"
#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the materials that can be placed and match the text, as follows:
///   - A material matches if each word of the text is in its readable name or in its name of the
///     table, as a part or as a whole. Upper and lower case are equal.
///   - Materials whose readable name begins with the text come first. Then come those of which
///     another word begins with it, and then the others. Each group has the order of the table.
/// Cost: O(bytes of all names).
std::vector<Material> matching_materials(const MaterialTable& table, const std::string& text);

class PaletteWindow {
 public:
  void open();
  void close() { is_open_ = false; }
  bool is_open() const { return is_open_; }
  /// Returns true from open() until the field has the keyboard.
  bool takes_focus() const { return is_open_ && takes_focus_; }
  /// Makes the window with ImGui, and appends what the user did to `out`:
  ///   - HoldMaterial for a click on a material, and for enter, which takes the first one;
  ///   - HotbarOrder for a hotbar.
  /// The window closes when the user has taken a material or a hotbar.
  void build(const HudState& state, double scale, std::vector<UiAction>& out);

 private:
  void update_matches(const MaterialTable& table);
  void build_orders();
  static std::optional<Material> build_recent(const HudState& state, double scale);
  std::optional<HotbarOrder> build_hotbars(const std::vector<std::string>& names);
  std::optional<Material> build_grid(const MaterialTable& table, Material held, double scale);

  bool is_open_ = false, takes_focus_ = false;
  std::string search_;
  MaterialOrder order_ = MaterialOrder::table;
  std::string hotbar_;  // the text of the field for the name of a hotbar
  /// The search, the number of materials and the order for which matches_ was made.
  struct Matched {
    std::string search;
    std::size_t count = 0;
    MaterialOrder order = MaterialOrder::table;
    friend bool operator==(const Matched&, const Matched&) = default;
  };
  std::optional<Matched> matched_;
  std::vector<Material> matches_;
};

}  // namespace runstone
