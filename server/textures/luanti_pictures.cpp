#include "server/textures/luanti_pictures.hpp"

#include <utility>

#include "common/formats/facing_words.hpp"
#include "common/os/private_file.hpp"
#include "common/shapes/shape_states.hpp"
#include "server/textures/lua_tokens.hpp"
#include "server/textures/picture_files.hpp"

namespace runstone {
namespace {

using Kind = LuaToken::Kind;

/// The maximum bytes of one file, and of all files of a game together.
constexpr std::size_t kLuaFileBytesMax = std::size_t{2} << 20, kLuaBytesMax = std::size_t{64} << 20;
constexpr std::size_t kTileBytesMax = 256;

bool opens(const LuaToken& token) {
  return token.is_sign("{") || token.is_sign("(") || token.is_sign("[");
}
bool closes(const LuaToken& token) {
  return token.is_sign("}") || token.is_sign(")") || token.is_sign("]");
}

/// Reads the list behind "tiles = {". A tile is a text, or a table whose text `name` it is.
std::array<std::string, 6> take_tiles(LuaTokens& tokens) {
  std::array<std::string, 6> tiles;
  std::size_t count = 0;
  std::string tile;
  bool is_plain = true, is_after_name = false;
  const auto finish = [&] {
    if (count < tiles.size() && is_plain && tile.size() <= kTileBytesMax) tiles[count] = tile;
    ++count;
    tile.clear();
    is_plain = true;
  };
  bool has_words = false;
  for (int depth = 1; depth > 0;) {
    const LuaToken token = tokens.next();
    if (token.kind == Kind::end) break;
    if (opens(token)) ++depth;
    if (closes(token)) --depth;
    if (depth == 0) break;
    if (depth == 1 && (token.is_sign(",") || token.is_sign(";"))) {
      if (has_words) finish();
      has_words = false;
      continue;
    }
    has_words = true;
    if (token.is_sign("..")) is_plain = false;
    if (token.kind == Kind::text && tile.empty() && (depth == 1 || is_after_name))
      tile = token.text;
    is_after_name = depth == 2 && ((token.kind == Kind::name && token.text == "name") ||
                                   (is_after_name && token.is_sign("=")) || token.is_sign("{"));
  }
  if (has_words) finish();
  if (count > tiles.size()) count = tiles.size();
  for (std::size_t i = count; count > 0 && i < tiles.size(); ++i) tiles[i] = tiles[count - 1];
  return tiles;
}

/// Passes the table of a definition, behind its "{", and returns its tiles.
std::optional<std::array<std::string, 6>> take_definition(LuaTokens& tokens) {
  std::optional<std::array<std::string, 6>> tiles;
  for (int depth = 1; depth > 0;) {
    const LuaToken token = tokens.next();
    if (token.kind == Kind::end) break;
    if (opens(token)) ++depth;
    if (closes(token)) --depth;
    const bool is_key = depth == 1 && token.kind == Kind::name &&
                        (token.text == "tiles" || token.text == "tile_images");
    if (!is_key || tiles) continue;
    if (!tokens.next().is_sign("=")) continue;
    const LuaToken open = tokens.next();
    if (open.is_sign("{")) tiles = take_tiles(tokens);
  }
  return tiles;
}

/// The direction of each tile of a node with a facedir of 0.
constexpr std::array<Direction, 6> kTileSides = {Direction::pos_y, Direction::neg_y,
                                                 Direction::pos_x, Direction::neg_x,
                                                 Direction::pos_z, Direction::neg_z};

/// Returns the direction in which each tile looks if the node has this facedir.
std::array<Direction, 6> turned_tiles(unsigned facedir) {
  std::array<Direction, 6> out = kTileSides;
  if (facedir >= 24) return out;
  const unsigned axis = facedir / 4, turn = facedir % 4;
  if (axis == 0) {
    // A quarter turns +z to +x, which is three turns to the right.
    for (unsigned i = 0; i < 3 * turn; ++i) {
      for (std::size_t tile = 2; tile < out.size(); ++tile) out[tile] = right_of(out[tile]);
    }
    return out;
  }
  // The node does not stand upright. The turn of the four sides around its top is ignored.
  constexpr std::array<Direction, 6> kTops = {Direction::pos_y, Direction::pos_z, Direction::neg_z,
                                              Direction::pos_x, Direction::neg_x, Direction::neg_y};
  out[0] = kTops[axis];
  out[1] = opposite(out[0]);
  std::size_t tile = 2;
  for (const Direction side : kTileSides) {
    if (axis_of(side) != axis_of(out[0])) out[tile++] = side;
  }
  return out;
}

}  // namespace

void scan_lua(std::string_view text, LuantiNodes& nodes) {
  LuaTokens tokens(text);
  for (LuaToken token = tokens.next(); token.kind != Kind::end; token = tokens.next()) {
    const bool is_node = token.kind == Kind::name && token.text == "register_node";
    const bool is_stair = token.kind == Kind::name && token.text == "register_stair_and_slab";
    if (!is_node && !is_stair) continue;
    if (!tokens.next().is_sign("(")) continue;
    LuaToken name = tokens.next();
    if (name.kind != Kind::text || name.text.empty() || !tokens.next().is_sign(",")) continue;
    if (nodes.tiles.size() + nodes.stairs.size() >= kLuantiNodesMax) return;
    if (name.text.front() == ':') name.text.erase(0, 1);
    const LuaToken second = tokens.next();
    if (is_stair) {
      if (second.kind == Kind::text) nodes.stairs.emplace(name.text, second.text);
    } else if (second.is_sign("{")) {
      if (auto tiles = take_definition(tokens)) nodes.tiles.emplace(name.text, *std::move(tiles));
    }
  }
}

Result<std::unique_ptr<PictureSource>, std::string> LuantiPictures::open(
    const std::string& folder) {
  const auto pictures = files_below(folder, ".png");
  if (!pictures) return failure(pictures.error());
  const auto scripts = files_below(folder, ".lua");
  if (!scripts) return failure(scripts.error());
  std::map<std::string, std::string> files;
  for (const auto& [name, path] : *pictures) {
    if (name.starts_with("textures/") || name.find("/textures/") != std::string::npos)
      files.emplace(stem_of(name) + ".png", path);
  }
  LuantiNodes nodes;
  std::size_t bytes = 0;
  for (const auto& [name, path] : *scripts) {
    const auto text = read_file(path, kLuaFileBytesMax);
    if (!text) continue;  // a file of such a size defines no nodes by hand
    bytes += text->size();
    if (bytes > kLuaBytesMax) return failure(folder + ": has more than 64 MiB of Lua");
    scan_lua(*text, nodes);
  }
  return std::unique_ptr<PictureSource>(
      std::make_unique<LuantiPictures>(std::move(files), std::move(nodes)));
}

const std::array<std::string, 6>* LuantiPictures::tiles_of(const std::string& node) const {
  const auto found = nodes_.tiles.find(node);
  if (found != nodes_.tiles.end()) return &found->second;
  const std::size_t colon = node.find(':');
  if (colon == std::string::npos) return nullptr;
  for (const std::string_view kind : {"slab_", "stair_inner_", "stair_outer_", "stair_"}) {
    if (node.compare(colon + 1, kind.size(), kind) != 0) continue;
    const auto base = nodes_.stairs.find(node.substr(colon + 1 + kind.size()));
    if (base == nodes_.stairs.end()) continue;
    const auto tiles = nodes_.tiles.find(base->second);
    if (tiles != nodes_.tiles.end()) return &tiles->second;
  }
  return nullptr;
}

SidePicture LuantiPictures::picture_of(const std::string& tile) const {
  SidePicture out;
  // Layers above the last one that is taken are left out.
  for (std::string_view left = tile; !left.empty() && out.layers.size() < kPictureLayersMax;) {
    const std::size_t end = std::min(left.find('^'), left.size());
    std::string_view part = left.substr(0, end);
    left.remove_prefix(std::min(end + 1, left.size()));
    while (part.starts_with('(')) part.remove_prefix(1);
    while (part.ends_with(')')) part.remove_suffix(1);
    const auto found = files_.find(std::string(part));
    if (found == files_.end()) break;
    out.layers.push_back(found->second);
  }
  return out;
}

SidePictures LuantiPictures::pictures_of(const MaterialInfo& material) {
  SidePictures out;
  if (material.body == MaterialBody::liquid) return out;
  const std::string_view name = material.name;
  const auto* tiles = tiles_of(std::string(name.substr(0, name.find('['))));
  if (tiles == nullptr) return out;
  const unsigned facedir = ShapeStates(states_in_name(name)).number("param2", 0) % 32;
  const std::array<Direction, 6> sides = turned_tiles(facedir);
  for (std::size_t tile = 0; tile < sides.size(); ++tile)
    out[sides[tile]] = picture_of((*tiles)[tile]);
  return out;
}

}  // namespace runstone
