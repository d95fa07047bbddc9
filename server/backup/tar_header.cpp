#include "server/backup/tar_header.hpp"

#include <algorithm>
#include <cstdio>
#include <span>
#include <string_view>
#include <utility>

namespace runstone {
namespace {

struct TarField {
  std::size_t at, bytes;
};
constexpr TarField kTarName{0, 100}, kTarMode{100, 8}, kTarUser{108, 8}, kTarGroup{116, 8},
    kTarSize{124, 12}, kTarTime{136, 12}, kTarSum{148, 8}, kTarKind{156, 1}, kTarMagic{257, 8},
    kTarPrefix{345, 155};
constexpr std::string_view kTarMagicText{
    "ustar\0"
    "00",
    8};
constexpr std::uint64_t kOctalEnd = 1ULL << 33;  // of eleven octal digits
constexpr std::uint8_t kBinaryMark = 0x80;

std::span<std::uint8_t> field_of(TarHeader& header, TarField field) {
  return std::span(header).subspan(field.at, field.bytes);
}
std::span<const std::uint8_t> field_of(const TarHeader& header, TarField field) {
  return std::span(header).subspan(field.at, field.bytes);
}

/// Writes octal digits and a zero byte.
void put_octal(std::span<std::uint8_t> out, std::uint64_t value) {
  out.back() = 0;
  for (std::size_t i = out.size() - 1; i > 0; --i, value /= 8)
    out[i - 1] = static_cast<std::uint8_t>('0' + value % 8);
}

std::optional<std::uint64_t> octal_of(std::span<const std::uint8_t> field) {
  std::uint64_t value = 0;
  std::size_t digits = 0;
  for (const std::uint8_t c : field) {
    if (c == 0 || c == ' ') break;
    if (c < '0' || c > '7' || ++digits > 12) return std::nullopt;
    value = value * 8 + static_cast<std::uint64_t>(c - '0');
  }
  if (digits == 0) return std::nullopt;
  return value;
}

std::optional<std::uint64_t> size_of(std::span<const std::uint8_t> field) {
  if ((field.front() & kBinaryMark) == 0) return octal_of(field);
  std::uint64_t value = 0;
  // The number stands in the last eight bytes; larger ones are no files.
  for (const std::uint8_t byte : field.last(8)) value = value << 8 | byte;
  const bool is_small = field[0] == kBinaryMark && field[1] == 0 && field[2] == 0 && field[3] == 0;
  if (!is_small || value > 1ULL << 60) return std::nullopt;
  return value;
}

/// Returns the sum of all bytes, where those of the sum itself count as blanks.
std::uint64_t sum_of(const TarHeader& header) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const bool is_sum = i >= kTarSum.at && i < kTarSum.at + kTarSum.bytes;
    sum += is_sum ? std::uint64_t{' '} : header[i];
  }
  return sum;
}

}  // namespace

Result<TarHeader, std::string> tar_header(const TarEntry& entry) {
  if (entry.name.empty() || entry.name.size() > kTarName.bytes)
    return failure(entry.name + ": a name in a pack has 1 to 100 bytes");
  TarHeader header{};
  std::ranges::copy(entry.name, field_of(header, kTarName).begin());
  put_octal(field_of(header, kTarMode), 0600);
  put_octal(field_of(header, kTarUser), 0);
  put_octal(field_of(header, kTarGroup), 0);
  const auto size = field_of(header, kTarSize);
  if (entry.bytes < kOctalEnd) {
    put_octal(size, entry.bytes);
  } else {
    size[0] = kBinaryMark;
    for (std::size_t i = 0; i < 8; ++i)
      size[size.size() - 1 - i] = static_cast<std::uint8_t>(entry.bytes >> (8 * i));
  }
  put_octal(field_of(header, kTarTime), std::min(entry.time_s, kOctalEnd - 1));
  field_of(header, kTarKind)[0] = '0';
  std::ranges::copy(kTarMagicText, field_of(header, kTarMagic).begin());
  // Six digits, a zero byte and a blank.
  put_octal(field_of(header, kTarSum).first(7), sum_of(header));
  field_of(header, kTarSum).back() = ' ';
  return header;
}

Result<std::optional<TarEntry>, std::string> parse_tar_header(const TarHeader& header) {
  if (std::ranges::all_of(header, [](std::uint8_t byte) { return byte == 0; }))
    return std::optional<TarEntry>();
  const auto sum = octal_of(field_of(header, kTarSum));
  if (!sum || *sum != sum_of(header)) return failure("has a damaged header");
  const std::uint8_t kind = field_of(header, kTarKind)[0];
  if ((kind != '0' && kind != 0) || field_of(header, kTarPrefix)[0] != 0)
    return failure("holds something else than plain files");
  const auto name = field_of(header, kTarName);
  TarEntry entry;
  entry.name.assign(name.begin(), std::ranges::find(name, std::uint8_t{0}));
  const auto bytes = size_of(field_of(header, kTarSize));
  const auto time_s = octal_of(field_of(header, kTarTime));
  if (!bytes || !time_s) return failure("has a header without a size or a time");
  entry.bytes = *bytes;
  entry.time_s = *time_s;
  return std::optional(std::move(entry));
}

}  // namespace runstone
