#include "client/replica/surface.hpp"

namespace runstone {

std::optional<std::int32_t> surface_of(const Replica& replica, std::int32_t x, std::int32_t z) {
  const auto& view = replica.view();
  if (!replica.opened() || !view) return std::nullopt;
  const std::int32_t edge = replica.chunk_edge();
  const std::int32_t top = (view->centre.y + view->radius_v + 1) * edge - 1;
  const std::int32_t bottom = (view->centre.y - view->radius_v) * edge;
  for (std::int32_t y = top; y >= bottom; --y) {
    const auto material = replica.shown_at({x, y, z});
    if (material && *material != kEmpty) return y;
  }
  return std::nullopt;
}

}  // namespace runstone
