#include "common/formats/rsb_writer.hpp"

#include <utility>

#include "common/core/assert.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

// A block is closed at this size, so that one more entry of the largest kind keeps it below its
// bound. A run takes at most 3 bytes: there are at most 2^18 cells in a section, and a run of n
// cells has a code below n * 2^16.
constexpr std::size_t kRsbBlockBytes = std::size_t{1} << 20;
static_assert(kRsbBlockBytes + std::size_t{3} * (kBuildSectionVolumeMax + kBuildMaterialsMax) + 64 <
              kRsbRawBytesMax);

}  // namespace

RsbWriter::RsbWriter(RsbSink sink, int zstd_level)
    : sink_(std::move(sink)), zstd_level_(zstd_level) {
  RUNSTONE_ASSERT(zstd_level >= 0 && zstd_level <= 19);
  open_.kind = RsbKind::sections;
}

Unexpected<RsbError> RsbWriter::failure_at(ErrorCode code, const char* what, RsbKind kind) const {
  return {{Error{code, what, 0}, rsb_part_name(kind), position_}};
}

RsbResult<void> RsbWriter::write_block(RsbBlock block, ByteView raw) {
  pack_rsb_payload(raw, zstd_level_, packed_);
  block.raw_bytes = static_cast<std::uint32_t>(raw.size());
  block.stored_bytes = static_cast<std::uint32_t>(packed_.size());
  block.position = position_;
  block.payload_checksum = rsb_payload_checksum(packed_);
  bytes_.clear();
  write_rsb_header(block, checksum_, bytes_);
  bytes_.insert(bytes_.end(), packed_.begin(), packed_.end());
  if (!sink_(bytes_)) return failure_at(ErrorCode::io_failed, "cannot be written", block.kind);
  checksum_ = block.header_checksum;
  position_ += bytes_.size();
  return {};
}

RsbResult<void> RsbWriter::begin(const BuildInfo& info, std::span<const BuildMaterial> materials) {
  RUNSTONE_ASSERT(position_ == 0);
  if (const auto sound = validate(info); !sound)
    return failure_at(sound.error().code, sound.error().what, RsbKind::head);
  if (const auto sound = validate_build_materials(materials); !sound)
    return failure_at(sound.error().code, sound.error().what, RsbKind::materials);
  sides_ = info.sides;
  material_count_ = static_cast<std::uint32_t>(materials.size());
  Bytes mark(kRsbMark.begin(), kRsbMark.end());
  ByteWriter(mark).u32(has_shape(materials) ? kRsbVersionOfShapes : kRsbVersion);
  if (!sink_(mark)) return failure_at(ErrorCode::io_failed, "cannot be written", RsbKind::head);
  position_ = mark.size();
  RsbBlock block;
  block.kind = RsbKind::head;
  if (auto written = write_block(block, encode_build_head({info, material_count_})); !written)
    return written;
  block.kind = RsbKind::materials;
  std::uint64_t all_bytes = 0;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::size_t before = raw_.size();
    encode_build_material(materials[i], raw_);
    all_bytes += raw_.size() - before;
    if (all_bytes > kRsbMaterialBytesMax)
      return failure_at(ErrorCode::limit_exceeded, "materials take more than 8 MiB",
                        RsbKind::materials);
    ++block.count;
    if (raw_.size() < kRsbBlockBytes && i + 1 < materials.size()) continue;
    if (auto written = write_block(block, raw_); !written) return written;
    block.first += block.count;
    block.count = 0;
    raw_.clear();
  }
  return {};
}

RsbResult<void> RsbWriter::add(const BuildSection& section) {
  RUNSTONE_ASSERT(material_count_ != 0);
  const auto bad = [&](ErrorCode code, const char* what) {
    return failure_at(code, what, RsbKind::sections);
  };
  const BuildSides counts = section_counts(sides_);
  const SectionCoord at = section.at;
  if (at.x >= counts.x || at.y >= counts.y || at.z >= counts.z)
    return bad(ErrorCode::bad_value, "section lies outside the build");
  if (section.cells.is_uniform() && section.cells.runs.material(0) == 0) return {};
  if (const auto sound =
          validate_section(section.cells, section_extent(sides_, at), material_count_);
      !sound)
    return bad(sound.error().code, sound.error().what);
  const std::uint64_t number = section_number(sides_, at);
  if (last_ && number <= *last_) return bad(ErrorCode::broken_invariant, "sections do not ascend");
  if (open_.count == 0) open_.first = number;
  ByteWriter(raw_).varint(open_.count == 0 ? 0 : number - *last_ - 1);
  encode_section(in_cheapest_order(section.cells), raw_);
  ++open_.count;
  ++section_count_;
  touched_ += touched_cells(section.cells);
  last_ = number;
  if (raw_.size() >= kRsbBlockBytes || open_.count == kRsbCountMax) return write_sections();
  return {};
}

RsbResult<void> RsbWriter::write_sections() {
  if (open_.count == 0) return {};
  auto written = write_block(open_, raw_);
  open_.count = 0;
  raw_.clear();
  return written;
}

RsbResult<void> RsbWriter::finish() {
  if (section_count_ == 0)
    return failure_at(ErrorCode::bad_value, "build has no touched cell", RsbKind::sections);
  if (auto written = write_sections(); !written) return written;
  Bytes totals;
  ByteWriter w(totals);
  w.varint(section_count_);
  w.varint(touched_);
  RsbBlock block;
  block.kind = RsbKind::end;
  return write_block(block, totals);
}

}  // namespace runstone
