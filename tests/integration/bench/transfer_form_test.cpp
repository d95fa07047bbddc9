// The forms that are compared must be correct: every form decodes to the same voxels, and Luanti's
// is the game's.
#include "bench/wire/transfer_form.hpp"

#include <catch2/catch.hpp>

#include <array>

#include "bench/wire/luanti_form.hpp"
#include "bench/wire/palette_form.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"
#include "server/import/luanti_map.hpp"
#include "tests/support/formats/luanti_bytes.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::bench {
namespace {

LitChunk random_lit(SplitMix64& rng, unsigned materials) {
  const auto shape = static_cast<test::ChunkShape>(rng.below(test::kShapeCount));
  const RunChunk wide =
      test::random_chunk(rng, Extent::cube(kByteEdge), test::random_order(rng), materials, shape);
  RunBuilder runs(wide.extent, wide.order);
  for (std::size_t i = 0; i < wide.runs.size(); ++i) {
    runs.append_to(wide.runs.end(i), static_cast<Material>(wide.runs.material(i) & 0x7fff));
  }
  LitChunk out{runs.finish(), {}, {}};
  out.voxels = to_dense(reorder(out.runs, AxisOrder::xyz));
  for (std::size_t i = 0; i < out.voxels.size(); ++i) {
    out.light.push_back(static_cast<std::uint8_t>(rng.below(256)));
  }
  return out;
}

PaletteSection section_of(SplitMix64& rng, unsigned materials) {
  PaletteSection out{};
  for (Material& id : out) id = static_cast<Material>(rng.below(materials));
  return out;
}

}  // namespace

TEST_CASE("every form of a chunk decodes to the encoded voxels", "[bench]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int step = 0; step < 24; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    const LitChunk chunk =
        random_lit(rng, step % 3 == 0 ? 1000 : 1 + static_cast<unsigned>(rng.below(20)));
    const auto forms = make_transfer_forms(chunk);
    REQUIRE(forms.size() == transfer_form_names().size());
    for (std::size_t f = 0; f < forms.size(); ++f) {
      CAPTURE(forms[f].name);
      CHECK(forms[f].name == transfer_form_names()[f]);
      forms[f].encode();
      forms[f].decode();
      CHECK(forms[f].bytes() > 0);
      REQUIRE(forms[f].voxels() == chunk.voxels);
      if (forms[f].name == "luanti_light") REQUIRE(forms[f].light() == chunk.light);
    }
  }
}

TEST_CASE("a Luanti block on the wire is the game's row without the fields of the disk",
          "[bench]") {
  auto map = open_luanti_sqlite_map(RUNSTONE_SOURCE_DIR "/tests/data/luanti_v7_small/map.sqlite");
  REQUIRE(map);
  std::size_t rows = 0, smaller = 0;
  const auto read = (*map)->each_row([&](const LuantiRow& row) {
    LuantiNodes nodes, back;
    REQUIRE(decode_luanti_row(row.data, nodes));
    Bytes wire;
    encode_luanti_block(nodes, wire);
    REQUIRE(decode_luanti_wire(wire, back));
    REQUIRE(nodes == back);
    ++rows;
    smaller += wire.size() < row.data.size() ? 1 : 0;
  });
  CHECK(read.has_value());
  CHECK(rows == 384);
  CHECK(smaller == rows);  // no names
}

TEST_CASE("ids and both parameters of a Luanti row are read from their planes", "[bench]") {
  test::LuantiBlockFields fields;
  fields.names = {{7, "default:stone"}};
  fields.nodes.assign(kLuantiNodes, 7);
  Bytes plain = test::luanti_plain(fields);
  const std::size_t params = plain.size() - fields.rest.size() - 2 * kLuantiNodes;
  plain[params + 5] = 0x2f;
  plain[params + kLuantiNodes + 6] = 9;
  LuantiNodes nodes;
  REQUIRE(decode_luanti_row(test::luanti_row(plain), nodes));
  CHECK(nodes.id[0] == 7);
  CHECK(nodes.id.back() == 7);
  CHECK(nodes.param1[4] == 0x0f);
  CHECK(nodes.param1[5] == 0x2f);
  CHECK(nodes.param2[6] == 9);
  CHECK_FALSE(decode_luanti_row(test::luanti_row(plain, 28), nodes));
}

TEST_CASE("Minecraft's sections have the bits of their palette", "[bench]") {
  SplitMix64 rng{5};
  for (const unsigned materials : {1u, 2u, 16u, 17u, 200u, 256u, 3000u}) {
    CAPTURE(materials);
    const std::array<PaletteSection, 2> sections = {section_of(rng, materials), section_of(rng, 1)};
    Bytes stream;
    encode_palette_sections(sections, stream);
    std::array<PaletteSection, 2> back{};
    REQUIRE(decode_palette_sections(stream, back));
    CHECK(back == sections);
    CHECK_FALSE(decode_palette_sections(stream, std::span(back).first(1)));
    stream.resize(stream.size() / 2);
    CHECK_FALSE(decode_palette_sections(stream, back));
  }
}

}  // namespace runstone::bench
