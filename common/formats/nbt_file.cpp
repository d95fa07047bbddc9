#include "common/formats/nbt_file.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace runstone {
namespace {

// The longest value that is read in one piece is a string of 65,535 bytes.
constexpr std::size_t kWindowBytes = std::size_t{128} << 10;
constexpr std::size_t kArrayPartBytes = std::size_t{64} << 10;
constexpr std::size_t kFlushBytes = std::size_t{64} << 10;

bool is_plain_nbt(ByteView file) {
  return !file.empty() && file[0] == static_cast<std::uint8_t>(NbtType::compound);
}

}  // namespace

NbtFileSource::NbtFileSource(ByteView file)
    : file_(file),
      is_plain_(is_plain_nbt(file)),
      packed_(is_plain_ ? ByteView() : file, DeflateForm::zlib_or_gzip),
      window_(is_plain_ ? 0 : kWindowBytes) {}

Result<ByteView> NbtFileSource::more(ByteView rest) {
  // Views only move forward, so a rest is the end of the file.
  if (is_plain_) return rest.empty() ? std::exchange(file_, {}) : rest;
  if (rest.size() == window_.size())
    return fail(ErrorCode::limit_exceeded, "nbt: a value is longer than 128 KiB", total_);
  if (!rest.empty()) std::memmove(window_.data(), rest.data(), rest.size());
  const auto read = packed_.read(std::span(window_).subspan(rest.size()));
  if (!read) return failure(read.error());
  const std::size_t count = *read;
  total_ += count;
  if (total_ > kNbtFileBytesMax)
    return fail(ErrorCode::limit_exceeded, "the file decompresses to more than 5 GiB", total_);
  return ByteView(window_).first(rest.size() + count);
}

NbtArrayPlace skip_nbt_array(NbtReader& in, std::size_t width) {
  const std::uint64_t bytes = std::uint64_t{in.array_head()} * width;
  const NbtArrayPlace place{in.offset(), bytes};
  in.skip_bytes(bytes);
  return place;
}

NbtArrayCursor::NbtArrayCursor(ByteView file, NbtArrayPlace place) : source_(file), in_(source_) {
  go_to(place);
}

void NbtArrayCursor::go_to(NbtArrayPlace place) {
  RUNSTONE_ASSERT(place.bytes == 0 || place.at >= in_.offset() || !in_.ok());
  at_ = end_ = nullptr;
  left_ = place.bytes;
  if (left_ > 0 && in_.ok()) in_.skip_bytes(place.at - in_.offset());
}

bool NbtArrayCursor::refill() {
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, kArrayPartBytes));
  if (count == 0) return false;
  const ByteView part = in_.bytes(count);
  left_ = in_.ok() ? left_ - count : 0;
  at_ = part.data();
  end_ = at_ + part.size();
  return !part.empty();
}

bool NbtFileWriter::give() {
  deflater_.write(plain_);
  plain_.clear();
  const bool is_taken = packed_.empty() || sink_(packed_);
  packed_.clear();
  return is_taken;
}

bool NbtFileWriter::flush() { return plain_.size() < kFlushBytes || give(); }

bool NbtFileWriter::finish() {
  deflater_.write(plain_);
  plain_.clear();
  deflater_.finish();
  return give();
}

}  // namespace runstone
