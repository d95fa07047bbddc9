#include "common/formats/build_section.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

// Above all cell numbers, which are at most kBuildMaterialsMax.
constexpr std::uint32_t kNoNumber = kBuildMaterialsMax + 1;

/// Returns the cell numbers that occur, ascending. Cost: O(runs log numbers).
std::vector<Material> numbers_of(const RunChunk& cells) {
  std::vector<Material> numbers;
  numbers.reserve(cells.runs.size());
  for (std::size_t i = 0; i < cells.runs.size(); ++i) numbers.push_back(cells.runs.material(i));
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

std::uint32_t sections_along(std::uint32_t side) {
  return (side + kBuildSectionEdge - 1) / kBuildSectionEdge;
}

std::uint8_t section_side(std::uint32_t side, std::uint32_t at) {
  return static_cast<std::uint8_t>(std::min(kBuildSectionEdge, side - at * kBuildSectionEdge));
}

}  // namespace

BuildSides section_counts(const BuildSides& sides) {
  return {sections_along(sides.x), sections_along(sides.y), sections_along(sides.z)};
}

std::uint64_t section_number(const BuildSides& sides, SectionCoord at) {
  const BuildSides counts = section_counts(sides);
  RUNSTONE_ASSERT(at.x < counts.x && at.y < counts.y && at.z < counts.z);
  return at.x + std::uint64_t{counts.x} * (at.y + std::uint64_t{counts.y} * at.z);
}

SectionCoord section_at(const BuildSides& sides, std::uint64_t number) {
  const BuildSides counts = section_counts(sides);
  RUNSTONE_ASSERT(number < counts.volume());
  return {static_cast<std::uint32_t>(number % counts.x),
          static_cast<std::uint32_t>(number / counts.x % counts.y),
          static_cast<std::uint32_t>(number / counts.x / counts.y)};
}

Extent section_extent(const BuildSides& sides, SectionCoord at) {
  return {section_side(sides.x, at.x), section_side(sides.y, at.y), section_side(sides.z, at.z)};
}

VoxelPos section_corner(SectionCoord at) {
  const auto first = [](std::uint32_t section) {
    return static_cast<std::int32_t>(section * kBuildSectionEdge);
  };
  return {first(at.x), first(at.y), first(at.z)};
}

std::uint64_t touched_cells(const RunChunk& cells) {
  std::uint64_t touched = 0;
  for (std::size_t i = 0; i < cells.runs.size(); ++i) {
    if (cells.runs.material(i) != 0) touched += cells.runs.end(i) - cells.runs.begin(i);
  }
  return touched;
}

Result<void> validate_section(const RunChunk& cells, Extent extent, std::uint32_t material_count) {
  if (cells.extent != extent) return fail(ErrorCode::bad_value, "section has another extent");
  if (auto runs = validate_runs(cells); !runs) return runs;
  for (std::size_t i = 0; i < cells.runs.size(); ++i) {
    if (cells.runs.material(i) > material_count)
      return fail(ErrorCode::bad_value, "cell of a section has no material", i);
  }
  if (cells.is_uniform() && cells.runs.material(0) == 0)
    return fail(ErrorCode::not_canonical, "section has no touched cell");
  return {};
}

void encode_section(const RunChunk& cells, Bytes& out) {
  const std::vector<Material> numbers = numbers_of(cells);
  ByteWriter w(out);
  w.u8(static_cast<std::uint8_t>(cells.order));
  w.varint(numbers.size() - 1);
  w.varint(numbers.front());
  for (std::size_t i = 1; i < numbers.size(); ++i) w.varint(numbers[i] - numbers[i - 1] - 1U);
  // Neighbouring runs differ, so the place of a number is encoded among those that the run before
  // does not have.
  std::uint64_t choices = numbers.size();
  std::uint64_t before = numbers.size();
  for (std::size_t i = 0; i < cells.runs.size(); ++i) {
    const auto place = static_cast<std::uint64_t>(
        std::lower_bound(numbers.begin(), numbers.end(), cells.runs.material(i)) - numbers.begin());
    const std::uint64_t more = cells.runs.end(i) - cells.runs.begin(i) - 1;
    w.varint(more * choices + (place > before ? place - 1 : place));
    choices = numbers.size() - 1;
    before = place;
  }
}

RunChunk decode_section(ByteReader& r, Extent extent, std::uint32_t material_count) {
  RunChunk cells{extent, AxisOrder::xyz, RunList(extent.volume())};
  const std::uint32_t volume = cells.volume();
  const std::uint8_t order = r.u8();
  if (order >= kAxisOrderCount) r.reject(ErrorCode::bad_value, "unknown axis order of a section");
  // Each number takes at least one byte, and at least one cell.
  const std::uint64_t count =
      1 + r.varint_max(std::min<std::uint64_t>(material_count, volume - 1),
                       "section has more numbers than the build has materials");
  if (r.ok() && count > r.left()) r.reject(ErrorCode::truncated, "numbers of a section are cut");
  if (!r.ok()) return cells;
  cells.order = static_cast<AxisOrder>(order);
  std::vector<Material> numbers;
  numbers.reserve(static_cast<std::size_t>(count));
  for (std::uint32_t least = 0; r.ok() && numbers.size() < count; least = numbers.back() + 1U) {
    if (least > material_count) {
      r.reject(ErrorCode::bad_value, "cell of a section has no material");
    } else {
      numbers.push_back(static_cast<Material>(
          least + r.varint_max(material_count - least, "cell of a section has no material")));
    }
  }
  if (r.ok() && numbers.size() == 1 && numbers.front() == 0)
    r.reject(ErrorCode::not_canonical, "section has no touched cell");
  if (!r.ok()) return cells;
  // Each run takes at least one byte.
  cells.runs.reserve(std::min<std::size_t>(volume, r.left()));
  std::vector<bool> used(numbers.size(), false);
  std::uint64_t choices = count;
  std::uint64_t before = kNoNumber;
  for (std::uint32_t filled = 0; filled < volume;) {
    if (choices == 0) {
      r.reject(ErrorCode::not_canonical, "section of one number has several runs");
      break;
    }
    const std::uint64_t code =
        r.varint_max((volume - filled) * choices - 1, "runs of a section end behind its volume");
    if (!r.ok()) break;
    const std::uint64_t more = code / choices;
    std::uint64_t place = code - more * choices;
    if (place >= before) ++place;
    used[static_cast<std::size_t>(place)] = true;
    filled += static_cast<std::uint32_t>(more) + 1;
    cells.runs.push_back({filled, numbers[static_cast<std::size_t>(place)]});
    before = place;
    choices = count - 1;
  }
  if (r.ok() && std::find(used.begin(), used.end(), false) != used.end())
    r.reject(ErrorCode::not_canonical, "section names a number that no cell has");
  cells.runs.shrink_to_fit();
  return cells;
}

}  // namespace runstone
