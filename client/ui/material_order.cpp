#include "client/ui/material_order.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "common/materials/readable_name.hpp"

namespace runstone {
namespace {

/// A colour whose channels differ by less than this part of the greatest one is a grey.
constexpr int kGreyPart = 8;
constexpr int kHueSteps = 24;

/// Returns 0 for a grey, and otherwise the step of the hue, from 1.
int hue_step(const MaterialColour& colour) {
  const int r = colour[0], g = colour[1], b = colour[2];
  const int high = std::max({r, g, b}), span = high - std::min({r, g, b});
  if (span * kGreyPart <= high) return 0;
  // The hue in sixths of the circle, times `span`.
  int sixths = high == r ? g - b : high == g ? 2 * span + b - r : 4 * span + r - g;
  if (sixths < 0) sixths += 6 * span;
  return 1 + sixths * (kHueSteps / 6) / span % kHueSteps;
}

/// Returns the luma of a colour (ITU-R BT.601), 0 to 255,000.
int brightness(const MaterialColour& colour) {
  return 299 * colour[0] + 587 * colour[1] + 114 * colour[2];
}

template <class Key>
void sort_by(std::vector<Material>& materials, const Key& key_of) {
  std::vector<std::pair<decltype(key_of(Material{})), Material>> keyed;
  keyed.reserve(materials.size());
  for (const Material material : materials) keyed.emplace_back(key_of(material), material);
  std::sort(keyed.begin(), keyed.end());
  std::transform(keyed.begin(), keyed.end(), materials.begin(),
                 [](const auto& entry) { return entry.second; });
}

}  // namespace

void sort_materials(std::vector<Material>& materials, const MaterialTable& table,
                    MaterialOrder order) {
  if (order == MaterialOrder::name)
    sort_by(materials, [&](Material id) { return readable_name(table[id].name); });
  if (order == MaterialOrder::colour)
    sort_by(materials, [&](Material id) {
      const MaterialColour& colour = table[id].colour;
      return std::array<int, 2>{hue_step(colour), brightness(colour)};
    });
}

}  // namespace runstone
