// The target reads any bytes as an .rsb in two ways: unchanged (checksums reject nearly
// everything), and with every checksum corrected, so that lengths, runs and zstd frames are
// hostile. Whatever is read is a valid build, and reads the same after it is written again.
#include <cstdint>

#include "common/core/assert.hpp"
#include "tests/support/formats/rsb_bytes.hpp"

using namespace runstone;

namespace {

void read(const Bytes& file) {
  const test::RsbContents contents = test::read_rsb(file);
  const test::SampleBuild& build = contents.build;
  for (const BuildSection& section : build.sections) {
    RUNSTONE_ASSERT(validate_section(section.cells, section_extent(build.info.sides, section.at),
                                     static_cast<std::uint32_t>(build.materials.size()))
                        .has_value());
  }
  if (contents.error) return;
  const test::RsbContents second = test::read_rsb(test::rsb_of(build, 0));
  RUNSTONE_ASSERT(!second.error && second.build.info == build.info);
  RUNSTONE_ASSERT(second.build.materials == build.materials);
  RUNSTONE_ASSERT(second.build.sections == build.sections);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes file(data, data + size);
  read(file);
  test::mend_rsb(file);
  read(file);
  return 0;
}
