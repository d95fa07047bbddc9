#include "common/patterns/column_patterns.hpp"

#include "common/sculpt/column_writer.hpp"

namespace runstone {
namespace {

std::int32_t x_of(const GroundColumns& columns, std::size_t column) {
  return columns.box().min.x +
         static_cast<std::int32_t>(column % static_cast<std::size_t>(columns.width()));
}

std::int32_t z_of(const GroundColumns& columns, std::size_t column) {
  return columns.box().min.z +
         static_cast<std::int32_t>(column / static_cast<std::size_t>(columns.width()));
}

}  // namespace

ColumnChanges filtered(const GroundColumns& columns, const ColumnChanges& changes,
                       BoundFilter& filter) {
  ColumnChanges out;
  for (const ColumnChange& change : changes) {
    const auto ranges = filter.passing(columns, x_of(columns, change.column),
                                       z_of(columns, change.column), {change.low, change.high});
    for (const HeightRange& range : ranges)
      out.push_back({change.column, range.low, range.high, change.material});
  }
  return out;
}

ColumnChanges mixed(const GroundColumns& columns, const ColumnChanges& changes, BoundMix& mix) {
  ColumnChanges out;
  for (const ColumnChange& change : changes) {
    if (change.material != kMixedMaterial) {
      out.push_back(change);
      continue;
    }
    ColumnWriter writer(columns, change.column, out);
    const std::int32_t x = x_of(columns, change.column), z = z_of(columns, change.column);
    for (std::int32_t y = change.low; y < change.high; ++y) writer.set(y, mix.at({x, y, z}));
  }
  return out;
}

}  // namespace runstone
