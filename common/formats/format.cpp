#include "common/formats/format.hpp"

#include <algorithm>

#include "common/formats/luanti_block.hpp"

namespace runstone {
namespace {

constexpr Format kFormats[] = {
    {"luanti", "map.sqlite", read_luanti_block, material_of_luanti_node},
};

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool ends_with(std::string_view path, std::string_view ending) {
  if (path.size() < ending.size()) return false;
  path.remove_prefix(path.size() - ending.size());
  return std::equal(path.begin(), path.end(), ending.begin(),
                    [](char a, char b) { return lower(a) == lower(b); });
}

}  // namespace

std::span<const Format> formats() { return kFormats; }

const Format* format_of_file(std::string_view path) {
  const auto* found =
      std::find_if(std::begin(kFormats), std::end(kFormats),
                   [&](const Format& format) { return ends_with(path, format.file_ending); });
  return found == std::end(kFormats) ? nullptr : found;
}

}  // namespace runstone
