#include "common/formats/rsb_reader.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

Error rsb_unreadable() { return {ErrorCode::io_failed, "cannot be read", 0}; }

}  // namespace

RsbResult<RsbReader> RsbReader::open(RsbSource source) {
  RsbReader reader(std::move(source));
  if (const auto head = reader.read_head(); !head) return failure(head.error());
  return reader;
}

RsbResult<RsbBlock> RsbReader::read_header() {
  std::array<std::uint8_t, kRsbHeaderBytes> bytes{};
  const auto got = source_(position_, bytes);
  if (!got) return failure_at(rsb_unreadable(), "block", position_);
  if (*got == 0) {
    return failure_at({ErrorCode::truncated, "file ends without its end block", 0}, "block",
                      position_);
  }
  const auto block = read_rsb_header(ByteView(bytes).first(*got), checksum_);
  if (!block) return failure_at(block.error(), "block", position_);
  if (block->position != position_) {
    return failure_at(
        {ErrorCode::broken_invariant, "block stands at another place than it says", 0},
        rsb_part_name(block->kind), position_);
  }
  return *block;
}

RsbResult<void> RsbReader::read_payload(const RsbBlock& block) {
  const char* part = rsb_part_name(block.kind);
  stored_.resize(block.stored_bytes);
  const auto got = source_(block.position + kRsbHeaderBytes, stored_);
  if (!got) return failure_at(rsb_unreadable(), part, block.position);
  if (*got < stored_.size()) {
    return failure_at({ErrorCode::truncated, "file ends inside a block", 0}, part, block.position);
  }
  if (rsb_payload_checksum(stored_) != block.payload_checksum) {
    return failure_at({ErrorCode::bad_checksum, "checksum of the block is wrong", 0}, part,
                      block.position);
  }
  if (const auto unpacked = unpack_rsb_payload(stored_, block.raw_bytes, raw_); !unpacked)
    return failure_at(unpacked.error(), part, block.position);
  position_ += kRsbHeaderBytes + block.stored_bytes;
  checksum_ = block.header_checksum;
  return {};
}

RsbResult<RsbBlock> RsbReader::read_block(RsbKind kind) {
  auto block = read_header();
  if (!block) return block;
  if (block->kind != kind) {
    return failure_at(
        {ErrorCode::broken_invariant, "block stands where one of another kind must", 0},
        rsb_part_name(block->kind), position_);
  }
  if (const auto read = read_payload(*block); !read) return failure(read.error());
  return block;
}

RsbResult<void> RsbReader::read_head() {
  std::array<std::uint8_t, kRsbFileHeadBytes> mark{};
  const auto got = source_(0, mark);
  if (!got) return failure_at(rsb_unreadable(), "mark", 0);
  if (!std::equal(kRsbMark.begin(), kRsbMark.end(), mark.begin()))
    return failure_at({ErrorCode::bad_value, "is not an .rsb file", 0}, "mark", 0);
  if (*got < mark.size())
    return failure_at({ErrorCode::truncated, "file ends inside its mark", 0}, "mark", 0);
  const std::uint32_t version = ByteReader(ByteView(mark).subspan(kRsbMark.size())).u32();
  if (version != kRsbVersion && version != kRsbVersionOfShapes) {
    return failure_at(
        {ErrorCode::bad_version, "is an .rsb of another version than this program knows", 0},
        "mark", 0);
  }
  position_ = mark.size();
  const auto block = read_block(RsbKind::head);
  if (!block) return failure(block.error());
  auto head = decode_build_head(raw_);
  if (!head) return failure_at(head.error(), "head", block->position);
  info_ = std::move(head->info);
  return read_materials(head->material_count, version == kRsbVersionOfShapes);
}

