#include "tests/support/formats/file_builds.hpp"

#include <algorithm>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/core/assert.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone::test {

FileBuild file_build(VoxelPos sides, const std::vector<BuildMaterial>& materials,
                     const std::function<std::uint16_t(VoxelPos)>& number) {
  auto builder =
      BuildBuilder::of({grid_cuts(sides.x, 50), grid_cuts(sides.y, 50), grid_cuts(sides.z, 50)});
  RUNSTONE_ASSERT(builder.has_value());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const bool is_empty = materials[i].row.visibility == Visibility::empty;
    static_cast<void>(builder->number_of(is_empty ? kEmpty : static_cast<Material>(i + 1)));
  }
  const auto& cuts = builder->cuts();
  for (std::uint32_t z = 0; z + 1 < cuts[2].size(); ++z) {
    for (std::uint32_t y = 0; y + 1 < cuts[1].size(); ++y) {
      for (std::uint32_t x = 0; x + 1 < cuts[0].size(); ++x) {
        const Extent extent{static_cast<std::uint8_t>(cuts[0][x + 1] - cuts[0][x]),
                            static_cast<std::uint8_t>(cuts[1][y + 1] - cuts[1][y]),
                            static_cast<std::uint8_t>(cuts[2][z + 1] - cuts[2][z])};
        RunBuilder runs(extent, AxisOrder::yzx);
        for (std::uint32_t i = 0; i < extent.volume(); ++i) {
          const LocalPos at = pos_of(i, extent, AxisOrder::yzx);
          runs.append(1, number({cuts[0][x] + at.x, cuts[1][y] + at.y, cuts[2][z] + at.z}));
        }
        RUNSTONE_ASSERT(builder->put({x, y, z}, runs.finish()).has_value());
      }
    }
  }
  auto made = builder->finish();
  RUNSTONE_ASSERT(made.has_value());
  FileBuild out{{}, *std::move(made), {}};
  out.info.name = "test";
  out.info.sides = {static_cast<std::uint32_t>(sides.x), static_cast<std::uint32_t>(sides.y),
                    static_cast<std::uint32_t>(sides.z)};
  const auto air = std::find_if(materials.begin(), materials.end(), [](const BuildMaterial& m) {
    return m.row.visibility == Visibility::empty;
  });
  for (const Material id : out.build->palette())
    out.materials.push_back(id == kEmpty ? *air : materials[id - 1U]);
  return out;
}

BuildMaterial file_material(std::string name, std::string states, MaterialColour colour) {
  BuildMaterial out;
  out.row.name = std::move(name);
  out.row.colour = colour;
  out.states = std::move(states);
  if (colour[3] != 255) out.row.visibility = Visibility::transparent;
  if (out.row.name == "air") out.row.visibility = Visibility::empty;
  return out;
}

FileBuild random_file_build(SplitMix64& rng, VoxelPos sides, std::uint16_t count, bool has_air) {
  std::vector<BuildMaterial> materials;
  if (has_air) materials.push_back(file_material("air", "", {0, 0, 0, 0}));
  for (unsigned i = 0; i < count; ++i) {
    const auto byte = [&] { return static_cast<std::uint8_t>(rng.below(256)); };
    // Names in ascending order, some with states.
    const std::string name = "m" + std::to_string(1000 + i / 2);
    materials.push_back(
        file_material(name, i % 2 == 0 ? "" : "half=" + std::to_string(rng.below(9)) + ",é=1",
                      {byte(), byte(), byte(),
                       rng.below(3) == 0 ? std::max<std::uint8_t>(1, byte()) : std::uint8_t{255}}));
  }
  std::uint16_t number = 1;
  std::uint32_t left = 1;
  bool is_first = true;
  return file_build(sides, materials, [&](VoxelPos at) {
    // One cell is solid, whatever the rest is.
    if (std::exchange(is_first, false) && at == VoxelPos{})
      return static_cast<std::uint16_t>(has_air ? 2 : 1);
    if (--left == 0) {
      left = 1 + rng.below(rng.below(4) == 0 ? 200 : 5);
      number =
          static_cast<std::uint16_t>(rng.below(static_cast<std::uint32_t>(materials.size()) + 1));
    }
    return number;
  });
}

std::vector<std::string> cell_texts(const FileBuild& build) {
  std::vector<std::string> texts{"-"};
  for (const BuildMaterial& material : build.materials) {
    const MaterialColour& c = material.row.colour;
    texts.push_back(material.row.visibility == Visibility::empty
                        ? "air"
                        : material.row.name + "|" + material.states + "|" + std::to_string(c[0]) +
                              "," + std::to_string(c[1]) + "," + std::to_string(c[2]) + "," +
                              std::to_string(c[3]));
  }
  std::vector<std::string> out;
  const VoxelPos sides = build.build->sides();
  for (std::int32_t z = 0; z < sides.z; ++z) {
    for (std::int32_t y = 0; y < sides.y; ++y) {
      for (std::int32_t x = 0; x < sides.x; ++x) {
        const auto material = build.build->at({x, y, z});
        out.push_back(texts[material ? *build.build->number_of(*material) : 0U]);
      }
    }
  }
  return out;
}

Result<Bytes> written(Result<void> (*write)(const FileBuild&, const FormatSink&),
                      const FileBuild& build) {
  Bytes out;
  const auto done = write(build, [&](ByteView bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
    return true;
  });
  if (!done) return failure(done.error());
  return out;
}

std::vector<std::size_t> lengths_without_error(const Format& format, const Bytes& file) {
  std::vector<std::size_t> out;
  for (std::size_t length = 0; length < file.size(); ++length) {
    // A copy of its own, so that a read behind the end is found.
    const Bytes part(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(length));
    const auto read = format.read(part, [](ForeignPiece&&) { return Result<void>{}; });
    if (read) out.push_back(length);
    if (!read) RUNSTONE_ASSERT(read.error().what[0] != '\0' && read.error().offset <= length);
  }
  return out;
}

}  // namespace runstone::test
