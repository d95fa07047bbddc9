// A world whose clock was ahead at one start, served again with a right one.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "common/core/utc_text.hpp"
#include "server/runtime/read_clocks.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kSecond = 1'000'000;
constexpr TimeUs kHour = 3'600 * kSecond;
constexpr TimeUs kAhead = 2 * 365 * 24 * kHour;

EditRecord record_of(Epoch epoch, Sequence seq, TimeUs time_us, const EditDescriptor& edit) {
  EditRecord record;
  record.version = {epoch, seq};
  record.op = {0, 77, seq};
  record.time_us = time_us;
  record.edit = edit;
  record.cause = rights_change_of(edit) == nullptr ? Cause::console : Cause::rights;
  return record;
}

/// Returns the key of RawClient::hello().
PublicKey key_of_player(std::uint8_t who) {
  KeySeed seed{};
  seed.fill(who);
  return key_pair_of(seed).public_key;
}

/// Writes what a server with a clock that is two years ahead has written: an edit of a right clock
/// three hours ago, and just now an edit, a mute for 5 s and a ban for an hour.
void write_ahead(const std::string& world) {
  auto store = open_world(world, StoreAccess::read_write);
  REQUIRE(store.has_value());
  const auto epoch = (*store)->raise_epoch();
  REQUIRE(epoch.has_value());
  const TimeUs now = read_clocks().utc_us;
  const TimeUs wrong = now + kAhead;
  const PublicKey ana = key_of_player(1);
  const PublicKey mole = key_of_player(2);
  const std::vector<EditRecord> records = {
      record_of(*epoch, 1, now - 3 * kHour, {SetVoxel{{1, 70, 1}}, {}, 1}),
      record_of(*epoch, 2, wrong, {SetVoxel{{2, 70, 1}}, {}, 1}),
      record_of(*epoch, 3, wrong,
                rights_edit(Restrict{RestrictionKind::mute, ana, wrong + 5 * kSecond, ""})),
      record_of(*epoch, 4, wrong,
                rights_edit(Restrict{RestrictionKind::ban, mole, wrong + kHour, ""}))};
  REQUIRE((*store)->append({}, records).has_value());
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

}  // namespace

TEST_CASE("a clock that was ahead at one start is corrected by a command", "[integration][clock]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  const std::string& world = config.world;
  start_server(config, flat_creation())->stop();
  write_ahead(world);
  {
    auto server = start_server(config, flat_creation());
    CHECK(must(world, {"clock"}).text.find("the log is 7") != std::string::npos);
    // Without the word it is refused on a machine whose clock no time service has set.
    const std::string text = must(world, {"clock", "correct", "anyway"}).text;
    CHECK(text.find("(record 5)") != std::string::npos);
    CHECK_FALSE(control(world, {"clock", "correct"}).is_ok);
    // The ban has nearly an hour left, not two years.
    const std::string bans = must(world, {"bans"}).text;
    const auto end_in = bans.find(" until ");
    REQUIRE(end_in != std::string::npos);
    const auto end = parse_utc(bans.substr(end_in + 7, 20));
    REQUIRE(end.has_value());
    const TimeUs left = *end - read_clocks().utc_us;
    CHECK((left > kHour - 600 * kSecond && left <= kHour));
    RawClient mole(server->port());
    CHECK_FALSE(mole.join(2).has_value());
    // `log since 1h` lists all records but the edit of three hours ago: the three records of the
    // wrong clock, the correction, and an edit that is ordered after it.
    RawClient ana(server->port());
    ana.features = kFeatureCommands;
    REQUIRE(ana.join(1).has_value());
    ana.send(EditRequest{1, 0, {SetVoxel{{3, 70, 1}}, {}, 1}});
    REQUIRE(ana.sees_durable(6));
    CHECK(lines_of(must(world, {"log", "since", "1h"}).text) == 5);
    CHECK(server->stop().is_clean);
  }
  // The next start goes on from the newest record.
  auto server = start_server(config, flat_creation());
  CHECK(must(world, {"clock"}).text.find(": they agree") != std::string::npos);
  CHECK(lines_of(must(world, {"log", "since", "1h"}).text) == 5);
  CHECK(server->stop().is_clean);
}

}  // namespace runstone::test
