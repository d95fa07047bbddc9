#include "common/model_reader/finite_model.hpp"

#include <cmath>
#include <cstddef>
#include <string>

namespace runstone {
namespace {

bool is_finite(const std::array<float, 3>& at) {
  return std::isfinite(at[0]) && std::isfinite(at[1]) && std::isfinite(at[2]);
}

/// Returns the number of the points that it left out.
std::size_t leave_out_points(Model& model) {
  std::size_t kept = 0;
  for (std::size_t v = 0; v < model.positions.size(); ++v) {
    if (!is_finite(model.positions[v])) continue;
    model.positions[kept] = model.positions[v];
    if (!model.colours.empty()) model.colours[kept] = model.colours[v];
    if (!model.texture_places.empty()) model.texture_places[kept] = model.texture_places[v];
    ++kept;
  }
  const std::size_t lost = model.positions.size() - kept;
  model.positions.resize(kept);
  if (!model.colours.empty()) model.colours.resize(kept);
  if (!model.texture_places.empty()) model.texture_places.resize(kept);
  return lost;
}

/// Returns the number of the triangles that it left out.
std::size_t leave_out_triangles(Model& model) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    const auto& [a, b, c] = model.triangles[i];
    if (!is_finite(model.positions[a]) || !is_finite(model.positions[b]) ||
        !is_finite(model.positions[c]))
      continue;
    model.triangles[kept] = model.triangles[i];
    if (!model.material_of.empty()) model.material_of[kept] = model.material_of[i];
    ++kept;
  }
  const std::size_t lost = model.triangles.size() - kept;
  model.triangles.resize(kept);
  if (!model.material_of.empty()) model.material_of.resize(kept);
  if (kept == 0) return lost;
  const auto in_use = model.positions[model.triangles.front()[0]];
  for (auto& at : model.positions) {
    if (!is_finite(at)) at = in_use;
  }
  return lost;
}

}  // namespace

bool leave_out_not_finite(Model& model, ReaderNotices& notices) {
  for (auto& place : model.texture_places) {
    if (!std::isfinite(place[0]) || !std::isfinite(place[1])) place = {0, 0};
  }
  if (model.is_cloud()) {
    if (const std::size_t lost = leave_out_points(model); lost > 0) {
      notices.add("points whose places are no finite numbers are left out: " +
                  std::to_string(lost));
    }
    return !model.positions.empty();
  }
  if (const std::size_t lost = leave_out_triangles(model); lost > 0) {
    notices.add("triangles with corners that are no finite numbers are left out: " +
                std::to_string(lost));
  }
  return !model.triangles.empty();
}

}  // namespace runstone
