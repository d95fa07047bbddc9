#include "client/tools/cell_list.hpp"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "client/tools/aim.hpp"
#include "common/edits/clipboard/clipboard_builder.hpp"

namespace runstone {

ToolEdits paste_of(std::vector<Cell> cells, Mask mask) {
  if (cells.empty()) return failure("there is nothing to change here");
  // If several cells have one place, the first one counts. So their order in the list is a part of
  // the key.
  using Place = std::tuple<std::int32_t, std::int32_t, std::int32_t, std::size_t>;
  std::vector<std::pair<Place, Material>> placed;
  placed.reserve(cells.size());
  for (const Cell& c : cells)
    placed.emplace_back(Place(c.at.z, c.at.y, c.at.x, placed.size()), c.material);
  std::sort(placed.begin(), placed.end());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto& [z, y, x, order] = placed[i].first;
    cells[i] = {{x, y, z}, placed[i].second};
  }
  VoxelBox box = box_between(cells.front().at, cells.front().at);
  for (const Cell& cell : cells) {
    box.min = {std::min(box.min.x, cell.at.x), std::min(box.min.y, cell.at.y), box.min.z};
    box.max = {std::max(box.max.x, cell.at.x + 1), std::max(box.max.y, cell.at.y + 1),
               cell.at.z + 1};
  }
  const auto side = [](std::int32_t low, std::int32_t high) {
    return std::min<std::int32_t>(high - low, static_cast<std::int32_t>(kSideMax) + 1);
  };
  const std::int32_t x = side(box.min.x, box.max.x), y = side(box.min.y, box.max.y),
                     z = side(box.min.z, box.max.z);
  if (std::max({x, y, z}) > static_cast<std::int32_t>(kSideMax))
    return failure("the change is longer than 128 voxels");
  ClipboardBuilder out(
      {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(z)});
  for (const Cell& cell : cells) {
    const auto index = static_cast<std::uint32_t>(
        (cell.at.x - box.min.x) + x * ((cell.at.y - box.min.y) + y * (cell.at.z - box.min.z)));
    if (index < out.filled()) continue;  // the voxel was listed before
    out.append(index - out.filled(), std::nullopt);
    out.append(1, cell.material);
  }
  out.append(static_cast<std::uint32_t>(x * y * z) - out.filled(), std::nullopt);
  auto clipboard = out.finish();
  if (!clipboard) return failure("the change is too detailed for one edit");
  return std::vector{EditDescriptor{Paste{box.min, *std::move(clipboard), {}}, mask, kEmpty}};
}

}  // namespace runstone
