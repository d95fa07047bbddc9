#include "common/models/model_format.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace runstone {
namespace {

constexpr std::array<std::pair<std::string_view, ModelFormat>, 5> kModelEndings = {{
    {".obj", ModelFormat::obj},
    {".stl", ModelFormat::stl},
    {".ply", ModelFormat::ply},
    {".gltf", ModelFormat::gltf},
    {".glb", ModelFormat::glb},
}};

bool is_same_letter(char a, char b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return lower(a) == lower(b);
}

}  // namespace

std::optional<ModelFormat> model_format_of(std::string_view path) {
  for (const auto& [ending, format] : kModelEndings) {
    if (path.size() > ending.size() &&
        std::equal(ending.rbegin(), ending.rend(), path.rbegin(), is_same_letter))
      return format;
  }
  return std::nullopt;
}

ModelUp usual_up(ModelFormat format) {
  return format == ModelFormat::stl || format == ModelFormat::ply ? ModelUp::z : ModelUp::y;
}

}  // namespace runstone
