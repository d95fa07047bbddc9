#include "common/sculpt/ground_surface.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace runstone {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool has_word(std::string_view name, std::string_view word) {
  for (std::size_t at = name.find(word); at != std::string_view::npos;
       at = name.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_letter(name[at - 1])) && (end == name.size() || !is_letter(name[end])))
      return true;
  }
  return false;
}

bool is_of_tree(std::string_view name) {
  constexpr std::array<std::string_view, 7> kWords = {"log",    "wood",    "trunk", "tree",
                                                      "leaves", "needles", "bark"};
  // States of a block follow a bracket.
  const std::string_view plain = name.substr(0, name.find_first_of("[{~"));
  return std::any_of(kWords.begin(), kWords.end(),
                     [&](std::string_view word) { return has_word(plain, word); });
}

}  // namespace

GroundMaterials GroundMaterials::of(const MaterialTable& table) {
  GroundMaterials out;
  for (const MaterialInfo& info : table.rows()) {
    Part part = Part::other;
    if (info.body == MaterialBody::liquid) {
      part = Part::liquid;
    } else if (info.visibility == Visibility::opaque && info.body == MaterialBody::solid &&
               info.shape == Shape{} && !is_of_tree(info.name)) {
      part = Part::ground;
    }
    out.parts_.push_back(part);
  }
  return out;
}

std::vector<std::int32_t> surface_heights(const GroundColumns& columns,
                                          const GroundMaterials& materials) {
  std::vector<std::int32_t> out(columns.count(), kNoSurface);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto runs = columns.column(i);
    for (std::size_t r = runs.size(); r-- > 0;) {
      if (!materials.is_ground(runs[r].material)) continue;
      if (runs[r].end < columns.box().max.y) out[i] = runs[r].end - 1;
      break;
    }
  }
  return out;
}

}  // namespace runstone
