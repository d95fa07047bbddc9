#include "server/store/record_checksum.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <vector>

#include "tests/support/edits/pinned_record.hpp"

using namespace runstone;
using namespace runstone::test;

TEST_CASE("the checksum of a record is pinned", "[store][golden]") {
  CHECK(record_checksum(pinned_record()) == 0x4a2777c5df689b9fULL);
}

TEST_CASE("a change of any field of a record changes its checksum", "[store]") {
  const std::vector<std::function<void(EditRecord&)>> changes = {
      [](EditRecord& r) { r.version.epoch ^= 1; },
      [](EditRecord& r) { r.version.seq += 1; },
      [](EditRecord& r) { r.op.author ^= 1; },
      [](EditRecord& r) { r.op.instance ^= 1; },
      [](EditRecord& r) { r.op.seq ^= 1; },
      [](EditRecord& r) { r.time_us += 1; },
      [](EditRecord& r) { r.cause = Cause::player; },
      [](EditRecord& r) { r.subject -= 1; },
      [](EditRecord& r) { r.log = 0; },
      [](EditRecord& r) { r.edit.material = 8; },
  };
  const std::uint64_t checksum = record_checksum(pinned_record());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    CAPTURE(i);
    EditRecord record = pinned_record();
    changes[i](record);
    CHECK(record_checksum(record) != checksum);
  }
}
