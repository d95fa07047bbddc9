#include "tests/support/formats/rsb_bytes.hpp"

#include <xxhash.h>

#include <algorithm>
#include <string>

#include "common/core/assert.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

std::uint64_t rsb_number(const Bytes& file, std::size_t at, std::size_t bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value |= std::uint64_t{file[at + i]} << (8 * i);
  return value;
}

void put_rsb_number(Bytes& file, std::size_t at, std::uint64_t value) {
  for (std::size_t i = 0; i < 8; ++i) file[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

/// Returns cells with numbers 0 .. material_count in any shape. random_chunk() makes chunks only, so
/// small sections are stretches at random.
RunChunk random_cells(SplitMix64& rng, Extent extent, std::uint32_t material_count) {
  const unsigned numbers = std::min(material_count + 1, 40U);
  if (extent.valid()) {
    const RunChunk shape = random_chunk(rng, extent, random_order(rng), numbers);
    RunBuilder cells(extent, shape.order);
    for (std::size_t i = 0; i < shape.runs.size(); ++i) {
      const std::uint32_t number = shape.runs.material(i) % (material_count + 1);
      cells.append_to(shape.runs.end(i), static_cast<Material>(number));
    }
    return cells.finish();
  }
  RunBuilder cells(extent, random_order(rng));
  while (cells.filled() < extent.volume()) {
    const std::uint32_t count = 1 + rng.below(std::min(extent.volume() - cells.filled(), 50U));
    cells.append(count, static_cast<Material>(rng.below(numbers)));
  }
  return cells.finish();
}

}  // namespace

BuildInfo sample_build_info(BuildSides sides) {
  BuildInfo info;
  info.name = "M\xc3\xbchle am Bach";
  info.author = "zo\xc3\xab";
  info.tags = {"mill", "wood"};
  info.created_us = 1'700'000'000'000'000;
  info.sides = sides;
  info.origin = {-5, 64, 300};
  return info;
}

std::vector<BuildMaterial> sample_build_materials(std::size_t count) {
  std::vector<BuildMaterial> materials(count);
  for (std::size_t i = 0; i < count; ++i) {
    // Five digits, so that names ascend. Two materials share a name and differ in their states.
    std::string digits = std::to_string(i / 2);
    digits.insert(0, 5 - digits.size(), '0');
    BuildMaterial& material = materials[i];
    material.row.name = "m" + digits;
    material.row.colour = {static_cast<std::uint8_t>(i), 2, 3, 255};
    if (i % 2 == 1) material.states = "facing=north";
    if (i % 3 == 1) {
      material.row.visibility = Visibility::transparent;
      material.row.body = MaterialBody::liquid;
      material.row.colour[3] = 90;
    }
    if (i % 3 == 2) material.row.look = MaterialLook{1, 2, 3, 4, MaterialPattern::bricks};
  }
  return materials;
}

SampleBuild random_build(SplitMix64& rng) {
  SampleBuild build;
  const auto side = [&] { return rng.below(3) == 0 ? 1 + rng.below(200) : 1 + rng.below(20); };
  build.info = sample_build_info({side(), side(), side()});
  build.info.tags.resize(rng.below(3));
  const std::uint32_t material_count = 1 + rng.below(rng.below(4) == 0 ? 600 : 5);
  build.materials = sample_build_materials(material_count);
  const std::uint64_t sections = section_counts(build.info.sides).volume();
  for (std::uint64_t number = 0; number < sections; ++number) {
    if (sections > 1 && rng.below(3) == 0) continue;
    const SectionCoord at = section_at(build.info.sides, number);
    RunChunk cells = random_cells(rng, section_extent(build.info.sides, at), material_count);
    if (is_empty(cells)) cells = uniform_chunk(cells.extent, 1);
    build.sections.push_back({at, std::move(cells)});
  }
  if (build.sections.empty())
    build.sections.push_back({{}, uniform_chunk(section_extent(build.info.sides, {}), 1)});
  return build;
}

Bytes rsb_of(const SampleBuild& build, int zstd_level) {
  Bytes file;
  RsbWriter writer(
      [&](ByteView bytes) {
        file.insert(file.end(), bytes.begin(), bytes.end());
        return true;
      },
      zstd_level);
  RUNSTONE_ASSERT(writer.begin(build.info, build.materials).has_value());
  for (const BuildSection& section : build.sections)
    RUNSTONE_ASSERT(writer.add(section).has_value());
  RUNSTONE_ASSERT(writer.finish().has_value());
  RUNSTONE_ASSERT(writer.bytes() == file.size());
  return file;
}

RsbContents read_rsb(ByteView file) {
  RsbContents contents;
  auto reader = RsbReader::open(rsb_source(file));
  if (!reader) {
    contents.error = reader.error();
    return contents;
  }
  contents.build.info = reader->info();
  contents.build.materials = reader->materials();
  while (true) {
    auto section = reader->next();
    if (!section) {
      contents.error = section.error();
      return contents;
    }
    if (!section->has_value()) return contents;
    (*section)->cells = reorder((*section)->cells, AxisOrder::xyz);
    contents.build.sections.push_back(**std::move(section));
  }
}

std::vector<std::size_t> rsb_blocks_of(const Bytes& file) {
  std::vector<std::size_t> begins;
  std::size_t at = kRsbFileHeadBytes;
  while (at + kRsbHeaderBytes <= file.size()) {
    begins.push_back(at);
    at += kRsbHeaderBytes + static_cast<std::size_t>(rsb_number(file, at + 4, 4));
  }
  begins.push_back(file.size());
  return begins;
}

void mend_rsb(Bytes& file) {
  std::uint64_t before = 0;
  std::size_t at = kRsbFileHeadBytes;
  while (at + kRsbHeaderBytes <= file.size()) {
    const auto stored = static_cast<std::size_t>(rsb_number(file, at + 4, 4));
    const std::size_t payload = at + kRsbHeaderBytes;
    put_rsb_number(file, at + 24, at);
    if (stored <= file.size() - payload)
      put_rsb_number(file, at + 32, XXH3_64bits(file.data() + payload, stored));
    before = XXH3_64bits_withSeed(file.data() + at, kRsbHeaderBytes - 8, before);
    put_rsb_number(file, at + 40, before);
    if (stored > file.size() - payload) return;
    at = payload + stored;
  }
}

}  // namespace runstone::test
