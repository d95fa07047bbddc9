#include "common/os/text_file.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace runstone {
namespace {

constexpr std::string_view kMark = "\xEF\xBB\xBF", kBigEndian = "\xFE\xFF",
                           kLittleEndian = "\xFF\xFE";

}  // namespace

Result<std::string, std::string> text_of_bytes(std::string bytes) {
  const std::string_view all = bytes;
  if (all.starts_with(kBigEndian) || all.starts_with(kLittleEndian))
    return failure("is in UTF-16 or UTF-32: save it as UTF-8");
  std::string text;
  text.reserve(bytes.size());
  for (std::size_t i = all.starts_with(kMark) ? kMark.size() : 0; i < all.size(); ++i) {
    const bool ends_line = all[i] == '\r' && i + 1 < all.size() && all[i + 1] == '\n';
    if (!ends_line) text.push_back(all[i]);
  }
  return text;
}

Result<std::string, std::string> read_text_file(const std::string& file, std::size_t bytes_max,
                                                FileKinds kinds) {
  auto bytes = read_file(file, bytes_max, kinds);
  if (!bytes) return bytes;
  auto text = text_of_bytes(*std::move(bytes));
  if (!text) return failure(file + ": " + text.error());
  return text;
}

void trim_line(std::string& line) {
  if (line.ends_with('\r')) line.pop_back();
  if (line.starts_with(kMark)) line.erase(0, kMark.size());
}

Result<std::string, std::string> read_first_line(const std::string& file) {
  constexpr std::size_t kBytesMax = std::size_t{64} << 10;
  auto text = read_text_file(file, kBytesMax);
  if (!text) return text;
  text->resize(std::min(text->find('\n'), text->size()));
  trim_line(*text);
  if (text->empty()) return failure(file + ": its first line is empty");
  return text;
}

std::string first_line_of(std::istream& in) {
  std::string line;
  for (char c = 0; line.size() < kFirstLineBytesMax && in.get(c) && c != '\n';) line += c;
  trim_line(line);
  return line;
}

}  // namespace runstone
