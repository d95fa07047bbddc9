#include "common/formats/inflate_source.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>

#include "common/core/assert.hpp"

namespace runstone {

void InflateSource::StreamDeleter::operator()(z_stream_s* stream) const {
  inflateEnd(stream);
  delete stream;
}

InflateSource::InflateSource(ByteView packed, Kind kind) : packed_(packed) {
  if (kind == Kind::stored) return;
  auto* stream = new z_stream_s{};
  const int begun = inflateInit2(stream, kind == Kind::zlib ? MAX_WBITS : -MAX_WBITS);
  RUNSTONE_ASSERT(begun == Z_OK);
  stream_.reset(stream);
}

InflateSource::~InflateSource() = default;
InflateSource::InflateSource(InflateSource&&) noexcept = default;
InflateSource& InflateSource::operator=(InflateSource&&) noexcept = default;

std::size_t InflateSource::offset() const {
  return at_ - (stream_ ? static_cast<std::size_t>(stream_->avail_in) : 0);
}

bool InflateSource::read(std::span<std::uint8_t> out) {
  if (!fill(out)) return false;
  checksum_ = static_cast<std::uint32_t>(crc32_z(checksum_, out.data(), out.size()));
  return true;
}

bool InflateSource::fill(std::span<std::uint8_t> out) {
  if (!stream_) {
    if (out.size() > packed_.size() - at_) return false;
    std::copy_n(packed_.begin() + static_cast<std::ptrdiff_t>(at_), out.size(), out.begin());
    at_ += out.size();
    return true;
  }
  while (!out.empty()) {
    // zlib counts in 32 bits.
    constexpr std::size_t kPart = std::size_t{1} << 30;
    if (stream_->avail_in == 0) {
      const std::size_t more = std::min(kPart, packed_.size() - at_);
      stream_->next_in = const_cast<Bytef*>(packed_.data() + at_);
      stream_->avail_in = static_cast<uInt>(more);
      at_ += more;
    }
    const auto room = static_cast<uInt>(std::min(kPart, out.size()));
    stream_->next_out = out.data();
    stream_->avail_out = room;
    const uInt had = stream_->avail_in;
    const int status = inflate(stream_.get(), Z_SYNC_FLUSH);
    const std::size_t made = room - stream_->avail_out;
    is_finished_ = status == Z_STREAM_END;
    out = out.subspan(made);
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) {
      is_damaged_ = true;
      return false;
    }
    if (made == 0 && (status == Z_STREAM_END ||
                      (stream_->avail_in == had && (had != 0 || at_ == packed_.size()))))
      return false;
  }
  return true;
}

bool InflateSource::finish() {
  std::array<std::uint8_t, 1> more{};
  return !fill(more) && !is_damaged_ && (is_finished_ || !stream_);
}

bool InflateSource::skip(std::uint64_t count) {
  std::array<std::uint8_t, 16384> part;
  for (; count > 0;) {
    const std::size_t size = static_cast<std::size_t>(std::min<std::uint64_t>(count, part.size()));
    if (!read(std::span(part).first(size))) return false;
    count -= size;
  }
  return true;
}

}  // namespace runstone
