// RsbWriter: writes a build as an .rsb, front to back, with one block in memory. The sink gets the
// bytes of the file in order. Until finish(), these bytes are a truncated file. Thread: one.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/formats/build_head.hpp"
#include "common/formats/build_section.hpp"
#include "common/formats/rsb_block.hpp"

namespace runstone {

class RsbWriter {
 public:
  /// `zstd_level` is 1 .. 19; 0: blocks are not compressed.
  explicit RsbWriter(RsbSink sink, int zstd_level = 9);

  /// Writes mark, head and materials. Call it once, first. Fails if a field is outside its range.
  RsbResult<void> begin(const BuildInfo& info, std::span<const BuildMaterial> materials);
  /// Adds the next section, in its axis order with the fewest runs. Sections of which no cell is
  /// touched are left out. Fails with bad_value or broken_invariant if the section lies outside
  /// the build, does not follow the last one, or its cells are not valid. Cost: O(runs log
  /// materials + lines).
  RsbResult<void> add(const BuildSection& section);
  /// Writes the remaining sections and the end. Call it once, last. Fails if no cell is touched.
  RsbResult<void> finish();

  std::uint64_t bytes() const { return position_; }  // given to the sink

 private:
  RsbResult<void> write_block(RsbBlock block, ByteView raw);
  RsbResult<void> write_sections();
  Unexpected<RsbError> failure_at(ErrorCode code, const char* what, RsbKind kind) const;

  RsbSink sink_;
  int zstd_level_;
  BuildSides sides_;
  std::uint32_t material_count_ = 0;
  Bytes raw_, packed_, bytes_;
  RsbBlock open_;                      // the block of sections that grows in raw_
  std::optional<std::uint64_t> last_;  // number of the last section
  std::uint64_t section_count_ = 0, touched_ = 0;
  std::uint64_t position_ = 0, checksum_ = 0;
};

}  // namespace runstone
