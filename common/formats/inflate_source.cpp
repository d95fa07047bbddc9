#include "common/formats/inflate_source.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>

namespace runstone {

InflateSource::InflateSource(ByteView packed, std::optional<DeflateForm> form) {
  if (form)
    inflater_.emplace(packed, *form);
  else
    stored_ = packed;
}

bool InflateSource::read(std::span<std::uint8_t> out) {
  if (!fill(out)) return false;
  checksum_ = static_cast<std::uint32_t>(crc32_z(checksum_, out.data(), out.size()));
  return true;
}

bool InflateSource::fill(std::span<std::uint8_t> out) {
  if (inflater_) {
    const auto made = inflater_->read(out);
    is_damaged_ = !made && made.error().code == ErrorCode::bad_value;
    return made && *made == out.size();
  }
  if (out.size() > stored_.size() - at_) return false;
  std::copy_n(stored_.begin() + static_cast<std::ptrdiff_t>(at_), out.size(), out.begin());
  at_ += out.size();
  return true;
}

bool InflateSource::finish() {
  std::array<std::uint8_t, 1> more{};
  return !fill(more) && !is_damaged_ && (!inflater_ || inflater_->at_end());
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
