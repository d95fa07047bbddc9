#include "common/model_reader/ply_source.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>
#include <string_view>
#include <system_error>

namespace runstone {
namespace {

constexpr std::size_t kLineBytesMax = 4096, kNumberBytesMax = 64;

template <class Number>
double number_of(const std::array<std::uint8_t, 8>& little_endian) {
  // The machine is little-endian, as all that the reader is built for are.
  Number number;
  std::memcpy(&number, little_endian.data(), sizeof number);
  return static_cast<double>(number);
}

bool is_blank(int c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

/// Returns the next byte, or -1.
int PlySource::next() {
  if (begin_ == end_) {
    begin_ = 0;
    end_ = file_.read(buffer_.data(), buffer_.size(), offset_);
    offset_ += end_;
    if (end_ == 0) {
      offset_ = file_.bytes();  // the file may have been cut meanwhile
      return -1;
    }
  }
  return buffer_[begin_++];
}

bool PlySource::line(std::string& to) {
  to.clear();
  for (int c; (c = next()) >= 0;) {
    if (c == '\n') {
      if (!to.empty() && to.back() == '\r') to.pop_back();
      return true;
    }
    if (to.size() == kLineBytesMax) return false;
    to.push_back(static_cast<char>(c));
  }
  return false;
}

bool PlySource::text_number(double& to) {
  int c = next();
  while (is_blank(c)) c = next();
  std::array<char, kNumberBytesMax> text;
  std::size_t bytes = 0;
  for (; c >= 0 && !is_blank(c); c = next()) {
    if (bytes == text.size()) return false;
    text[bytes++] = static_cast<char>(c);
  }
  const char* const begin = text.data() + (bytes > 0 && text[0] == '+' ? 1 : 0);
  const auto [end, wrong] = std::from_chars(begin, text.data() + bytes, to);
  if (wrong == std::errc::result_out_of_range) {
    const bool is_small =
        std::string_view(text.data(), bytes).find('-', 1) != std::string_view::npos;
    to = is_small ? 0 : std::numeric_limits<double>::infinity();  // which is left out later
  }
  return wrong != std::errc::invalid_argument && end == text.data() + bytes;
}

bool PlySource::number(PlyType type, double& to) {
  if (body_ == PlyBody::text) return text_number(to);
  std::array<std::uint8_t, 8> bytes{};
  const std::size_t count = ply_bytes(type);
  for (std::size_t i = 0; i < count; ++i) {
    const int c = next();
    if (c < 0) return false;
    bytes[i] = static_cast<std::uint8_t>(c);
  }
  if (body_ == PlyBody::big_endian)
    std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
  switch (type) {
    case PlyType::i8:
      to = number_of<std::int8_t>(bytes);
      break;
    case PlyType::u8:
      to = number_of<std::uint8_t>(bytes);
      break;
    case PlyType::i16:
      to = number_of<std::int16_t>(bytes);
      break;
    case PlyType::u16:
      to = number_of<std::uint16_t>(bytes);
      break;
    case PlyType::i32:
      to = number_of<std::int32_t>(bytes);
      break;
    case PlyType::u32:
      to = number_of<std::uint32_t>(bytes);
      break;
    case PlyType::f32:
      to = number_of<float>(bytes);
      break;
    case PlyType::f64:
      to = number_of<double>(bytes);
      break;
  }
  return true;
}

}  // namespace runstone
