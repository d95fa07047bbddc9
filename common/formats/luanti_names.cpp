#include "common/formats/luanti_names.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "common/core/material_row.hpp"

namespace runstone {
namespace {

constexpr std::string_view kOwnMod = "runstone:";

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// Returns the value of a lower hexadecimal digit, or -1.
int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

}  // namespace

std::string luanti_node_name(std::string_view material) {
  const bool is_allowed = std::all_of(material.begin(), material.end(), [](char c) {
    return is_letter_or_digit(c) || c == '_' || c == ':';
  });
  if (is_allowed && material != "ignore" && !material.starts_with(kOwnMod))
    return std::string(material);
  std::string out(kOwnMod);
  for (const char c : material) {
    if (is_letter_or_digit(c)) {
      out += c;
    } else if (c == ' ') {
      out += "__";
    } else {
      const auto byte = static_cast<unsigned char>(c);
      out += '_';
      out += "0123456789abcdef"[byte >> 4];
      out += "0123456789abcdef"[byte & 15];
    }
  }
  return out;
}

std::optional<std::uint8_t> luanti_param2(std::string_view state) {
  if (!state.starts_with(kLuantiParam)) return std::nullopt;
  const std::string_view digits = state.substr(kLuantiParam.size());
  if (digits.empty() || digits.front() == '0') return std::nullopt;
  std::uint8_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

LuantiNode split_luanti_param2(std::string_view material) {
  const std::size_t open = material.rfind('[');
  if (open != std::string_view::npos && open > 0 && material.ends_with(']')) {
    const auto param2 = luanti_param2(material.substr(open + 1, material.size() - open - 2));
    const std::string_view name = material.substr(0, open);
    if (param2 && name != "air" && name != "ignore") return {std::string(name), *param2};
  }
  return {std::string(material), 0};
}

LuantiNode luanti_node_of(std::string_view material) {
  LuantiNode out = split_luanti_param2(material);
  out.name = luanti_node_name(out.name);
  return out;
}

std::optional<std::string> material_of_luanti_name(std::string_view node) {
  if (!node.starts_with(kOwnMod)) return std::nullopt;
  // Each byte of a material has at most three in a node.
  if (node.size() > kOwnMod.size() + 3 * kMaterialNameBytesMax) return std::nullopt;
  std::string out;
  for (std::size_t i = kOwnMod.size(); i < node.size(); ++i) {
    if (node[i] != '_') {
      out += node[i];
    } else if (i + 1 < node.size() && node[i + 1] == '_') {
      out += ' ';
      ++i;
    } else {
      if (i + 2 >= node.size()) return std::nullopt;
      const int high = digit_of(node[i + 1]), low = digit_of(node[i + 2]);
      if (high < 0 || low < 0) return std::nullopt;
      out += static_cast<char>(static_cast<unsigned char>(high << 4 | low));
      i += 2;
    }
  }
  const MaterialRow row{out};
  if (out == "air" || luanti_node_name(out) != node ||
      !validate_material(row.name, row.colour, row.visibility, row.body, row.look))
    return std::nullopt;
  return out;
}

}  // namespace runstone
