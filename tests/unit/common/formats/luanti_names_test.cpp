#include "common/formats/luanti_names.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "common/core/hash.hpp"
#include "common/core/text.hpp"
#include "common/formats/luanti_block.hpp"
#include "common/formats/luanti_block_writer.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/reorder.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

TEST_CASE("names that Luanti allows stay, and others are written so that they can be read back",
          "[formats]") {
  CHECK(luanti_node_name("default:stone") == "default:stone");
  CHECK(luanti_node_name("stone") == "stone");
  CHECK(luanti_node_name("red bricks") == "runstone:red__bricks");
  CHECK(luanti_node_name("ignore") == "runstone:ignore");
  CHECK(luanti_node_name("runstone:red__bricks") == "runstone:runstone_3ared_5f_5fbricks");
  CHECK(luanti_node_name("minecraft:oak_stairs[facing=east]") ==
        "runstone:minecraft_3aoak_5fstairs_5bfacing_3deast_5d");
  CHECK(luanti_node_name("\xc3\xa9") == "runstone:_c3_a9");
  for (const char* other : {"default:stone", "stone", "runstone:a_", "runstone:a_5",
                            "runstone:a_5F", "runstone:a_zz", "runstone:a b", "runstone:",
                            "runstone:air", "runstone:stone", "runstone:_c3", "runstone:_0a"})
    CHECK_FALSE(material_of_luanti_name(other).has_value());
  CHECK_FALSE(material_of_luanti_name("runstone:__" + std::string(64, 'x')).has_value());
}

TEST_CASE("random names lead back from Luanti, and to a material of the same name", "[formats]") {
  SplitMix64 rng(8);
  const std::string alphabet = "aZ9 _:[]=,.#~é";
  for (int round = 0; round < 3000; ++round) {
    std::string name;
    for (std::uint32_t left = 1 + rng.below(12); left > 0; --left)
      name += alphabet[rng.below(static_cast<std::uint32_t>(alphabet.size()))];
    if (!is_printable_utf8(name)) continue;
    CAPTURE(name);
    const std::string node = luanti_node_name(name);
    CHECK(node.find_first_not_of(
              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_:") ==
          std::string::npos);
    if (node != name) CHECK(material_of_luanti_name(node) == name);
    CHECK(material_of_luanti_node({node, ""}, false).name == name);
    CHECK(MaterialTable().add(material_of_luanti_node({node, ""}, false)).has_value());
  }
  // A voxel of a world is not left out, whatever its name says, and built-in ones look as they do.
  CHECK(material_of_luanti_node({"runstone:my__flower", ""}, false).visibility ==
        Visibility::opaque);
  CHECK(material_of_luanti_node({"stone", ""}, false).colour ==
        default_material_table()[*default_material_table().find("stone")].colour);
}

TEST_CASE("a name that ends with a param2 is a node with it", "[formats]") {
  CHECK(luanti_node_of("default:chest[param2=3]") == LuantiNode{"default:chest", 3});
  CHECK(luanti_node_of("red bricks[param2=255]") == LuantiNode{"runstone:red__bricks", 255});
  CHECK(luanti_node_of("a[b][param2=1]") == LuantiNode{luanti_node_name("a[b]"), 1});
  for (const char* name :
       {"default:chest", "a[param2=0]", "a[param2=03]", "a[param2=256]", "a[param2=]", "a[param2=3",
        "[param2=3]", "a[param2=3] ", "a[b=c,param2=3]", "air[param2=3]", "ignore[param2=3]",
        "a[param2=-1]", "minecraft:oak_stairs[facing=east]"})
    CHECK(luanti_node_of(name) == LuantiNode{luanti_node_name(name)});
}

TEST_CASE("a written block of Luanti is read with the same nodes", "[formats]") {
  SplitMix64 rng(4);
  for (int round = 0; round < 30; ++round) {
    const RunChunk voxels =
        random_chunk(rng, Extent::cube(16), random_order(rng), round == 0 ? 1 : 40);
    const auto node_of = [](Material material) {
      // Several materials are one node with another param2.
      return material == kEmpty ? LuantiNode{"air"}
                                : LuantiNode{"m:n" + std::to_string(material / 3),
                                             static_cast<std::uint8_t>(material % 3 * 100)};
    };
    const Bytes block = encode_luanti_block(voxels, node_of);
    CHECK(block[0] == 28);
    const auto piece = decode_luanti_block(block);
    REQUIRE(piece.has_value());
    const RunChunk expected = reorder(voxels, AxisOrder::xyz);
    REQUIRE(piece->voxels.runs.size() == expected.runs.size());
    for (std::size_t i = 0; i < expected.runs.size(); ++i) {
      CHECK(piece->voxels.runs.end(i) == expected.runs.end(i));
      const ForeignBlock& node = piece->blocks[piece->voxels.runs.material(i) - 1U];
      const LuantiNode written = node_of(expected.runs.material(i));
      CHECK(node.name == written.name);
      CHECK(node.states == (written.param2 == 0 ? "" : "param2=" + std::to_string(written.param2)));
    }
  }
}

TEST_CASE("the bytes of a written block are those that Luanti's format says", "[formats]") {
  const Bytes block = encode_luanti_block(uniform_chunk(Extent::cube(16), kEmpty),
                                          [](Material) { return LuantiNode{"air"}; });
  CHECK(Bytes(block.begin(), block.begin() + 6) == Bytes{28, 0, 0xff, 0xff, 2, 2});
  const Bytes ending = {0, 0, 0, 0xff, 0xff, 0xff, 0xff, 0,  0, 1,
                        0, 0, 0, 3,    'a',  'i',  'r',  10, 0, 0};
  REQUIRE(block.size() > ending.size());
  CHECK(Bytes(block.end() - static_cast<std::ptrdiff_t>(ending.size()), block.end()) == ending);
}

}  // namespace runstone::test
