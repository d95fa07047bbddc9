#include "common/patterns/bound_filter.hpp"

#include <algorithm>
#include <utility>

#include "common/materials/material_lookup.hpp"

namespace runstone {
namespace {

/// The keys of filters differ from those of mixes with the same seed.
constexpr std::uint64_t kFilterKeys = std::uint64_t{1} << 32;

}  // namespace

Result<BoundFilter, PatternError> BoundFilter::of(const VoxelFilter& filter,
                                                  const MaterialTable& table, std::uint64_t seed) {
  BoundFilter out;
  std::uint64_t count = 0;
  if (auto error = out.bind(filter, table, seed, count)) return failure(*std::move(error));
  return out;
}

std::optional<PatternError> BoundFilter::bind(const VoxelFilter& filter, const MaterialTable& table,
                                              std::uint64_t seed, std::uint64_t& count) {
  kind_ = filter.kind;
  number_ = filter.number;
  const std::uint64_t key = mix64(seed + mix64(kFilterKeys + count++));
  if (kind_ == FilterKind::noise) clumps_ = ClumpNoise(key, filter.size);
  if (!filter.materials.empty()) is_match_.resize(table.size());
  if (kind_ == FilterKind::exposed) is_match_ = {true};  // air
  for (const NamedMaterial& named : filter.materials) {
    auto family = table.family(named.name);
    if (family.empty()) {
      const auto found = find_material(table, named.name);
      if (!found) return PatternError{named.column, found.error()};
      family = table.family(table[*found].name);
    }
    for (const Material member : family) is_match_[member] = true;
  }
  for (const VoxelFilter& part : filter.parts) {
    if (auto error = parts_.emplace_back().bind(part, table, seed, count)) return error;
  }
  // The order of the parts of `all` and `any` changes no answer. Those that work on runs come
  // first, so that `noise` takes fewer voxels.
  std::partition(parts_.begin(), parts_.end(),
                 [](const BoundFilter& part) { return part.kind_ != FilterKind::noise; });
  return std::nullopt;
}

bool BoundFilter::reads_neighbours() const {
  switch (kind_) {
    case FilterKind::on:
    case FilterKind::under:
    case FilterKind::beside:
    case FilterKind::exposed:
      return true;
    default:
      return std::any_of(parts_.begin(), parts_.end(),
                         [](const BoundFilter& part) { return part.reads_neighbours(); });
  }
}

std::uint64_t BoundFilter::conditions() const {
  std::uint64_t out = 1;
  for (const BoundFilter& part : parts_) out += part.conditions();
  return out;
}

std::uint64_t BoundFilter::noise_voxels() const {
  std::uint64_t out = noise_voxels_;
  for (const BoundFilter& part : parts_) out += part.noise_voxels();
  return out;
}

HeightRanges BoundFilter::passing(const GroundColumns& columns, std::int32_t x, std::int32_t z,
                                  HeightRange range) {
  return within({columns, x, z}, {range});
}

HeightRanges BoundFilter::within(const Column& column, const HeightRanges& domain) {
  if (domain.empty()) return {};
  switch (kind_) {
    case FilterKind::is:
      return common_of(domain, matching(column, 0, 0, 0));
    case FilterKind::on:
      return common_of(domain, matching(column, 0, -1, 0));
    case FilterKind::under:
      return common_of(domain, matching(column, 0, 1, 0));
    case FilterKind::beside:
      return common_of(domain, beside(column));
    case FilterKind::exposed:
      return common_of(domain,
                       union_of(union_of(matching(column, 0, -1, 0), matching(column, 0, 1, 0)),
                                beside(column)));
    case FilterKind::solid:
      return common_of(domain, matching(column, 0, 0, 0));
    case FilterKind::above:
      return common_of(domain, {{number_ + 1, INT32_MAX}});
    case FilterKind::below:
      return common_of(domain, {{INT32_MIN, number_}});
    case FilterKind::noise:
      return in_noise(column, domain);
    case FilterKind::all: {
      HeightRanges out = domain;
      for (BoundFilter& part : parts_) out = part.within(column, out);
      return out;
    }
    case FilterKind::any: {
      HeightRanges out, rest = domain;
      for (BoundFilter& part : parts_) {
        const HeightRanges more = part.within(column, rest);
        out = union_of(out, more);
        rest = without(rest, more);
      }
      return out;
    }
    case FilterKind::negation:
      break;
  }
  return without(domain, parts_.front().within(column, domain));
}

HeightRanges BoundFilter::matching(const Column& column, std::int32_t dx, std::int32_t rise,
                                   std::int32_t dz) const {
  const VoxelBox& box = column.columns.box();
  const std::int32_t x = column.x + dx, z = column.z + dz;
  HeightRanges out;
  if (x < box.min.x || x >= box.max.x || z < box.min.z || z >= box.max.z) return out;
  std::int32_t low = box.min.y;
  for (const ColumnRun& run : column.columns.column(column.columns.index(x, z))) {
    const bool is_wanted =
        kind_ == FilterKind::solid ? run.material != kEmpty : matches(run.material);
    if (is_wanted) append_range(out, low - rise, run.end - rise);
    low = run.end;
  }
  return out;
}

HeightRanges BoundFilter::beside(const Column& column) const {
  return union_of(union_of(matching(column, -1, 0, 0), matching(column, 1, 0, 0)),
                  union_of(matching(column, 0, 0, -1), matching(column, 0, 0, 1)));
}

HeightRanges BoundFilter::in_noise(const Column& column, const HeightRanges& domain) {
  HeightRanges out;
  for (const HeightRange& range : domain) {
    noise_voxels_ += static_cast<std::uint64_t>(range.high - range.low);
    for (std::int32_t y = range.low; y < range.high; ++y) {
      const std::uint64_t number = clumps_.at({column.x, y, column.z});
      if ((number * 100) >> 32 < static_cast<std::uint64_t>(number_)) append_range(out, y, y + 1);
    }
  }
  return out;
}

}  // namespace runstone
