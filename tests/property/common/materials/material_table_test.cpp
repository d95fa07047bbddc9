// Rows that are appended to a material table, against a list of names, and their bytes.
#include "common/materials/material_table.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "tests/support/core/random_look.hpp"

namespace runstone::test {
namespace {

/// Returns a row that is valid in most cases. Few names are drawn, so that many are taken.
MaterialRow any_row(SplitMix64& rng) {
  MaterialRow row;
  row.name = "m" + std::to_string(rng.below(200));
  if (rng.below(200) == 0) row.name = rng.below(2) == 0 ? "" : std::string(65, 'x');
  row.visibility = static_cast<Visibility>(rng.below(3));
  for (std::uint8_t& channel : row.colour) channel = static_cast<std::uint8_t>(rng.next());
  if (row.visibility == Visibility::opaque && rng.below(200) != 0) row.colour[3] = 255;
  if (rng.below(3) == 0) row.look = random_look(rng);
  if (row.look && rng.below(100) == 0) row.look->grain = 101;
  if (row.look && rng.below(100) == 0)
    row.look->pattern = static_cast<MaterialPattern>(kMaterialPatterns);
  return row;
}

/// The oracle: returns the number of the first row that cannot be appended, or their count.
std::size_t first_bad(const std::vector<MaterialRow>& table, const std::vector<MaterialRow>& rows) {
  std::vector<MaterialRow> all = table;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const MaterialRow& row = rows[i];
    const bool is_known = std::any_of(all.begin(), all.end(),
                                      [&](const MaterialRow& old) { return old.name == row.name; });
    const bool is_see_through = row.visibility == Visibility::opaque && row.colour[3] != 255;
    const bool is_silly =
        row.look && (row.look->grain > 100 || static_cast<int>(row.look->pattern) > 9);
    if (is_known || is_see_through || is_silly || row.name.empty() || row.name.size() > 64)
      return i;
    all.push_back(row);
  }
  return rows.size();
}

}  // namespace

TEST_CASE("a table takes all rows that fit together, or none", "[materials][property]") {
  SplitMix64 rng{71 + Catch::rngSeed()};
  std::size_t taken = 0, refused = 0;
  for (int round = 0; round < 200; ++round) {
    MaterialTable table;
    std::vector<MaterialRow> oracle = {{"air", {0, 0, 0, 0}, Visibility::empty}};
    for (int step = 0; step < 20; ++step) {
      CAPTURE(Catch::rngSeed(), round, step);
      std::vector<MaterialRow> rows(1 + rng.below(6));
      for (MaterialRow& row : rows) row = any_row(rng);
      const auto first =
          static_cast<Material>(rng.below(10) == 0 ? table.size() + rng.below(3) : table.size());
      const std::size_t bad = first_bad(oracle, rows);
      const auto checked = table.check_rows(rows);
      REQUIRE(checked.has_value() == (bad == rows.size()));
      if (!checked) REQUIRE(checked.error().offset == bad);
      const bool fits = bad == rows.size() && first == table.size();
      REQUIRE(table.append(first, rows).has_value() == fits);
      if (fits) oracle.insert(oracle.end(), rows.begin(), rows.end());
      ++(fits ? taken : refused);
      REQUIRE(table.size() == oracle.size());
      for (std::size_t id = 0; id < oracle.size(); ++id) {
        const MaterialInfo& info = table[static_cast<Material>(id)];
        REQUIRE(MaterialRow{info.name, info.colour, info.visibility, info.body, info.look} ==
                oracle[id]);
        REQUIRE(table.find(info.name) == static_cast<Material>(id));
        REQUIRE_FALSE(info.generation.has_value());
      }
    }
  }
  CHECK(taken > 500);
  CHECK(refused > 500);
}

TEST_CASE("new materials survive their bytes, and damaged bytes are refused or canonical",
          "[materials][property]") {
  SplitMix64 rng{72 + Catch::rngSeed()};
  for (int round = 0; round < 300; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    AddedMaterials added;
    added.first = static_cast<Material>(1 + rng.below(60'000));
    added.rows.resize(1 + rng.below(8));
    for (MaterialRow& row : added.rows) row = any_row(rng);
    if (!validate(added)) continue;
    const EditDescriptor edit = materials_edit(added);
    const Bytes bytes = encode(edit);
    const auto decoded = decode_descriptor(bytes);
    REQUIRE(decoded.has_value());
    REQUIRE(*decoded == edit);
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      Bytes damaged = bytes;
      damaged[at] ^= static_cast<std::uint8_t>(1 + rng.below(255));
      const auto other = decode_descriptor(damaged);
      REQUIRE((!other || encode(*other) == damaged));
    }
  }
}

}  // namespace runstone::test
