#include "common/formats/rsb_build.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/formats/build_section.hpp"
#include "common/formats/rsb_reader.hpp"
#include "common/formats/rsb_writer.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

constexpr auto kFileEdge = static_cast<std::int32_t>(kBuildSectionEdge);

RunChunk with_numbers(const RunChunk& cells, const std::vector<std::uint16_t>& numbers) {
  RunBuilder out(cells.extent, cells.order);
  cells.runs.visit([&](const auto& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i)
      out.append_to(runs.end(i), numbers[runs.material(i)]);
  });
  return out.finish();
}

/// The materials of a file in their order, and the number there of each number of a build.
struct FilePalette {
  std::vector<BuildMaterial> materials;
  std::vector<std::uint16_t> numbers;
};

FilePalette file_palette(const Build& build, std::span<const BuildMaterial> materials,
                         bool skips_empty) {
  std::vector<std::size_t> order;
  FilePalette out;
  std::vector<BuildMaterial> named(materials.begin(), materials.end());
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (named[i].row.name.empty())
      named[i].row.name = "material " + std::to_string(build.palette()[i]);
    if (!skips_empty || build.palette()[i] != kEmpty) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(named[a].row.name, named[a].states) <
           std::tie(named[b].row.name, named[b].states);
  });
  out.numbers.assign(named.size() + 1, 0);
  for (const std::size_t i : order) {
    out.materials.push_back(std::move(named[i]));
    out.numbers[i + 1] = static_cast<std::uint16_t>(out.materials.size());
  }
  return out;
}

Unexpected<RsbError> section_failure(const Error& error) { return {{error, "sections", 0}}; }

}  // namespace

RsbResult<void> write_build(const Build& build, std::span<const BuildMaterial> materials,
                            BuildInfo info, bool skips_empty, const RsbSink& sink, int zstd_level) {
  RUNSTONE_ASSERT(materials.size() == build.palette().size());
  const FilePalette palette = file_palette(build, materials, skips_empty);
  const VoxelPos sides = build.sides();
  info.sides = {static_cast<std::uint32_t>(sides.x), static_cast<std::uint32_t>(sides.y),
                static_cast<std::uint32_t>(sides.z)};
  RsbWriter out(sink, zstd_level);
  if (const auto begun = out.begin(info, palette.materials); !begun) return begun;
  const BuildSides counts = section_counts(info.sides);
  for (SectionCoord at; at.z < counts.z; ++at.z) {
    for (at.y = 0; at.y < counts.y; ++at.y) {
      for (at.x = 0; at.x < counts.x; ++at.x) {
        const VoxelPos low = section_corner(at);
        const VoxelBox box = intersect(
            build.box(), {low, {low.x + kFileEdge, low.y + kFileEdge, low.z + kFileEdge}});
        const auto added = out.add({at, with_numbers(cells_in(build, box), palette.numbers)});
        if (!added) return added;
      }
    }
  }
  return out.finish();
}

RsbResult<FileBuild> read_build(RsbSource source, std::size_t bytes_max) {
  auto in = RsbReader::open(std::move(source));
  if (!in) return failure(in.error());
  const BuildSides sides = in->info().sides;
  const auto cuts = [](std::uint32_t side) {
    return grid_cuts(static_cast<std::int32_t>(side), kFileEdge);
  };
  auto out = BuildBuilder::of({cuts(sides.x), cuts(sides.y), cuts(sides.z)}, bytes_max);
  if (!out) return section_failure(out.error());
  // The material of an entry is its number in the file.
  for (std::size_t i = 1; i <= in->materials().size(); ++i)
    static_cast<void>(out->number_of(static_cast<Material>(i)));
  for (;;) {
    auto section = in->next();
    if (!section) return failure(section.error());
    if (!*section) break;
    const SectionCoord at = (*section)->at;
    const auto put = out->put({at.x, at.y, at.z}, std::move((*section)->cells));
    if (!put) return section_failure(put.error());
  }
  auto made = out->finish();
  if (!made) return section_failure(made.error());
  FileBuild result{in->info(), *std::move(made), {}};
  for (const Material number : result.build->palette())
    result.materials.push_back(in->materials()[number - 1U]);
  return result;
}

}  // namespace runstone