RsbResult<void> RsbReader::read_materials(std::uint32_t material_count, bool with_shapes) {
  std::uint64_t all_bytes = 0;
  std::uint64_t begin = position_;
  while (materials_.size() < material_count) {
    const auto block = read_block(RsbKind::materials);
    if (!block) return failure(block.error());
    begin = block->position;
    all_bytes += raw_.size();
    if (all_bytes > kRsbMaterialBytesMax) {
      return failure_at({ErrorCode::limit_exceeded, "materials take more than 8 MiB", 0},
                        "materials", begin);
    }
    if (block->first != materials_.size() || block->count > material_count - materials_.size()) {
      return failure_at(
          {ErrorCode::broken_invariant, "materials are not those that the head announces", 0},
          "materials", begin);
    }
    if (const auto read = decode_build_materials(raw_, block->count, with_shapes, materials_);
        !read)
      return failure_at(read.error(), "materials", begin);
  }
  if (const auto sound = validate_build_materials(materials_); !sound)
    return failure_at(sound.error(), "materials", begin);
  if (with_shapes && !has_shape(materials_)) {
    return failure_at(
        {ErrorCode::not_canonical, "no material has a shape in a file of version 2", 0},
        "materials", begin);
  }
  return {};
}

RsbResult<void> RsbReader::read_end(const RsbBlock& block) {
  ByteReader r(raw_);
  const std::uint64_t sections = r.varint();
  const std::uint64_t touched = r.varint();
  if (const auto done = r.finish(); !done) return failure_at(done.error(), "end", block.position);
  if (sections != section_count_ || touched != touched_ || sections == 0) {
    return failure_at({ErrorCode::broken_invariant,
                       "sections and cells of the file are not those that its end counts", 0},
                      "end", block.position);
  }
  std::array<std::uint8_t, 1> more{};
  const auto got = source_(position_, more);
  if (!got) return failure_at(rsb_unreadable(), "end", position_);
  if (*got != 0) {
    return failure_at({ErrorCode::trailing_bytes, "something follows the end block", 0}, "end",
                      position_);
  }
  return {};
}

RsbResult<std::optional<BuildSection>> RsbReader::next() {
  const std::uint64_t sections_max = section_counts(info_.sides).volume();
  if (left_ == 0) {
    const auto block = read_header();
    if (!block) return failure(block.error());
    const bool is_end = block->kind == RsbKind::end;
    if (!is_end && block->kind != RsbKind::sections) {
      return failure_at({ErrorCode::broken_invariant, "block stands among the sections", 0},
                        rsb_part_name(block->kind), position_);
    }
    const std::uint64_t begin = position_, checksum_before = checksum_;
    if (const auto read = read_payload(*block); !read) return failure(read.error());
    if (is_end) {
      const auto end = read_end(*block);
      // A further call finds the end again.
      position_ = begin;
      checksum_ = checksum_before;
      if (!end) return failure(end.error());
      return std::optional<BuildSection>{};
    }
    block_ = *block;
    if (block_.first < next_) {
      return failure_at({ErrorCode::broken_invariant, "sections do not ascend", 0}, "sections",
                        block_.position);
    }
    next_ = block_.first;
    left_ = block_.count;
    raw_at_ = 0;
  }
  ByteReader r(ByteView(raw_).subspan(raw_at_));
  const auto wrong = [&](Error error) {
    error.offset += raw_at_;
    return failure_at(error, "sections", block_.position);
  };
  if (next_ >= sections_max)
    return wrong({ErrorCode::bad_value, "section lies outside the build", 0});
  const std::uint64_t skipped =
      r.varint_max(sections_max - 1 - next_, "section lies outside the build");
  if (!r.ok()) return wrong(r.error());
  if (left_ == block_.count && skipped != 0)
    return wrong(
        {ErrorCode::not_canonical, "first section of a block is not the announced one", 0});
  const SectionCoord at = section_at(info_.sides, next_ + skipped);
  BuildSection section{at, decode_section(r, section_extent(info_.sides, at),
                                          static_cast<std::uint32_t>(materials_.size()))};
  if (!r.ok()) return wrong(r.error());
  raw_at_ += r.offset();
  --left_;
  if (left_ == 0 && raw_at_ != raw_.size())
    return wrong({ErrorCode::trailing_bytes, "bytes follow the last section of a block", 0});
  next_ += skipped + 1;
  ++section_count_;
  touched_ += touched_cells(section.cells);
  return std::optional<BuildSection>(std::move(section));
}

}  // namespace runstone
