#include "common/formats/npy_header.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr std::size_t kNpyHeaderBytesMax = std::size_t{1} << 16;
constexpr std::array<std::uint8_t, 6> kNpyMark = {0x93, 'N', 'U', 'M', 'P', 'Y'};
constexpr std::uint64_t kNpyItemsMax = std::uint64_t{1} << 63;

/// Reads the dictionary of the head, a literal of Python.
class NpyDictionary {
 public:
  explicit NpyDictionary(std::string_view text) : text_(text) {}

  std::optional<NpyHeader> read() {
    bool has_type = false, has_order = false, has_shape = false;
    if (!take('{')) return std::nullopt;
    while (!take('}')) {
      const auto key = string();
      if (!key || !take(':')) return std::nullopt;
      bool* seen = *key == "descr"           ? &has_type
                   : *key == "fortran_order" ? &has_order
                   : *key == "shape"         ? &has_shape
                                             : nullptr;
      if (seen == nullptr || *seen) return std::nullopt;
      *seen = true;
      const bool is_read = seen == &has_type    ? read_type()
                           : seen == &has_order ? read_order()
                                                : read_shape();
      if (!is_read) return std::nullopt;
      if (!take(',') && (skip_blanks(), text_.empty() || text_.front() != '}')) return std::nullopt;
    }
    skip_blanks();
    if (!text_.empty() || !has_type || !has_order || !has_shape) return std::nullopt;
    return header_;
  }

 private:
  void skip_blanks() {
    while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\n'))
      text_.remove_prefix(1);
  }
  bool take(char c) {
    skip_blanks();
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  bool take(std::string_view word) {
    skip_blanks();
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }
  std::optional<std::string_view> string() {
    const char quote = take('\'') ? '\'' : '"';
    if (quote == '"' && !take('"')) return std::nullopt;
    const std::size_t end = text_.find(quote);
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view out = text_.substr(0, end);
    text_.remove_prefix(end + 1);
    return out;
  }
  std::optional<std::uint64_t> number() {
    skip_blanks();
    std::uint64_t out = 0;
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), out);
    if (error != std::errc{}) return std::nullopt;
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return out;
  }

  bool read_type() {
    const auto type = string();
    if (!type || type->size() < 3 || type->size() > 12) return false;
    const char order = type->front();
    if (order != '<' && order != '>' && order != '|') return false;
    header_.is_big_endian = order == '>';
    header_.kind = (*type)[1];
    std::uint32_t size = 0;
    const auto [end, error] = std::from_chars(type->data() + 2, type->data() + type->size(), size);
    if (error != std::errc{} || end != type->data() + type->size()) return false;
    if (header_.kind == 'U') {
      if (size > 1024) return false;
      size *= 4;
    } else if (header_.kind == 'S') {
      if (size > 4096) return false;
    } else if (header_.kind == 'b') {
      if (size != 1) return false;
    } else if ((header_.kind != 'u' && header_.kind != 'i') ||
               (size != 1 && size != 2 && size != 4 && size != 8)) {
      return false;
    }
    header_.item_bytes = size;
    return true;
  }
  bool read_order() {
    header_.is_fortran = take("True");
    return header_.is_fortran || take("False");
  }
  bool read_shape() {
    if (!take('(')) return false;
    while (!take(')')) {
      const auto side = number();
      if (!side || header_.shape.size() == kNpyAxesMax) return false;
      header_.shape.push_back(*side);
      take('L');  // of Python 2
      if (!take(',') && (skip_blanks(), text_.empty() || text_.front() != ')')) return false;
    }
    return true;
  }

  std::string_view text_;
  NpyHeader header_;
};

}  // namespace

std::uint64_t NpyHeader::items() const {
  std::uint64_t out = 1;
  for (const std::uint64_t side : shape) {
    if (side == 0) return 0;
  }
  for (const std::uint64_t side : shape) {
    if (side > kNpyItemsMax / out) return kNpyItemsMax;
    out *= side;
  }
  return out;
}

Result<NpyHeader> read_npy_header(InflateSource& source, std::uint64_t bytes_max) {
  const auto cut = [&] {
    return source.is_damaged()
               ? fail(ErrorCode::bad_value, "npy: a deflate stream is damaged", source.offset())
               : fail(ErrorCode::truncated, "npy: ends in its head", source.offset());
  };
  std::array<std::uint8_t, 8> mark{};
  if (!source.read(mark)) return cut();
  if (!std::equal(kNpyMark.begin(), kNpyMark.end(), mark.begin()))
    return fail(ErrorCode::bad_value, "npy: is not an array of numpy", 0);
  if (mark[6] < 1 || mark[6] > 3 || mark[7] != 0)
    return fail(ErrorCode::bad_version, "npy: of another version than 1 to 3", 6);
  std::array<std::uint8_t, 4> length{};
  if (!source.read(std::span(length).first(mark[6] == 1 ? 2 : 4))) return cut();
  const std::uint32_t bytes = ByteReader(length).u32();
  if (bytes > kNpyHeaderBytesMax)
    return fail(ErrorCode::limit_exceeded, "npy: head has more than 65536 bytes", source.offset());
  if (bytes > bytes_max) return cut();
  std::string text(bytes, '\0');
  if (!source.read({reinterpret_cast<std::uint8_t*>(text.data()), text.size()})) return cut();
  auto header = NpyDictionary(text).read();
  if (!header)
    return fail(ErrorCode::bad_value,
                "npy: head does not name descr, fortran_order and shape of a known kind",
                source.offset());
  return *std::move(header);
}

Bytes npy_header(const std::string& type, std::span<const std::uint64_t> shape) {
  std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (i > 0) text += ' ';
    text += std::to_string(shape[i]);
    if (i + 1 < shape.size() || shape.size() == 1) text += ',';
  }
  text += "), }";
  constexpr std::size_t kPrefix = kNpyMark.size() + 2 + 2, kAlign = 64;
  text.append((kAlign - (kPrefix + text.size() + 1) % kAlign) % kAlign, ' ');
  text += '\n';
  RUNSTONE_ASSERT(text.size() < 65'536);
  Bytes out;
  out.reserve(kPrefix + text.size());
  ByteWriter w(out);
  w.bytes(kNpyMark);
  w.u8(1);
  w.u8(0);
  w.u16(static_cast<std::uint16_t>(text.size()));
  w.bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return out;
}

}  // namespace runstone
