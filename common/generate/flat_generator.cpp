#include "common/generate/flat_generator.hpp"

namespace runstone {

Result<std::unique_ptr<Generator>> FlatGenerator::make(const FlatParameters& parameters,
                                                       const MaterialTable& materials) {
  std::unique_ptr<FlatGenerator> out(new FlatGenerator);
  out->y_min_ = parameters.y_min;
  out->y_max_ = parameters.height;
  const auto surface = materials.find(parameters.surface);
  const auto filling = materials.find(parameters.filling);
  const auto ground = materials.find(parameters.ground);
  if (!surface || !filling || !ground) {
    return fail(ErrorCode::not_found, "a flat parameter names no material of the table");
  }
  if (out->y_min_ < out->y_max_) {
    out->column_.reset(out->y_min_, out->y_max_);
    out->column_.paint(out->y_min_, out->y_max_, *ground);
    out->column_.paint(out->y_max_ - 1 - parameters.filling_depth, out->y_max_, *filling);
    out->column_.paint(out->y_max_ - 1, out->y_max_, *surface);
    // A layer of air on top is allowed. The bounds must not include it.
    out->y_max_ = out->column_.top();
  }
  return std::unique_ptr<Generator>(std::move(out));
}

std::unique_ptr<Generator> FlatGenerator::make_empty() {
  return std::unique_ptr<Generator>(new FlatGenerator);
}

RunChunk FlatGenerator::generate(VoxelPos origin, Extent extent) const {
  if (origin.y + extent.y <= y_min_ || origin.y >= y_max_) return uniform_chunk(extent, kEmpty);
  // With y as the slowest axis, a layer takes at most one append, and the chunk has the fewest
  // runs.
  RunBuilder out(extent, AxisOrder::xzy);
  const std::uint32_t layer = std::uint32_t{extent.x} * extent.z;
  for (std::int32_t y = 0; y < extent.y; ++y) out.append(layer, column_.at(origin.y + y));
  return out.finish();
}

std::optional<RunChunk> FlatGenerator::coarse(VoxelPos origin, std::int32_t edge,
                                              std::uint8_t level) const {
  const Extent extent = Extent::cube(static_cast<unsigned>(edge));
  if (origin.y + (edge << level) <= y_min_ || origin.y >= y_max_)
    return uniform_chunk(extent, kEmpty);
  RunBuilder out(extent, AxisOrder::yxz);
  for (std::int32_t i = 0; i < edge * edge; ++i)
    column_.emit_coarse(origin.y, extent.y, level, kEmpty, out);
  return out.finish();
}

}  // namespace runstone
