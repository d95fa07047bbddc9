#include "common/builds/build_builder.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/build_info.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

/// The memory of a section besides its runs: the object, the counts of its pointer, and its entries in
/// the lists of the build.
constexpr std::size_t kSectionBytes = sizeof(RunChunk) + 48;

bool are_cuts(const BuildCuts& cuts) {
  return std::all_of(cuts.begin(), cuts.end(), [](const std::vector<std::int32_t>& along) {
    if (along.size() < 2 || along.front() != 0) return false;
    for (std::size_t i = 1; i < along.size(); ++i) {
      const std::int64_t side = std::int64_t{along[i]} - along[i - 1];
      if (side < 1 || side > static_cast<std::int64_t>(kSideMax)) return false;
    }
    return true;
  });
}

/// Returns a section with other cell numbers. Requires a number for each old one.
RunChunk renumbered(const RunChunk& cells, const std::vector<std::uint16_t>& numbers) {
  RunBuilder out(cells.extent, cells.order);
  cells.runs.visit([&](const auto& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i)
      out.append_to(runs.end(i), numbers[runs.material(i)]);
  });
  RunChunk made = out.finish();
  made.runs.shrink_to_fit();
  return made;
}

}  // namespace

BuildCuts world_cuts(const VoxelBox& box, std::int32_t edge) {
  const auto along = [&](std::int32_t min, std::int32_t max) {
    return grid_cuts(max - min, edge, min - floor_div(min, edge) * edge);
  };
  return {along(box.min.x, box.max.x), along(box.min.y, box.max.y), along(box.min.z, box.max.z)};
}

Result<BuildBuilder> BuildBuilder::of(BuildCuts cuts, std::size_t bytes_max) {
  RUNSTONE_ASSERT(are_cuts(cuts));
  BuildBuilder out(bytes_max);
  std::size_t bytes = sizeof(Build);
  std::size_t places = 1;
  for (const auto& along : cuts) {
    if (along.back() > kBuildSideMax)
      return fail(ErrorCode::limit_exceeded, "build is longer than 1,048,576 voxels");
    bytes += along.size() * sizeof(std::int32_t);
    const std::size_t count = along.size() - 1;
    if (places > bytes_max / sizeof(std::uint32_t) / count)
      return fail(ErrorCode::limit_exceeded, "build takes too much memory");
    places *= count;
  }
  bytes += places * sizeof(std::uint32_t);
  if (bytes > bytes_max) return fail(ErrorCode::limit_exceeded, "build takes too much memory");
  out.made_.cuts_ = std::move(cuts);
  out.made_.grid_.assign(places, UINT32_MAX);
  out.made_.memory_bytes_ = bytes;
  out.is_used_.push_back(true);
  return out;
}

std::optional<std::uint16_t> BuildBuilder::number_of(Material material) {
  if (numbers_.size() <= material) numbers_.resize(std::size_t{material} + 1);
  std::uint16_t& number = numbers_[material];
  if (number == 0) {
    if (made_.palette_.size() == kBuildPaletteMax) return std::nullopt;
    made_.palette_.push_back(material);
    made_.memory_bytes_ += sizeof(Material);
    is_used_.push_back(false);
    number = static_cast<std::uint16_t>(made_.palette_.size());
  }
  return number;
}

SectionPtr BuildBuilder::uniform(Extent extent, std::uint16_t number) {
  SectionPtr& shared = uniform_[{extent, number}];
  if (!shared) shared = std::make_shared<const RunChunk>(uniform_chunk(extent, number));
  return shared;
}

Result<std::uint32_t> BuildBuilder::add(SectionPtr cells) {
  const auto found = index_.find(cells.get());
  if (found != index_.end()) return found->second;
  const std::size_t bytes = kSectionBytes + cells->runs.byte_capacity();
  if (bytes > bytes_max_ || made_.memory_bytes_ > bytes_max_ - bytes)
    return fail(ErrorCode::limit_exceeded, "build takes too much memory");
  CellCount count;
  const std::uint16_t empty = numbers_.empty() ? std::uint16_t{0} : numbers_[kEmpty];
  cells->runs.visit([&](const auto& runs) {
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); begin = runs.end(i++)) {
      const std::uint16_t number = runs.material(i);
      RUNSTONE_ASSERT(number < is_used_.size());
      is_used_[number] = true;
      if (number == 0) continue;
      count.touched += runs.end(i) - begin;
      if (number != empty) count.solid += runs.end(i) - begin;
    }
  });
  made_.memory_bytes_ += bytes;
  const auto index = static_cast<std::uint32_t>(made_.sections_.size());
  index_.emplace(cells.get(), index);
  made_.sections_.push_back(std::move(cells));
  cells_.push_back(count);
  return index;
}

Result<void> BuildBuilder::put(SectionPos at, RunChunk cells) {
  if (cells.is_uniform()) return put(at, uniform(cells.extent, cells.runs.material(0)));
  cells.runs.shrink_to_fit();
  return put(at, std::make_shared<const RunChunk>(std::move(cells)));
}

Result<void> BuildBuilder::put(SectionPos at, SectionPtr cells) {
  const VoxelBox box = made_.box_of(at);
  const auto sides = cells->extent.sides();
  RUNSTONE_ASSERT(sides[0] == box.max.x - box.min.x && sides[1] == box.max.y - box.min.y &&
                  sides[2] == box.max.z - box.min.z);
  std::uint32_t& place = made_.grid_[made_.grid_index(at)];
  RUNSTONE_ASSERT(place == UINT32_MAX);
  const auto index = add(std::move(cells));
  if (!index) return failure(index.error());
  place = *index;
  made_.touched_ += cells_[*index].touched;
  made_.solid_ += cells_[*index].solid;
  return {};
}

Result<BuildPtr> BuildBuilder::finish() {
  if (made_.touched_ == 0) return fail(ErrorCode::bad_value, "build has no material");
  const SectionPos counts = made_.section_counts();
  for (SectionPos at; at.z < counts.z; ++at.z) {
    for (at.y = 0; at.y < counts.y; ++at.y) {
      for (at.x = 0; at.x < counts.x; ++at.x) {
        if (made_.grid_[made_.grid_index(at)] != UINT32_MAX) continue;
        const VoxelBox box = made_.box_of(at);
        const Extent extent{static_cast<std::uint8_t>(box.max.x - box.min.x),
                            static_cast<std::uint8_t>(box.max.y - box.min.y),
                            static_cast<std::uint8_t>(box.max.z - box.min.z)};
        if (const auto done = put(at, uniform(extent, 0)); !done) return failure(done.error());
      }
    }
  }
  if (std::find(is_used_.begin(), is_used_.end(), false) != is_used_.end()) {
    std::vector<std::uint16_t> numbers(is_used_.size(), 0);
    std::vector<Material> palette;
    for (std::size_t i = 1; i < is_used_.size(); ++i) {
      if (!is_used_[i]) continue;
      palette.push_back(made_.palette_[i - 1]);
      numbers[i] = static_cast<std::uint16_t>(palette.size());
    }
    for (SectionPtr& section : made_.sections_)
      section = std::make_shared<const RunChunk>(renumbered(*section, numbers));
    made_.memory_bytes_ -= (made_.palette_.size() - palette.size()) * sizeof(Material);
    made_.palette_ = std::move(palette);
  }
  auto out = std::shared_ptr<Build>(new Build(std::move(made_)));
  *this = BuildBuilder(bytes_max_);
  return BuildPtr(std::move(out));
}

}  // namespace runstone
