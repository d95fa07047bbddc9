// The target reads any bytes as an .rlog in two ways: unchanged (checksums reject nearly
// everything), and with every checksum corrected, so that lengths, columns and zstd frames are
// hostile. Whatever is read is a valid log, and reads the same after it is written again.
#include <cstdint>

#include "common/core/assert.hpp"
#include "tests/support/rlog/rlog_bytes.hpp"

using namespace runstone;

namespace {

void read(const Bytes& file) {
  const test::RlogContents contents = test::read_rlog(file);
  Sequence next = contents.world.head.seq + 1;
  Epoch epoch = contents.world.head.epoch;
  for (const EditRecord& record : contents.records) {
    RUNSTONE_ASSERT(record.version.seq == next && record.version.epoch >= epoch);
    RUNSTONE_ASSERT(validate_fields(record).has_value() && validate(record.edit).has_value());
    ++next;
    epoch = record.version.epoch;
  }
  if (contents.error) {
    // Records come before the error, never after it.
    RUNSTONE_ASSERT(contents.records.empty() || contents.error->seq >= next);
    return;
  }
  const Bytes again =
      test::rlog_of(contents.world, contents.players, contents.records, {0, kRlogCountMax});
  const test::RlogContents second = test::read_rlog(again);
  RUNSTONE_ASSERT(!second.error && second.world == contents.world &&
                  second.players == contents.players);
  RUNSTONE_ASSERT(second.records == contents.records);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes file(data, data + size);
  read(file);
  test::mend_rlog(file);
  read(file);
  return 0;
}
