#include "common/model_reader/ply_head.hpp"

#include <array>
#include <charconv>
#include <optional>
#include <sstream>
#include <utility>

namespace runstone {
namespace {

constexpr std::size_t kHeadLinesMax = 10'000, kElementsMax = 64, kPropertiesMax = 256;

std::optional<PlyType> ply_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames = {{
      {"char", PlyType::i8},
      {"int8", PlyType::i8},
      {"uchar", PlyType::u8},
      {"uint8", PlyType::u8},
      {"short", PlyType::i16},
      {"int16", PlyType::i16},
      {"ushort", PlyType::u16},
      {"uint16", PlyType::u16},
      {"int", PlyType::i32},
      {"int32", PlyType::i32},
      {"uint", PlyType::u32},
      {"uint32", PlyType::u32},
      {"float", PlyType::f32},
      {"float32", PlyType::f32},
      {"double", PlyType::f64},
      {"float64", PlyType::f64},
  }};
  for (const auto& [known, type] : kNames) {
    if (known == name) return type;
  }
  return std::nullopt;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(std::move(word));
  return words;
}

Unexpected<std::string> bad_line(const std::string& line) {
  return failure("is no .ply: \"" + line + "\" stands in its head");
}

std::optional<PlyProperty> ply_property(const std::vector<std::string>& words) {
  PlyProperty property;
  property.is_list = words.size() == 5 && words[1] == "list";
  if (!property.is_list && words.size() != 3) return std::nullopt;
  const auto type = ply_type(words[words.size() - 2]);
  if (!type) return std::nullopt;
  if (property.is_list) {
    const auto count_type = ply_type(words[2]);
    if (!count_type) return std::nullopt;
    property.count_type = *count_type;
  }
  property.type = *type;
  property.name = words.back();
  return property;
}

}  // namespace

std::size_t ply_bytes(PlyType type) {
  switch (type) {
    case PlyType::i8:
    case PlyType::u8:
      return 1;
    case PlyType::i16:
    case PlyType::u16:
      return 2;
    case PlyType::i32:
    case PlyType::u32:
    case PlyType::f32:
      return 4;
    case PlyType::f64:
      break;
  }
  return 8;
}

Result<PlyHead, std::string> read_ply_head(const std::function<bool(std::string&)>& next_line) {
  PlyHead head;
  std::string line;
  if (!next_line(line) || line != "ply") return failure(std::string("is no .ply"));
  bool has_format = false;
  for (std::size_t lines = 0; lines < kHeadLinesMax && next_line(line); ++lines) {
    const std::vector<std::string> words = words_of(line);
    if (words.empty() || words[0] == "obj_info") continue;
    if (words[0] == "comment") {
      constexpr std::string_view kTexture = "TextureFile ";
      const std::size_t at = line.find(kTexture);
      if (at != std::string::npos && head.texture.empty())
        head.texture = line.substr(at + kTexture.size());
    } else if (words[0] == "format" && words.size() >= 2) {
      has_format = true;
      if (words[1] == "ascii")
        head.body = PlyBody::text;
      else if (words[1] == "binary_little_endian")
        head.body = PlyBody::little_endian;
      else if (words[1] == "binary_big_endian")
        head.body = PlyBody::big_endian;
      else
        return bad_line(line);
    } else if (words[0] == "element" && words.size() == 3 && head.elements.size() < kElementsMax) {
      PlyElement element{words[1], 0, {}};
      const char* const end = words[2].data() + words[2].size();
      const auto [at, wrong] = std::from_chars(words[2].data(), end, element.count);
      if (wrong != std::errc() || at != end) return bad_line(line);
      head.elements.push_back(std::move(element));
    } else if (words[0] == "property" && !head.elements.empty() &&
               head.elements.back().properties.size() < kPropertiesMax) {
      auto property = ply_property(words);
      if (!property) return bad_line(line);
      head.elements.back().properties.push_back(*std::move(property));
    } else if (words[0] == "end_header" && has_format) {
      return head;
    } else {
      return bad_line(line);
    }
  }
  return failure(std::string("ends within its head"));
}

}  // namespace runstone
