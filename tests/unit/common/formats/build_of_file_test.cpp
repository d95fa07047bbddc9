#include "common/formats/build_of_file.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <string>
#include <tuple>

#include "common/core/build_info.hpp"
#include "common/core/hash.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone::test {
namespace {

std::vector<ForeignPiece>* joined_pieces = nullptr;
ForeignInfo joined_info;

Result<ForeignInfo> read_joined(ByteView, const PieceSink& sink) {
  for (const ForeignPiece& piece : *joined_pieces) {
    if (const auto taken = sink(ForeignPiece(piece)); !taken) return failure(taken.error());
  }
  return joined_info;
}

MaterialInfo joined_material(const ForeignBlock& block, bool) {
  MaterialInfo out;
  out.name = block.name;
  if (block.name.starts_with("air")) out.visibility = Visibility::empty;
  if (block.name == "plant") out.shape = {ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};
  if (block.name == "slab") out.shape = {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  return out;
}

const Format kJoinedFormat{"test", ".test", read_joined, joined_material};

Result<FileBuild> joined(std::vector<ForeignPiece> pieces, ForeignInfo info = {},
                         std::size_t bytes_max = kBuildBytesMax) {
  joined_pieces = &pieces;
  joined_info = std::move(info);
  return read_foreign_build(kJoinedFormat, {}, {.bytes_max = bytes_max, .name = "given"});
}

/// Returns "name" or "name[states]" of a cell; "-": untouched.
std::string cell_text(const FileBuild& build, VoxelPos at) {
  const auto material = build.build->at(at);
  if (!material) return "-";
  const BuildMaterial& of = build.materials[*build.build->number_of(*material) - 1U];
  return of.states.empty() ? of.row.name : of.row.name + "[" + of.states + "]";
}

ForeignPiece uniform_piece(VoxelPos origin, Extent extent, std::string name,
                           std::string states = "") {
  return {origin, uniform_chunk(extent, 1), {{std::move(name), std::move(states)}}};
}

}  // namespace

TEST_CASE("pieces of any place, size and order are laid over each other", "[formats]") {
  SplitMix64 rng{47};
  const std::vector<ForeignBlock> blocks = {{"stone", ""},       {"stone", "a=1"}, {"air", ""},
                                            {"air:cave", "x=2"}, {"wood", "b=2"},  {"unused", ""}};
  for (int round = 0; round < 40; ++round) {
    CAPTURE(round);
    std::vector<ForeignPiece> pieces;
    std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t>, std::string> cells;
    VoxelBox box;
    const int count = rng.between(1, round % 2 == 0 ? 3 : 12);
    for (int i = 0; i < count; ++i) {
      const Extent extent{static_cast<std::uint8_t>(rng.between(1, 70)),
                          static_cast<std::uint8_t>(rng.between(1, 20)),
                          static_cast<std::uint8_t>(rng.between(1, 20))};
      const VoxelPos origin{rng.between(-90, 40), rng.between(-20, 10), rng.between(40, 70)};
      const AxisOrder order = kAxisOrders[rng.below(6)];
      RunBuilder runs(extent, order);
      if (rng.below(4) == 0) {
        runs.append(extent.volume(), static_cast<Material>(rng.below(6)));
      }
      while (runs.filled() < extent.volume()) {
        runs.append(std::min(1 + rng.below(60), extent.volume() - runs.filled()),
                    static_cast<Material>(rng.below(6)));
      }
      ForeignPiece piece{origin, runs.finish(), blocks};
      const VoxelBox part{origin, {origin.x + extent.x, origin.y + extent.y, origin.z + extent.z}};
      box = bounding_box(box, part);
      for (std::uint32_t index = 0; index < extent.volume(); ++index) {
        const LocalPos at = pos_of(index, extent, order);
        const Material material = material_at(piece.voxels, at);
        if (material == 0) continue;
        const ForeignBlock& block = blocks[material - 1U];
        std::string text = block.name.starts_with("air") ? "air" : block.name;
        if (text != "air" && !block.states.empty()) text += "[" + block.states + "]";
        cells[{origin.x + at.x, origin.y + at.y, origin.z + at.z}] = text;
      }
      pieces.push_back(std::move(piece));
    }
    const auto build = joined(std::move(pieces));
    if (cells.empty()) {
      CHECK_FALSE(build.has_value());
      continue;
    }
    REQUIRE(build.has_value());
    REQUIRE(build->materials.size() == build->build->palette().size());
    CHECK(validate_build_materials(build->materials).has_value());
    CHECK(build->info.origin == box.min);
    REQUIRE(build->build->sides() ==
            VoxelPos{box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z});
    std::size_t wrong = 0;
    for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
          const auto known = cells.find({x, y, z});
          const std::string expected = known == cells.end() ? "-" : known->second;
          if (cell_text(*build, {x - box.min.x, y - box.min.y, z - box.min.z}) != expected) ++wrong;
        }
      }
    }
    CHECK(wrong == 0);
    CHECK(build->build->touched() == cells.size());
  }
}

