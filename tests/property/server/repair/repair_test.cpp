// Repairs of worlds with random damage: no crash, no difference that is not named, and no record of
// the log lost that SQLite can read.
#include <catch2/catch.hpp>

#include "server/store/log_table.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/unit/server/repair/repair_bench.hpp"

namespace runstone::test {
namespace {

namespace fs = std::filesystem;

/// Damages the world in one way, and returns what was done.
std::string damage(RepairBench& bench, SplitMix64& rng) {
  const std::string log = bench.world + "/world.sqlite-wal";
  const bool takes_log = fs::exists(log) && fs::file_size(log) > 0 && rng.below(2) == 0;
  const std::string file = takes_log ? log : bench.world_file();
  const std::uint64_t bytes = fs::file_size(file);
  const auto below = [&](std::uint64_t end) { return rng.next() % end; };
  switch (rng.below(4)) {
    case 0: {
      const std::uint32_t bits = 1 + rng.below(40);
      for (std::uint32_t i = 0; i < bits; ++i) RepairBench::flip_bit(file, below(8 * bytes));
      return std::to_string(bits) + " bits of " + file;
    }
    case 1: {
      const std::uint32_t pages = 1 + rng.below(6);
      for (std::uint32_t i = 0; i < pages; ++i)
        RepairBench::overwrite(file, below(bytes / 2'048) * 2'048, std::string(2'048, '\0'));
      return std::to_string(pages) + " pages of " + file;
    }
    case 2:
      fs::resize_file(file, bytes / 2 + below(bytes / 2));
      return "the end of " + file;
    default: {
      std::string rows;
      constexpr std::pair<const char*, const char*> kKeys[] = {{"edit_log", "seq"},
                                                               {"player", "author"},
                                                               {"snapshot", "x"},
                                                               {"base", "x"},
                                                               {"player_instance", "author"},
                                                               {"keyframe_chunk", "seq"},
                                                               {"log_box", "first_seq"},
                                                               {"rights_record", "seq"}};
      for (const auto& [table, key] : kKeys) {
        if (rng.below(2) == 0) continue;
        const std::string each = std::to_string(2 + rng.below(9));
        raw_sql(bench.world_file(),
                std::string("DELETE FROM ") + table + " WHERE abs(" + key + ") % " + each + " = 0");
        rows += std::string(" ") + table;
      }
      return "rows of" + rows;
    }
  }
}

/// Returns the records that SQLite can read one by one in a copy of the world.
std::map<Sequence, EditRecord> readable_records(const RepairBench& bench) {
  std::map<Sequence, EditRecord> out;
  const std::string copy = bench.folder / "readable";
  fs::copy(bench.world, copy);
  auto database = sql::open_sqlite(copy + "/world.sqlite", sql::SqliteMode::write);
  for (Sequence seq = 1; database && seq <= kRepairEdits; ++seq) {
    auto row = database->prepare(std::string("SELECT ") + LogTable::kRecordColumns +
                                 " FROM edit_log WHERE log = 0 AND seq = " + std::to_string(seq));
    if (!row) continue;
    const auto there = row->step();
    if (!there || !*there) continue;
    if (auto record = LogTable::record_in(*row)) out.emplace(seq, *std::move(record));
  }
  return out;
}

/// Damages a world, repairs it and checks the bars. Returns false if the repair was refused.
bool repair_of_damage(std::uint64_t seed) {
  SplitMix64 rng(seed);
  const Sequence compacted = rng.below(2) == 0 ? 0 : 100;
  RepairBench bench(seed, compacted, rng.below(2) == 0);
  const std::string done = damage(bench, rng);
  const bool has_backup = rng.below(2) == 0;
  CAPTURE(seed, done, compacted, has_backup);
  const auto readable = readable_records(bench);
  const std::string error = bench.repair_to(bench.to, has_backup ? bench.backup : "");
  INFO(bench.printed);
  if (!error.empty()) {
    INFO(error);
    // A value that only a backup has is lost, or the bits of the version were flipped.
    const bool has_reason = error.find("is lost, and nothing else") != std::string::npos ||
                            error.find("world format") != std::string::npos;
    CHECK((has_reason && !fs::exists(bench.to)));
    return false;
  }
  const auto store = RepairBench::opened(bench.to);
  CHECK(store->check().has_value());
  const auto repaired = RepairBench::records_of(*store);
  for (const auto& [seq, record] : readable) {
    CAPTURE(seq);
    const auto found = repaired.find(seq);
    CHECK((found != repaired.end() && found->second == record));
  }
  for (const auto& [seq, record] : bench.records) {
    const auto found = repaired.find(seq);
    if (found != repaired.end() && found->second == record) continue;
    CHECK(bench.printed.find("lost        seq=" + std::to_string(seq)) != std::string::npos);
  }
  const bool has_losses =
      bench.printed.find("\nlost ") != std::string::npos || bench.printed.starts_with("lost ");
  if (!has_losses) CHECK(bench.has_same_ground(*store));
  return true;
}

}  // namespace

TEST_CASE("a repair loses no readable record and names every difference", "[repair][property]") {
  int repaired = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) repaired += repair_of_damage(seed) ? 1 : 0;
  CHECK(repaired >= 6);
}

TEST_CASE("repairs of 300 damaged worlds", "[.long]") {
  int repaired = 0;
  for (std::uint64_t seed = 1'000; seed < 1'300; ++seed) repaired += repair_of_damage(seed) ? 1 : 0;
  WARN(repaired << " of 300 were repaired; the others need a backup");
  CHECK(repaired >= 200);
}

}  // namespace runstone::test
