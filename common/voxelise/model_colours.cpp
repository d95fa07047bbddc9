#include "common/voxelise/model_colours.hpp"

#include <algorithm>
#include <cmath>

namespace runstone {
namespace {

constexpr std::uint8_t kSurfaceAlphaMin = 128;

VoxelRgb rgb_of(const ModelColour& colour) { return {colour[0], colour[1], colour[2]}; }

VoxelRgb product(const VoxelRgb& a, const std::array<double, 3>& b) {
  VoxelRgb out{};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = static_cast<std::uint8_t>(std::clamp(a[i] * b[i] / 255 + 0.5, 0.0, 255.0));
  return out;
}

/// Returns the texel that a coordinate of a texture is in. The texture repeats.
std::uint32_t texel_at(double place, std::uint32_t count) {
  const double share = place - std::floor(place);
  return std::min(static_cast<std::uint32_t>(share * count), count - 1);
}

using Vec = std::array<double, 3>;
Vec difference(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

ModelColours::ModelColours(const Model& model, const ModelPlacement& placement)
    : model_(&model), placement_(&placement) {
  if (!model.colours.empty()) return;
  std::optional<VoxelRgb> one;
  for (std::uint32_t triangle = 0; triangle < model.triangles.size(); ++triangle) {
    const ModelMaterial* material = material_of(triangle);
    if (material == nullptr) break;
    if (material->texture) return;
    const VoxelRgb colour = rgb_of(material->colour);
    if (one && *one != colour) return;
    one = colour;
  }
  only_ = one.value_or(VoxelRgb{255, 255, 255});
}

VoxelRgb ModelColours::fallback() const {
  const ModelMaterial* material = model_->is_cloud() ? nullptr : material_of(0);
  return material == nullptr ? VoxelRgb{255, 255, 255} : rgb_of(material->colour);
}

ModelColours::Nearest ModelColours::nearest(std::uint32_t triangle, VoxelPos voxel) const {
  const UnitTriangle t = placement_->triangle(*model_, triangle);
  const auto vec = [](const UnitPoint& p) {
    return Vec{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  };
  const auto centre = [](std::int32_t v) { return v * kVoxelUnit + kVoxelUnit / 2.0; };
  const Vec p{centre(voxel.x), centre(voxel.y), centre(voxel.z)};
  const Vec a = vec(t[0]), b = vec(t[1]), c = vec(t[2]);
  const Vec ab = difference(b, a), ac = difference(c, a), ap = difference(p, a);
  const auto at = [&](const Vec& shares) {
    Vec point{};
    for (std::size_t i = 0; i < 3; ++i)
      point[i] = shares[0] * a[i] + shares[1] * b[i] + shares[2] * c[i];
    const Vec d = difference(p, point);
    return Nearest{shares, dot(d, d)};
  };
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return at({1, 0, 0});
  const Vec bp = difference(p, b);
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return at({0, 1, 0});
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 - d3 > 0) {
    const double v = d1 / (d1 - d3);
    return at({1 - v, v, 0});
  }
  const Vec cp = difference(p, c);
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return at({0, 0, 1});
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 - d6 > 0) {
    const double w = d2 / (d2 - d6);
    return at({1 - w, 0, w});
  }
  const double va = d3 * d6 - d5 * d4;
  const double to_c = d4 - d3, to_b = d5 - d6;
  if (va <= 0 && to_c >= 0 && to_b >= 0 && to_c + to_b > 0) {
    const double w = to_c / (to_c + to_b);
    return at({0, 1 - w, w});
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return at({1, 0, 0});
  return at({1 - vb / sum - vc / sum, vb / sum, vc / sum});
}

std::optional<VoxelRgb> ModelColours::at(std::uint32_t triangle, const Nearest& nearest) const {
  const ModelMaterial* material = material_of(triangle);
  VoxelRgb out{255, 255, 255};
  if (material != nullptr) out = rgb_of(material->colour);
  const auto& corners = model_->triangles[triangle];
  if (material != nullptr && material->texture && !model_->texture_places.empty()) {
    const ModelTexture& texture = model_->textures[*material->texture];
    std::array<double, 2> place{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t i = 0; i < 2; ++i)
        place[i] += nearest.shares[corner] * double{model_->texture_places[corners[corner]][i]};
    }
    const std::size_t texel = std::size_t{texel_at(place[1], texture.height)} * texture.width +
                              texel_at(place[0], texture.width);
    const std::uint8_t* bytes = texture.texels.data() + texel * 4;
    if (bytes[3] < kSurfaceAlphaMin) return std::nullopt;
    out = product(out, {double{1} * bytes[0], double{1} * bytes[1], double{1} * bytes[2]});
  }
  if (!model_->colours.empty()) {
    std::array<double, 3> between{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t i = 0; i < 3; ++i)
        between[i] += nearest.shares[corner] * model_->colours[corners[corner]][i];
    }
    out = product(out, between);
  }
  return out;
}

bool ModelColours::is_plain(std::uint32_t triangle) const {
  const ModelMaterial* material = material_of(triangle);
  return model_->colours.empty() && (material == nullptr || !material->texture);
}

VoxelRgb ModelColours::of_point(std::uint32_t point) const {
  return model_->colours.empty() ? VoxelRgb{255, 255, 255} : rgb_of(model_->colours[point]);
}

}  // namespace runstone
