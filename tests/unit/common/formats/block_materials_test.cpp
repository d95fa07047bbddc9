#include "common/formats/block_materials.hpp"

#include <catch2/catch.hpp>

#include "common/runs/run_builder.hpp"

using namespace runstone;

namespace {

/// Names its materials as blocks with their states. Blocks whose name begins with "no" are empty.
MaterialInfo material_with_states(const ForeignBlock& block, bool keep_all) {
  MaterialInfo out;
  out.name = block.name + (block.states.empty() ? "" : "[" + block.states + "]");
  out.colour = {1, 2, 3, 255};
  if (block.name.starts_with("no") && !keep_all) out.visibility = Visibility::empty;
  return out;
}

/// Names its materials as blocks, whatever their states.
MaterialInfo material_of_name(const ForeignBlock& block, bool keep_all) {
  return material_with_states({block.name, ""}, keep_all);
}

constexpr Format kWithStates{"test", ".test", nullptr, material_with_states};
constexpr Format kByName{"test", ".test", nullptr, material_of_name};

/// Returns a piece of which the first line begins with two voxels of each block but the last one. All
/// other voxels have material 0.
ForeignPiece piece_of(std::vector<ForeignBlock> blocks) {
  RunBuilder runs(Extent::cube(16), AxisOrder::xyz);
  for (std::size_t i = 0; i + 1 < blocks.size(); ++i) runs.append(2, static_cast<Material>(i + 1));
  runs.append_to(4096, kEmpty);
  return {{}, runs.finish(), std::move(blocks)};
}

std::vector<std::string> names_of(const MaterialTable& table) {
  std::vector<std::string> out;
  for (const MaterialInfo& info : table.rows()) out.push_back(info.name);
  return out;
}

const std::vector<ForeignBlock> kHouse = {{"stairs", "facing=west"}, {"stone", ""}, {"nothing", ""},
                                          {"stairs", "facing=east"}, {"stone", ""}, {"glass", ""}};

}  // namespace

TEST_CASE("blocks become materials by name and states, and unused blocks do not", "[formats]") {
  const ForeignPiece piece = piece_of(kHouse);
  BlockMaterials materials(kWithStates, false);
  materials.note(piece);
  const auto table = materials.make_table();
  REQUIRE(table.has_value());
  CHECK(names_of(*table) ==
        std::vector<std::string>{"air", "stairs[facing=east]", "stairs[facing=west]", "stone"});
  const RunChunk voxels = materials.resolve(piece);
  REQUIRE(validate(voxels).has_value());
  const auto at = [&](std::uint8_t x) { return (*table)[material_at(voxels, {x, 0, 0})].name; };
  CHECK(at(1) == "stairs[facing=west]");
  CHECK(at(2) == "stone");
  CHECK(at(4) == "air");
  CHECK(at(6) == "stairs[facing=east]");
  CHECK(at(8) == "stone");
  CHECK(at(15) == "air");
}

TEST_CASE("blocks with materials of one name share it, and empty ones are kept on request",
          "[formats]") {
  const ForeignPiece piece = piece_of(kHouse);
  BlockMaterials materials(kByName, true);
  materials.note(piece);
  const auto table = materials.make_table();
  REQUIRE(table.has_value());
  CHECK(names_of(*table) == std::vector<std::string>{"air", "nothing", "stairs", "stone"});
  const RunChunk voxels = materials.resolve(piece);
  CHECK(material_at(voxels, {0, 0, 0}) == material_at(voxels, {6, 0, 0}));
  CHECK(material_at(voxels, {4, 0, 0}) == 1);
}

TEST_CASE("blocks that were not noted are empty", "[formats]") {
  BlockMaterials materials(kWithStates, false);
  materials.note(piece_of({{"stone", ""}, {"end", ""}}));
  REQUIRE(materials.make_table().has_value());
  const RunChunk voxels = materials.resolve(piece_of({{"sand", ""}, {"stone", ""}, {"end", ""}}));
  CHECK(material_at(voxels, {0, 0, 0}) == kEmpty);
  CHECK(material_at(voxels, {2, 0, 0}) == 1);
}

TEST_CASE("names and states of a world are bounded", "[formats]") {
  BlockMaterials materials(kWithStates, false);
  for (int i = 0; i < 80; ++i)
    materials.note(piece_of({{std::to_string(i), std::string(1 << 20, 's')}, {"end", ""}}));
  const auto table = materials.make_table();
  REQUIRE_FALSE(table.has_value());
  CHECK(table.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("a map chooses the materials of blocks, and a kept material of that name has its look",
          "[formats]") {
  const ForeignPiece piece = piece_of(kHouse);
  const auto map = MaterialMap::of(
      {{"stairs[facing=west]", "stone"}, {"stairs", "planks"}, {"nothing", "stone"}});
  REQUIRE(map.has_value());
  BlockMaterials materials(kWithStates, false, &*map);
  materials.note(piece);
  const auto table = materials.make_table();
  REQUIRE(table.has_value());
  CHECK(names_of(*table) == std::vector<std::string>{"air", "planks", "stone"});
  CHECK((*table)[*table->find("stone")].colour == MaterialColour{1, 2, 3, 255});
  CHECK(materials.applied() == AppliedRows{0, 1});
  const RunChunk voxels = materials.resolve(piece);
  CHECK(material_at(voxels, {0, 0, 0}) == *table->find("stone"));
  CHECK(material_at(voxels, {4, 0, 0}) == kEmpty);
  CHECK(material_at(voxels, {6, 0, 0}) == *table->find("planks"));
}
