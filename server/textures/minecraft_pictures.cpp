#include "server/textures/minecraft_pictures.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "common/formats/facing_words.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/os/private_file.hpp"
#include "common/shapes/shape_states.hpp"

namespace runstone {
namespace {

using Json = nlohmann::json;

/// The maximum bytes of one file, and of all files of a pack together.
constexpr std::size_t kJsonBytesMax = std::size_t{1} << 20,
                      kAllJsonBytesMax = std::size_t{64} << 20;
/// The maximum length of a chain of parent models, or of texture names that refer to each other.
constexpr int kChainMax = 16;
/// Lists and objects within each other. Deeper ones are left out of what was read.
constexpr int kJsonDepthMax = 64;
constexpr std::size_t kElementsMax = 256;

const Json kNoJson;

/// Returns the value of a key, or null.
const Json& at(const Json& object, const char* key) {
  if (!object.is_object()) return kNoJson;
  const auto found = object.find(key);
  return found == object.end() ? kNoJson : *found;
}

std::string text_at(const Json& object, const char* key) {
  const Json& value = at(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

/// Returns the text of a text, a number or a truth, and "" of everything else.
std::string plain_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_primitive() ? value.dump() : std::string();
}

/// Returns "minecraft/models/block/stone.json" of "minecraft:block/stone" or "block/stone".
std::string asset_path(const std::string& id, const std::string& kind, const std::string& ending) {
  const std::size_t colon = id.find(':');
  const std::string space = colon == std::string::npos ? "minecraft" : id.substr(0, colon);
  return space + "/" + kind + "/" + (colon == std::string::npos ? id : id.substr(colon + 1)) +
         ending;
}

/// Returns the first of several that the game chooses by chance.
const Json& first_of_list(const Json& value) {
  return value.is_array() ? (value.empty() ? kNoJson : value[0]) : value;
}

/// Returns true if no state is another one than "facing=east,half=bottom" says.
bool fits(std::string_view condition, const ShapeStates& states) {
  for (std::string_view left = condition; !left.empty();) {
    const std::size_t end = std::min(left.find(','), left.size());
    const std::string_view one = left.substr(0, end);
    left.remove_prefix(std::min(end + 1, left.size()));
    const std::size_t equal = one.find('=');
    if (equal == std::string_view::npos) continue;
    const std::string_view value = states.get(one.substr(0, equal));
    if (!value.empty() && value != one.substr(equal + 1)) return false;
  }
  return true;
}

/// Returns true if the states fit {"north": "true", "axis": "x|y"}, or the lists OR and AND of
/// such.
bool fits_when(const Json& when, const ShapeStates& states, int depth = 0) {
  if (!when.is_object() || depth > kChainMax) return true;
  for (const auto& [key, value] : when.items()) {
    if ((key == "OR" || key == "AND") && value.is_array()) {
      const auto fits_one = [&](const Json& one) { return fits_when(one, states, depth + 1); };
      if (key == "OR" ? std::ranges::none_of(value, fits_one)
                      : !std::ranges::all_of(value, fits_one))
        return false;
      continue;
    }
    const std::string wanted = plain_text(value);
    const std::string present(states.get(key));
    if (present.empty()) continue;
    if (("|" + wanted + "|").find("|" + present + "|") == std::string::npos) return false;
  }
  return true;
}

/// Turns a direction about x, as a variant does: north, down, south, up.
Direction turned_about_x(Direction d) {
  switch (d) {
    case Direction::neg_z:
      return Direction::neg_y;
    case Direction::neg_y:
      return Direction::pos_z;
    case Direction::pos_z:
      return Direction::pos_y;
    case Direction::pos_y:
      return Direction::neg_z;
    default:
      return d;
  }
}

int quarters_at(const Json& variant, const char* key) {
  const Json& value = at(variant, key);
  if (!value.is_number_integer()) return 0;
  const auto degrees = value.get<std::int64_t>();
  return degrees > 0 && degrees < 360 ? static_cast<int>(degrees / 90) : 0;
}

}  // namespace

Result<std::unique_ptr<PictureSource>, std::string> MinecraftPictures::open(
    const std::string& folder) {
  const std::string assets = folder + "/assets";
  auto pictures = files_below(assets, ".png");
  if (!pictures) return failure(pictures.error());
  auto texts = files_below(assets, ".json");
  if (!texts) return failure(texts.error());
  return std::unique_ptr<PictureSource>(
      std::make_unique<MinecraftPictures>(*std::move(pictures), *std::move(texts)));
}

const Json& MinecraftPictures::json_of(const std::string& path) {
  const auto known = read_.find(path);
  if (known != read_.end()) return known->second;
  const auto file = texts_.find(path);
  if (file == texts_.end()) return kNoJson;
  Json& json = read_[path];
  if (read_bytes_ > kAllJsonBytesMax) return json;
  if (const auto text = read_file(file->second, kJsonBytesMax)) {
    read_bytes_ += text->size();
    // The limit bounds the recursion of the functions that read the document.
    const auto is_shallow = [](int depth, Json::parse_event_t /*event*/, Json& /*value*/) {
      return depth <= kJsonDepthMax;
    };
    json = Json::parse(*text, is_shallow, false);
    if (json.is_discarded()) json = Json();
  }
  return json;
}

const Json& MinecraftPictures::variant_of(const std::string& name, std::string_view text) {
  const Json& block = json_of(asset_path(name, "blockstates", ".json"));
  const ShapeStates states(text);
  if (const Json& variants = at(block, "variants"); variants.is_object()) {
    for (const auto& [condition, variant] : variants.items()) {
      if (condition == "normal" || fits(condition, states)) return first_of_list(variant);
    }
  }
  if (const Json& parts = at(block, "multipart"); parts.is_array()) {
    for (const Json& part : parts) {
      if (fits_when(at(part, "when"), states)) return first_of_list(at(part, "apply"));
    }
  }
  return kNoJson;
}

std::string MinecraftPictures::texture_path(
    std::string text, const std::map<std::string, std::string>& textures) const {
  for (int step = 0; step < kChainMax && text.starts_with('#'); ++step) {
    const auto found = textures.find(text.substr(1));
    if (found == textures.end()) return {};
    text = found->second;
  }
  const auto file = pictures_.find(asset_path(text, "textures", ".png"));
  return file == pictures_.end() ? std::string() : file->second;
}

SidePictures MinecraftPictures::pictures_of_model(const std::string& model, bool is_cube) {
  std::map<std::string, std::string> textures;
  const Json* elements = &kNoJson;
  std::string name = model;
  for (int step = 0; step < kChainMax && !name.empty(); ++step) {
    const Json& json = json_of(asset_path(name, "models", ".json"));
    if (const Json& own = at(json, "textures"); own.is_object()) {
      for (const auto& [key, value] : own.items()) {
        const std::string text =
            value.is_string() ? value.get<std::string>() : text_at(value, "sprite");
        if (!text.empty()) textures.emplace(key, text);
      }
    }
    if (elements->is_null()) elements = &at(json, "elements");
    name = text_at(json, "parent");
  }
  SidePictures out;
  SidePicture any;
  const std::size_t count = elements->is_array() ? std::min(elements->size(), kElementsMax) : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Json& faces = at((*elements)[i], "faces");
    if (!faces.is_object()) continue;
    for (const auto& [side, face] : faces.items()) {
      const auto direction = direction_of_facing(side);
      const std::string path = texture_path(text_at(face, "texture"), textures);
      if (!direction || path.empty() || !out[*direction].layers.empty()) continue;
      out[*direction] = {{path}, at(face, "tintindex").is_number()};
      if (any.layers.empty()) any = out[*direction];
    }
  }
  if (any.layers.empty()) {
    const std::string path = texture_path("#particle", textures);
    if (!path.empty()) any.layers.push_back(path);
  } else if (is_cube) {
    return out;
  }
  // A model without sides, such as that of a chest, and a shape whose faces have other directions.
  for (SidePicture& side : out.of) {
    if (side.layers.empty()) side = any;
  }
  return out;
}

SidePictures MinecraftPictures::pictures_of(const MaterialInfo& material) {
  if (material.body == MaterialBody::liquid) return {};
  const auto block = block_of_minecraft_material(material.name);
  if (!block) return {};
  const Json& variant = variant_of(block->name, block->states);
  const std::string model = text_at(variant, "model");
  if (model.empty()) return {};
  const SidePictures upright = pictures_of_model(model, material.shape.is_cube());
  const int about_x = quarters_at(variant, "x"), about_y = quarters_at(variant, "y");
  SidePictures out;
  for (std::size_t side = 0; side < upright.of.size(); ++side) {
    auto to = static_cast<Direction>(side);
    for (int i = 0; i < about_x; ++i) to = turned_about_x(to);
    for (int i = 0; i < about_y; ++i) to = right_of(to);
    out[to] = upright.of[side];
  }
  return out;
}

}  // namespace runstone