TEST_CASE("the section of a piece that fits the grid is the piece, and air is empty", "[formats]") {
  const auto build = joined({uniform_piece({-64, 0, 64}, Extent::cube(64), "stone"),
                             uniform_piece({0, 0, 64}, Extent::cube(64), "air")});
  REQUIRE(build.has_value());
  CHECK(build->build->section_counts() == SectionPos{2, 1, 1});
  CHECK(build->build->run_count() == 2);
  CHECK(build->build->solid() == 64 * 64 * 64);
  CHECK(build->build->touched() == 2 * 64 * 64 * 64);
  REQUIRE(build->materials.size() == 2);
  CHECK(build->materials[0].row.name == "air");
  CHECK(build->materials[0].row.visibility == Visibility::empty);
  CHECK(build->build->palette() == std::vector<Material>{kEmpty, 1});
}

TEST_CASE("on request, shapes that fill less than half of their voxel are empty",
          "[formats][shapes]") {
  std::vector<ForeignPiece> pieces;
  std::int32_t x = 0;
  for (const char* name : {"plant", "slab", "stone"})
    pieces.push_back(uniform_piece({x++, 0, 0}, {1, 1, 1}, name));
  joined_pieces = &pieces;
  joined_info = {};
  const auto all = read_foreign_build(kJoinedFormat, {}, {});
  const auto cubes = read_foreign_build(kJoinedFormat, {}, {.only_cubes = true});
  REQUIRE((all && cubes));
  CHECK(cell_text(*all, {0, 0, 0}) == "plant");
  CHECK(cell_text(*cubes, {0, 0, 0}) == "air");
  CHECK(cell_text(*cubes, {1, 0, 0}) == "slab");
  CHECK(cell_text(*cubes, {2, 0, 0}) == "stone");
}

TEST_CASE("what a file says of itself becomes a valid info", "[formats]") {
  const auto piece = [] { return uniform_piece({5, 6, 7}, Extent::cube(2), "stone"); };
  auto build = joined({piece()}, {"My \"house\"\n", "  Anna ", 77, {100, 0, -7}});
  REQUIRE(build.has_value());
  CHECK(build->info.name == "My 'house'?");
  CHECK(build->info.author == "Anna");
  CHECK(build->info.created_us == 77);
  CHECK(build->info.origin == VoxelPos{105, 6, 0});
  build = joined({piece()}, {"\x01\xff\xfe", std::string(500, 'a'), -5, {kWorldLimit, 0, 0}});
  REQUIRE(build.has_value());
  CHECK(build->info.name == "?\?\?");
  CHECK(build->info.author == std::string(kBuildAuthorBytesMax, 'a'));
  CHECK(build->info.created_us == 0);
  CHECK(build->info.origin == VoxelPos{});
  CHECK(joined({piece()})->info.name == "given");
}

TEST_CASE("states that no build may have are cut or replaced", "[formats]") {
  const auto build =
      joined({uniform_piece({0, 0, 0}, Extent::cube(1), "stone", std::string(255, 'a') + "é"),
              uniform_piece({1, 0, 0}, Extent::cube(1), "stone", "a=\n\xff")});
  REQUIRE(build.has_value());
  CHECK(cell_text(*build, {0, 0, 0}) == "stone[" + std::string(255, 'a') + "]");
  CHECK(cell_text(*build, {1, 0, 0}) == "stone[a=?\?]");
}

TEST_CASE("builds that are too long, too large or outside the world are refused", "[formats]") {
  const auto small = [](VoxelPos at) { return uniform_piece(at, Extent::cube(1), "stone"); };
  const auto code = [](const Result<FileBuild>& read) {
    REQUIRE_FALSE(read.has_value());
    return read.error().code;
  };
  CHECK(code(joined({})) == ErrorCode::bad_value);
  CHECK(code(joined({{{}, uniform_chunk(Extent::cube(1), 0), {}}})) == ErrorCode::bad_value);
  CHECK(code(joined({small({kWorldLimit, 0, 0})})) == ErrorCode::bad_value);
  CHECK(code(joined({small({0, -kWorldLimit - 1, 0})})) == ErrorCode::bad_value);
  CHECK(code(joined({small({}), small({kBuildSideMax, 0, 0})})) == ErrorCode::limit_exceeded);
  CHECK(joined({small({}), small({kBuildSideMax - 1, 0, 0})}).has_value());
  // The grid alone is too large.
  CHECK(code(joined({small({}), small({1 << 19, 1 << 19, 1 << 19})})) == ErrorCode::limit_exceeded);
  // The pieces take too much.
  std::vector<ForeignPiece> many(64, small({1, 2, 3}));
  CHECK(code(joined(many, {}, 8000)) == ErrorCode::limit_exceeded);
  CHECK(joined(many, {}, 80'000).has_value());
  // More materials than a build may have.
  std::vector<ForeignPiece> named;
  for (int i = 0; i <= 65'535; ++i)
    named.push_back(uniform_piece({}, Extent::cube(1), "n" + std::to_string(i)));
  CHECK(code(joined(named)) == ErrorCode::limit_exceeded);
  named.pop_back();
  const auto last = joined(named);
  REQUIRE(last.has_value());
  // Only the last of the pieces on one cell is left.
  CHECK(last->materials.size() == 1);
  CHECK(last->materials[0].row.name == "n65534");
}

}  // namespace runstone::test
