#include "common/model_reader/ply_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "common/model_reader/finite_model.hpp"
#include "common/model_reader/ply_head.hpp"
#include "common/model_reader/ply_source.hpp"
#include "common/model_reader/scene_materials.hpp"
#include "common/model_reader/texture_reader.hpp"

namespace runstone {
namespace {

/// The meaning of a property of a vertex. The values are indices of an array of numbers.
enum PlyRole : std::uint8_t { kX, kY, kZ, kRed, kGreen, kBlue, kAlpha, kU, kV, kNoRole };

PlyRole role_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, PlyRole>, 21> kNames = {{
      {"x", kX},
      {"y", kY},
      {"z", kZ},
      {"red", kRed},
      {"green", kGreen},
      {"blue", kBlue},
      {"alpha", kAlpha},
      {"r", kRed},
      {"g", kGreen},
      {"b", kBlue},
      {"a", kAlpha},
      {"diffuse_red", kRed},
      {"diffuse_green", kGreen},
      {"diffuse_blue", kBlue},
      {"diffuse_alpha", kAlpha},
      {"s", kU},
      {"t", kV},
      {"u", kU},
      {"v", kV},
      {"texture_u", kU},
      {"texture_v", kV},
  }};
  for (const auto& [known, role] : kNames) {
    if (known == name) return role;
  }
  return kNoRole;
}

/// Returns a number of a colour as a byte: floats are 0 .. 1, integers use their whole range.
std::uint8_t colour_byte(double value, PlyType type) {
  switch (type) {
    case PlyType::f32:
    case PlyType::f64:
      return unit_byte(static_cast<float>(value));
    case PlyType::i8:
      return unit_byte(static_cast<float>(value / 127));
    case PlyType::i16:
      return unit_byte(static_cast<float>(value / 32767));
    case PlyType::i32:
      return unit_byte(static_cast<float>(value / 2147483647.0));
    case PlyType::u16:
      return unit_byte(static_cast<float>(value / 65535));
    case PlyType::u32:
      return unit_byte(static_cast<float>(value / 4294967295.0));
    default:
      return unit_byte(static_cast<float>(value / 255));
  }
}

class PlyReading {
 public:
  PlyReading(const OpenedFile& file, const SceneRules& rules, ReaderNotices& notices)
      : source_(file), rules_(rules), notices_(notices) {}

  Result<void, std::string> run();
  const PlyHead& head() const { return head_; }
  Model& model() { return model_; }

 private:
  Result<void, std::string> check_sizes() const;
  Result<void, std::string> read_element(const PlyElement& element);
  Result<void, std::string> read_vertices(const PlyElement& element);
  Result<void, std::string> skip(const PlyProperty& property);
  Result<void, std::string> read_corners(const PlyProperty& property, bool is_strip);
  Result<void, std::string> add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  bool count_of(const PlyProperty& list, std::uint64_t& count);

  PlySource source_;
  const SceneRules& rules_;
  ReaderNotices& notices_;
  PlyHead head_;
  Model model_;
  std::uint64_t vertices_ = 0;  // of the head
};

Unexpected<std::string> ends_early(const std::string& element) {
  return failure("is damaged or ends early, in the element \"" + element + "\"");
}

/// Fails if the file is too short for what its head promises, before memory is taken for that.
Result<void, std::string> PlyReading::check_sizes() const {
  std::uint64_t left = source_.left();
  for (const PlyElement& element : head_.elements) {
    if (element.properties.empty()) continue;
    std::uint64_t least = 0;
    for (const PlyProperty& property : element.properties) {
      const PlyType first = property.is_list ? property.count_type : property.type;
      least += head_.body == PlyBody::text ? 2 : ply_bytes(first);
    }
    // The last number of a text needs no blank behind it.
    if (element.count > (left + 1) / least) {
      return failure("ends early: it promises " + std::to_string(element.count) + " of \"" +
                     element.name + "\"");
    }
    left -= std::min(left, element.count * least);
  }
  return {};
}

Result<void, std::string> PlyReading::run() {
  auto head = read_ply_head([this](std::string& line) { return source_.line(line); });
  if (!head) return failure(head.error());
  head_ = *std::move(head);
  source_.set_body(head_.body);
  if (const auto sized = check_sizes(); !sized) return sized;
  for (const PlyElement& element : head_.elements) {
    if (element.name == "vertex") vertices_ += element.count;
  }
  if (vertices_ == 0) return failure(std::string("has no vertex"));
  if (vertices_ > kModelVerticesMax) {
    return failure("has " + std::to_string(vertices_) + " vertices, and at most " +
                   std::to_string(kModelVerticesMax) + " are allowed");
  }
  for (const PlyElement& element : head_.elements) {
    if (const auto read = read_element(element); !read) return read;
  }
  return {};
}

Result<void, std::string> PlyReading::read_element(const PlyElement& element) {
  if (element.properties.empty()) return {};
  if (element.name == "vertex") return read_vertices(element);
  const bool is_strip = element.name == "tristrips";
  if (element.name == "edge" && element.count > 0) notices_.add("edges are left out");
  if (element.name == "face") {
    for (const PlyProperty& property : element.properties) {
      if (property.name == "texcoord") notices_.add("texture places of faces are left out");
      if (role_of(property.name) == kRed) notices_.add("colours of faces are left out");
    }
  }
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) {
      const bool is_corners =
          (is_strip || element.name == "face") && property.is_list &&
          (property.name == "vertex_indices" || property.name == "vertex_index");
      const auto read = is_corners ? read_corners(property, is_strip) : skip(property);
      if (!read) {
        if (read.error().empty()) return ends_early(element.name);
        return read;
      }
    }
  }
  return {};
}

