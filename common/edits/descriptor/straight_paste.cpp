#include "common/edits/descriptor/straight_paste.hpp"

#include <utility>

#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/edits/descriptor/placed_clipboard.hpp"

namespace runstone {

std::optional<Paste> straight_paste(const Paste& paste) {
  const auto placed = placed_cells(paste, box_of(paste), paste.clipboard->cells().order);
  if (!placed) return std::nullopt;
  ClipboardBuilder out(placed->cells.extent, placed->cells.order);
  placed->cells.runs.visit([&](const auto& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      std::optional<Material> material;
      if (runs.material(i) != 0) material = paste.clipboard->material(runs.material(i));
      out.append(runs.end(i) - out.filled(), material);
    }
  });
  auto made = out.finish();
  if (!made) return std::nullopt;
  return Paste{placed->box.min, *std::move(made), {}};
}

}  // namespace runstone
