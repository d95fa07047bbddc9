#include "server/interest/view_order.hpp"

#include <cmath>
#include <numbers>

#include "server/interest/view_cells.hpp"

namespace runstone {

ViewOrder::ViewOrder(const View& view) : view_(view) {
  constexpr double kTurn = 65'536;
  const auto angle = [](double units) { return units / kTurn * 2 * std::numbers::pi; };
  const double level = std::cos(angle(view.pitch));
  x_ = std::sin(angle(view.yaw)) * level;
  y_ = std::sin(angle(view.pitch));
  z_ = std::cos(angle(view.yaw)) * level;
  cosine_ = std::cos(angle(view.cone));
}

ViewOrder::Ring ViewOrder::ring(ChunkCoord at, std::int64_t distance2) const {
  if (view_.cone == 0 || distance2 <= kNear2) return Ring::near;
  const auto off = [](std::int32_t to, std::int32_t from) {
    return static_cast<double>(std::int64_t{to} - from);
  };
  const double along = off(at.x, view_.centre.x) * x_ + off(at.y, view_.centre.y) * y_ +
                       off(at.z, view_.centre.z) * z_;
  return along >= cosine_ * std::sqrt(static_cast<double>(distance2)) ? Ring::seen : Ring::rest;
}

bool ViewOrder::operator()(const ChunkKey& a, const ChunkKey& b) const {
  const std::int64_t da = distance2(view_, a.at);
  const std::int64_t db = distance2(view_, b.at);
  const Ring ra = ring(a.at, da);
  const Ring rb = ring(b.at, db);
  if (ra != rb) return ra < rb;
  return da != db ? da < db : a < b;
}

}  // namespace runstone