Result<void, std::string> PlyReading::read_vertices(const PlyElement& element) {
  std::vector<PlyRole> roles;
  std::array<bool, kNoRole + 1> has{};
  for (const PlyProperty& property : element.properties) {
    roles.push_back(property.is_list ? kNoRole : role_of(property.name));
    has[roles.back()] = true;
  }
  if (!has[kX] || !has[kY] || !has[kZ]) return failure(std::string("has vertices without x, y, z"));
  const bool has_colours = has[kRed] && has[kGreen] && has[kBlue];
  const bool has_places = has[kU] && has[kV] && !head_.texture.empty();
  model_.positions.reserve(static_cast<std::size_t>(vertices_));
  if (has_colours) model_.colours.reserve(static_cast<std::size_t>(vertices_));
  if (has_places) model_.texture_places.reserve(static_cast<std::size_t>(vertices_));
  for (std::uint64_t i = 0; i < element.count; ++i) {
    std::array<float, kNoRole + 1> value{};
    ModelColour colour{255, 255, 255, 255};
    for (std::size_t k = 0; k < roles.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      if (property.is_list) {
        if (!skip(property)) return ends_early(element.name);
        continue;
      }
      double number = 0;
      if (!source_.number(property.type, number)) return ends_early(element.name);
      const PlyRole role = roles[k];
      if (role >= kRed && role <= kAlpha) colour[role - kRed] = colour_byte(number, property.type);
      value[role] = static_cast<float>(number);
    }
    model_.positions.push_back(turned(value[kX], value[kY], value[kZ], rules_.up));
    if (has_colours) model_.colours.push_back(colour);
    // Places count from below in these files.
    if (has_places) model_.texture_places.push_back({value[kU], 1 - value[kV]});
  }
  // Two elements of vertices with different properties: colours and places of all, or of none.
  if (model_.colours.size() != model_.positions.size()) model_.colours.clear();
  if (model_.texture_places.size() != model_.positions.size()) model_.texture_places.clear();
  return {};
}

bool PlyReading::count_of(const PlyProperty& list, std::uint64_t& count) {
  double number = 0;
  if (!source_.number(list.count_type, number)) return false;
  if (!(number >= 0 && number <= 4294967295.0) || number != std::floor(number)) return false;
  count = static_cast<std::uint64_t>(number);
  return true;
}

/// An empty error means that the file ends early.
Result<void, std::string> PlyReading::skip(const PlyProperty& property) {
  std::uint64_t count = 1;
  if (property.is_list && !count_of(property, count)) return failure(std::string());
  double ignored = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!source_.number(property.type, ignored)) return failure(std::string());
  }
  return {};
}

Result<void, std::string> PlyReading::add_triangle(std::uint32_t a, std::uint32_t b,
                                                   std::uint32_t c) {
  if (model_.triangles.size() >= rules_.triangles_max) {
    return failure("the file has more than the " + std::to_string(rules_.triangles_max) +
                   " triangles that are allowed");
  }
  model_.triangles.push_back({a, b, c});
  return {};
}

/// Reads the corners of a face, or of strips of triangles, which -1 divides. An empty error means that
/// the file ends early.
Result<void, std::string> PlyReading::read_corners(const PlyProperty& property, bool is_strip) {
  std::uint64_t count = 0;
  if (!count_of(property, count)) return failure(std::string());
  std::uint32_t first = 0, second = 0;  // of the next triangle
  std::uint64_t known = 0;              // corners of this face or strip so far
  for (std::uint64_t i = 0; i < count; ++i) {
    double number = 0;
    if (!source_.number(property.type, number)) return failure(std::string());
    if (is_strip && number == -1) {
      known = 0;
      continue;
    }
    if (!(number >= 0 && number < static_cast<double>(vertices_)) || number != std::floor(number))
      return failure(std::string("a face names a vertex that does not exist"));
    const auto corner = static_cast<std::uint32_t>(number);
    if (known >= 2) {
      // Every second triangle of a strip is turned.
      const bool is_turned = is_strip && known % 2 == 1;
      const auto added =
          is_turned ? add_triangle(second, first, corner) : add_triangle(first, second, corner);
      if (!added) return added;
    }
    if (known == 0) first = corner;
    if (known >= 2 && is_strip) first = second;
    if (known >= 1) second = corner;
    ++known;
  }
  return {};
}

}  // namespace

Result<Model, std::string> read_ply(const ModelFolder& folder, const SceneRules& rules,
                                    ReaderNotices& notices) {
  const auto file = folder.open(folder.name());
  if (!file) return failure(std::string(ModelFolder::words(file.error())));
  PlyReading reading(*file, rules, notices);
  if (const auto read = reading.run(); !read) return failure(read.error());
  Model& model = reading.model();
  if (!reading.head().texture.empty() && !model.triangles.empty()) {
    TextureReader textures(folder, model.textures, notices);
    const auto texture = textures.from_file(reading.head().texture, {});
    if (!texture) return failure(texture.error());
    if (*texture) {
      model.materials.push_back({"", {255, 255, 255, 255}, *texture});
      model.material_of.assign(model.triangles.size(), 0);
    }
  }
  if (model.textures.empty()) model.texture_places.clear();
  if (!leave_out_not_finite(model, notices))
    return failure(std::string("the places in the file are no finite numbers"));
  if (const auto valid = validate(model); !valid) return failure(std::string(valid.error().what));
  return std::move(model);
}

}  // namespace runstone
