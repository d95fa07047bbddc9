// RsbReader: reads an .rsb section by section. Every byte is untrusted: lengths, counts and numbers
// are bounded before use, and memory is that of one block, one section and the materials. Reading
// stops at the first bad block. The error names the kind of the block and its file position, and
// every section delivered before it is valid. Thread: one.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/formats/build_head.hpp"
#include "common/formats/build_section.hpp"
#include "common/formats/rsb_block.hpp"

namespace runstone {

class RsbReader {
 public:
  /// Reads mark, head and materials.
  static RsbResult<RsbReader> open(RsbSource source);

  const BuildInfo& info() const { return info_; }
  /// Returns the materials, ascending by name and states. Cell number i + 1 is materials()[i].
  const std::vector<BuildMaterial>& materials() const { return materials_; }

  /// Returns the next section, or nullopt at the valid end of the file. The sections ascend by
  /// number, and each has a touched cell.
  RsbResult<std::optional<BuildSection>> next();

  /// The sections and touched cells that next() returned so far.
  std::uint64_t section_count() const { return section_count_; }
  std::uint64_t touched() const { return touched_; }

 private:
  explicit RsbReader(RsbSource source) : source_(std::move(source)) {}
  RsbResult<void> read_head();
  RsbResult<void> read_materials(std::uint32_t material_count, bool with_shapes);
  RsbResult<void> read_end(const RsbBlock& block);
  RsbResult<RsbBlock> read_header();
  /// Reads the header and the payload of the next block. Fails if it is of another kind.
  RsbResult<RsbBlock> read_block(RsbKind kind);
  RsbResult<void> read_payload(const RsbBlock& block);
  Unexpected<RsbError> failure_at(const Error& error, const char* part,
                                  std::uint64_t position) const {
    return {{error, part, position}};
  }

  RsbSource source_;
  BuildInfo info_;
  std::vector<BuildMaterial> materials_;
  RsbBlock block_;          // of the sections in raw_
  std::uint32_t left_ = 0;  // sections of block_ that were not read
  std::size_t raw_at_ = 0;  // where the next one begins in raw_
  std::uint64_t next_ = 0;  // the least number of the next section
  std::uint64_t section_count_ = 0, touched_ = 0;
  Bytes stored_, raw_;
  std::uint64_t position_ = 0, checksum_ = 0;
};

}  // namespace runstone
