// PaletteWindow: a list of all materials of the world, with a field that searches their names. One
// thread.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

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
  /// Makes the window with ImGui. Returns the material that the user chose, and closes the window:
  /// a click chooses a material, and enter chooses the first one.
  std::optional<Material> build(const MaterialTable& table, Material held, double scale);

 private:
  void update_matches(const MaterialTable& table);
  std::optional<Material> build_grid(const MaterialTable& table, Material held, double scale);

  bool is_open_ = false, takes_focus_ = false;
  std::string search_;
  std::optional<std::string> matched_;  // the text that matches_ belongs to
  std::size_t matched_count_ = 0;       // materials of the table then
  std::vector<Material> matches_;
};

}  // namespace runstone
