#include "common/formats/format.hpp"

#include <algorithm>

#include "common/formats/luanti_block.hpp"

namespace runstone {
namespace {

constexpr Format kFormats[] = {
    {"luanti", "map.sqlite", read_luanti_block, material_of_luanti_node},
};

}  // namespace

std::span<const Format> formats() { return kFormats; }

const Format* format_of_file(std::string_view path) {
  const auto* found =
      std::find_if(std::begin(kFormats), std::end(kFormats),
                   [&](const Format& format) { return path.ends_with(format.file_ending); });
  return found == std::end(kFormats) ? nullptr : found;
}

}  // namespace runstone
