// Colours of another program's nodes. Names of minetest_game that occur in generated worlds were
// chosen by hand; other names get a colour from the words in them. No art of that game is used: a
// node is one flat colour.
#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "common/core/hash.hpp"
#include "common/formats/luanti_block.hpp"
#include "common/formats/luanti_names.hpp"
#include "common/formats/material_match.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/shape_names.hpp"
#include "common/materials/default_look.hpp"
#include "common/materials/look_on_shape.hpp"

namespace runstone {
namespace {

enum class Kind : std::uint8_t {
  solid,  // a whole cube
  clear,  // liquids and glass
  thin,   // plants, torches, rails: no cube, so empty unless requested
};

struct Look {
  std::string_view name;
  std::uint32_t rgb;
  Kind kind = Kind::solid;
  std::uint8_t alpha = 255;  // of clear nodes
};

constexpr Look kNodes[] = {
    {"default:stone", 0x88898c},
    {"default:cobble", 0x77777a},
    {"default:mossycobble", 0x66735a},
    {"default:stonebrick", 0x96979a},
    {"default:stone_block", 0x92949a},
    {"default:desert_stone", 0x93513a},
    {"default:desert_cobble", 0x854a37},
    {"default:sandstone", 0xd2bb84},
    {"default:silver_sandstone", 0xc3c1b8},
    {"default:obsidian", 0x1f1b2b},
    {"default:stone_with_coal", 0x55565a},
    {"default:stone_with_iron", 0xa68a78},
    {"default:stone_with_copper", 0xa87a55},
    {"default:stone_with_tin", 0xb2b5b9},
    {"default:stone_with_gold", 0xc7a957},
    {"default:stone_with_mese", 0xc4bd4a},
    {"default:stone_with_diamond", 0x84c4cc},
    {"default:dirt", 0x7a5638},
    {"default:dirt_with_grass", 0x679a3c},
    {"default:dirt_with_grass_footsteps", 0x5f8f39},
    {"default:dirt_with_dry_grass", 0xb39a4e},
    {"default:dirt_with_snow", 0xeff3f7},
    {"default:dirt_with_rainforest_litter", 0x6e5a2f},
    {"default:dirt_with_coniferous_litter", 0x7a6846},
    {"default:dry_dirt", 0x96724c},
    {"default:dry_dirt_with_dry_grass", 0xb8a152},
    {"default:permafrost", 0x6f6257},
    {"default:permafrost_with_stones", 0x787370},
    {"default:permafrost_with_moss", 0x6d7a4c},
    {"default:sand", 0xe1cf9a},
    {"default:desert_sand", 0xd3a268},
    {"default:silver_sand", 0xcdc9bd},
    {"default:sand_with_kelp", 0xd0c48e},
    {"default:gravel", 0x847d77},
    {"default:clay", 0xa5a9b8},
    {"default:snow", 0xf3f7fb},
    {"default:snowblock", 0xf1f5fa},
    {"default:ice", 0xb4d6ee, Kind::clear, 210},
    {"default:cave_ice", 0xa9cde8, Kind::clear, 210},
    {"default:water_source", 0x2b6ca8, Kind::clear, 168},
    {"default:water_flowing", 0x3a7db8, Kind::clear, 150},
    {"default:river_water_source", 0x2f7f9e, Kind::clear, 160},
    {"default:river_water_flowing", 0x3b8cab, Kind::clear, 150},
    {"default:lava_source", 0xf0661b},
    {"default:lava_flowing", 0xf57a26},
    {"default:glass", 0xd6ebf2, Kind::clear, 72},
    {"default:obsidian_glass", 0x3a3350, Kind::clear, 120},
    {"default:tree", 0x6b4f2f},
    {"default:jungletree", 0x5c4a33},
    {"default:pine_tree", 0x54402c},
    {"default:acacia_tree", 0x8a6a5c},
    {"default:aspen_tree", 0xd8d3c4},
    {"default:leaves", 0x3f7d2c},
    {"default:jungleleaves", 0x2f6b24},
    {"default:pine_needles", 0x27563a},
    {"default:acacia_leaves", 0x6f8f3a},
    {"default:aspen_leaves", 0x86ab3f},
    {"default:bush_leaves", 0x4a8234},
    {"default:acacia_bush_leaves", 0x7c9645},
    {"default:pine_bush_needles", 0x2f5f42},
    {"default:blueberry_bush_leaves", 0x3b7340},
    {"default:blueberry_bush_leaves_with_berries", 0x42647e},
    // The game draws it thin, but a bush would float without it.
    {"default:bush_stem", 0x6d5030},
    {"default:acacia_bush_stem", 0x7d6048},
    {"default:pine_bush_stem", 0x57432e},
    {"default:wood", 0xb5884f},
    {"default:junglewood", 0x7a5230},
    {"default:pine_wood", 0xd3b27c},
    {"default:acacia_wood", 0xb0603a},
    {"default:aspen_wood", 0xd9cda9},
    {"default:brick", 0xa24c3b},
    {"default:chest", 0x8f6230},
    {"default:furnace", 0x6b6c70},
    {"default:bookshelf", 0x8c6a43},
    {"default:cactus", 0x4c8a3a},
    {"default:meselamp", 0xfff2b8},
    {"default:grass_1", 0x7cb04a, Kind::thin},
    {"default:grass_2", 0x78ac47, Kind::thin},
    {"default:grass_3", 0x74a844, Kind::thin},
    {"default:grass_4", 0x70a441, Kind::thin},
    {"default:grass_5", 0x6ca03e, Kind::thin},
    {"default:dry_grass_1", 0xc8b265, Kind::thin},
    {"default:dry_grass_2", 0xc4ae61, Kind::thin},
    {"default:dry_grass_3", 0xc0aa5d, Kind::thin},
    {"default:dry_grass_4", 0xbca659, Kind::thin},
    {"default:dry_grass_5", 0xb8a255, Kind::thin},
    {"default:marram_grass_1", 0xa3b26a, Kind::thin},
    {"default:marram_grass_2", 0x9fae66, Kind::thin},
    {"default:marram_grass_3", 0x9baa62, Kind::thin},
    {"flowers:dandelion_white", 0xf0efe6, Kind::thin},
    {"flowers:dandelion_yellow", 0xf3d53a, Kind::thin},
    {"flowers:tulip", 0xf08a2c, Kind::thin},
    {"flowers:tulip_black", 0x34283c, Kind::thin},
    {"flowers:chrysanthemum_green", 0xa9cf5a, Kind::thin},
    {"flowers:geranium", 0x5a76cf, Kind::thin},
    {"flowers:rose", 0xc92a2f, Kind::thin},
    {"flowers:viola", 0x8a4fb0, Kind::thin},
    {"farming:cotton_wild", 0xe9e4d2, Kind::thin},
    {"butterflies:butterfly_red", 0xd0463a, Kind::thin},
    {"butterflies:butterfly_white", 0xf2f0ea, Kind::thin},
    {"butterflies:butterfly_violet", 0x8d5cb8, Kind::thin},
};

/// Colours of names that are not listed above. The first word found decides, so specific words
/// precede general ones.
constexpr Look kWords[] = {
    {"torch", 0xffd27a, Kind::thin},
    {"lantern", 0xffe2a0},
    {"lamp", 0xffe9ad},
    {"sapling", 0x5d8f3a, Kind::thin},
    {"ladder", 0x9b7444, Kind::thin},
    {"sign", 0xa27c4a, Kind::thin},
    {"rail", 0x8c8578, Kind::thin},
    {"butterfly", 0xd9a15a, Kind::thin},
    {"firefly", 0xe8e07a, Kind::thin},
    {"mushroom", 0xb58563, Kind::thin},
    {"flower", 0xd07fa0, Kind::thin},
    {"fern", 0x4f8a3c, Kind::thin},
    {"junglegrass", 0x4c8c34, Kind::thin},
    {"papyrus", 0x8fae58, Kind::thin},
    {"dry_shrub", 0x9a7b4e, Kind::thin},
    {"vine", 0x4b7f34, Kind::thin},
    {"kelp", 0x5e7a34, Kind::thin},
    {"flame", 0xf49a33, Kind::thin},
    {"fire:", 0xf49a33, Kind::thin},
    {"wire", 0xb0392f, Kind::thin},
    {"carpet", 0xb04a44, Kind::thin},
    {"straw", 0xd4b45a},
    {"hay", 0xd0b052},
    {"soil", 0x5f4129},
    {"farming:", 0x86a94a, Kind::thin},
    {"flowers:", 0xc98aa8, Kind::thin},
    {"water", 0x2f72ad, Kind::clear, 160},
    {"lava", 0xf0701f},
    {"glass", 0xd3e8f0, Kind::clear, 80},
    {"pane", 0xc9dfe8, Kind::clear, 90},
    {"ice", 0xb2d4ec, Kind::clear, 210},
    {"snow", 0xf1f5fa},
    {"leaves", 0x46812f},
    {"needles", 0x2c5b3c},
    {"bush", 0x4a8234},
    {"sandstone", 0xd0b980},
    {"obsidian", 0x221d2e},
    {"brick", 0x9c5242},
    {"cobble", 0x75767a},
    {"gravel", 0x857e78},
    {"clay", 0xa6a8b4},
    {"coral", 0xd9776b},
    {"wool", 0xd8d4cc},
    {"bed", 0xb2403a},
    {"stone", 0x8a8b8e},
    {"litter", 0x75612f},
    {"grass", 0x6a9c3f},
    {"moss", 0x657a43},
    {"dirt", 0x7c583a},
    {"sand", 0xddca95},
    {"diamond", 0x7fd0d8},
    {"gold", 0xecc04a},
    {"copper", 0xb9744a},
    {"bronze", 0xa9793f},
    {"steel", 0xc5c8cb},
    {"iron", 0xbfb8b0},
    {"mese", 0xe4dc4e},
    {"coal", 0x2d2d30},
    {"tin", 0xbcc2c8},
    {"wood", 0xb28750},
    {"plank", 0xb28750},
    {"fence", 0x9f7748},
    {"door", 0x9a7043},
    {"gate", 0x9a7043},
    {"chest", 0x8f6230},
    {"tree", 0x6a4f31},
    {"log", 0x6a4f31},
    {"trunk", 0x6a4f31},
};

// The alpha of thin nodes that are kept, which become see-through cubes.
constexpr std::uint8_t kThinAlpha = 176;

/// Returns the FNV-1a hash of a name, mixed. It is the same on every platform.
std::uint64_t hash_of(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return mix64(hash);
}

const Look* exact(std::string_view name) {
  const auto* found = std::find_if(std::begin(kNodes), std::end(kNodes),
                                   [&](const Look& l) { return l.name == name; });
  return found == std::end(kNodes) ? nullptr : found;
}

/// Returns the name of the material that "stairs:stair_inner_cobble" and similar nodes are made of.
std::optional<std::string> made_of(std::string_view name) {
  for (const std::string_view prefix :
       {"stairs:stair_inner_", "stairs:stair_outer_", "stairs:stair_", "stairs:slab_", "walls:"}) {
    if (name.starts_with(prefix)) return "default:" + std::string(name.substr(prefix.size()));
  }
  return std::nullopt;
}

/// Returns a pale to medium colour from the hash alone, for names without a known word.
std::uint32_t colour_of_hash(std::uint64_t hash) {
  std::uint32_t rgb = 0;
  for (int channel = 0; channel < 3; ++channel) {
    rgb = rgb << 8 | static_cast<std::uint32_t>(96 + (hash >> (8 * channel)) % 112);
  }
  return rgb;
}

Look look_of(std::string_view name) {
  if (const Look* found = exact(name)) return *found;
  if (const auto base = made_of(name)) {
    if (const Look* found = exact(*base)) return *found;
  }
  const std::uint64_t hash = hash_of(name);
  for (const Look& word : kWords) {
    if (name.find(word.name) == std::string_view::npos) continue;
    // The shade depends on the name, so that different nodes of one kind can be distinguished.
    Look look = word;
    look.rgb = 0;
    for (int shift = 16; shift >= 0; shift -= 8) {
      const int shade =
          static_cast<int>(word.rgb >> shift & 255) + static_cast<int>(hash >> shift & 15) - 8;
      look.rgb |= static_cast<std::uint32_t>(std::clamp(shade, 0, 255)) << shift;
    }
    return look;
  }
  return {name, colour_of_hash(hash), Kind::solid, 255};
}

/// Returns a material name made of any bytes. A changed name carries the hash of the original.
std::string material_name(std::string_view name) {
  const bool printable =
      std::all_of(name.begin(), name.end(), [](char c) { return c > 0x20 && c < 0x7f; });
  if (printable && !name.empty() && name.size() <= kMaterialNameBytesMax) return std::string(name);
  std::string out(name.substr(0, kMaterialNameBytesMax - 17));
  for (char& c : out) {
    if (c <= 0x20 || c >= 0x7f) c = '?';
  }
  out += '#';
  const std::uint64_t hash = hash_of(name);
  for (int shift = 60; shift >= 0; shift -= 4) out += "0123456789abcdef"[hash >> shift & 15];
  return out;
}

/// Returns the material of a node that was written by luanti_node_name(). Each of them was a voxel
/// of a world, so none is left out.
MaterialInfo written_material(const std::string& name) {
  const MaterialTable& built_in = default_material_table();
  MaterialInfo out;
  if (const auto known = built_in.find(name)) {
    out = built_in[*known];
    out.generation.reset();
    return out;
  }
  const auto block = block_of_minecraft_material(name);
  if (block && block->name.starts_with("minecraft:"))
    out = material_of_minecraft_block(*block, true);
  if (out.name.empty() || out.visibility == Visibility::empty) {
    const Look look = look_of(name);
    const bool is_clear = look.kind == Kind::clear;
    out = {};
    out.colour = {static_cast<std::uint8_t>(look.rgb >> 16),
                  static_cast<std::uint8_t>(look.rgb >> 8), static_cast<std::uint8_t>(look.rgb),
                  is_clear ? look.alpha : std::uint8_t{255}};
    out.visibility = is_clear ? Visibility::transparent : Visibility::opaque;
  }
  out.name = name;
  out.shape = shape_of_material_name(name).value_or(Shape{});
  out.look =
      out.look ? look_on_shape(*out.look, out.shape) : default_look(name, out.body, out.shape);
  return out;
}

/// Returns the material of a node. Without `has_shapes`, none has one.
MaterialInfo material_of_node(const ForeignBlock& node, bool keep_all, bool has_shapes) {
  const std::string& name = node.name;
  if (name == "air" || name == "ignore")
    return {"air", {0, 0, 0, 0}, Visibility::empty, std::nullopt};
  if (const auto own = material_of_luanti_name(name)) return written_material(*own);
  // No game of Luanti has nodes without the name of a mod.
  if (name.find(':') == std::string::npos && material_name(name) == name)
    return written_material(name);
  const Look look = look_of(name);
  MaterialInfo out;
  out.name =
      has_shapes ? node_material_name(material_name(name), node.states) : material_name(name);
  const std::optional<Shape> shape =
      has_shapes ? shape_of_material_name(out.name) : std::optional<Shape>();
  out.colour = {static_cast<std::uint8_t>(look.rgb >> 16), static_cast<std::uint8_t>(look.rgb >> 8),
                static_cast<std::uint8_t>(look.rgb), 255};
  switch (look.kind) {
    case Kind::solid:
      out.visibility = Visibility::opaque;
      break;
    case Kind::clear:
      out.visibility = Visibility::transparent;
      out.colour[3] = look.alpha;
      break;
    case Kind::thin:
      if (shape) {
        out.body = MaterialBody::passable;
        break;
      }
      out.visibility = keep_all ? Visibility::transparent : Visibility::empty;
      if (keep_all) out.body = MaterialBody::passable;
      out.colour[3] = kThinAlpha;
      break;
  }
  // Luanti's games name the two nodes of a liquid so.
  if (name.ends_with("_source") || name.ends_with("_flowing")) out.body = MaterialBody::liquid;
  if (shape && out.visibility != Visibility::empty) out.shape = *shape;
  // It is stored, so that every client draws the world alike.
  out.look = default_look(name, out.body, out.shape);
  return out;
}

}  // namespace

MaterialInfo material_of_luanti_node(const ForeignBlock& node, bool keep_all) {
  return material_of_node(node, keep_all, true);
}

MaterialInfo material_of_luanti_cube(const ForeignBlock& node, bool keep_all) {
  return material_of_node(node, keep_all, false);
}

bool keeps_luanti_param2(std::string_view name) {
  const auto has = [&](std::string_view word) { return name.find(word) != std::string_view::npos; };
  if (name.ends_with("_flowing") || has("kelp")) return false;
  const bool is_of_leaves = has("leaves") || has("needles");
  // Stairs of leaves have a direction.
  return !is_of_leaves || has("stair") || has("slab") || has("slope");
}

MaterialInfo material_of_luanti_world_node(const ForeignBlock& node, bool keep_all) {
  MaterialInfo out = material_of_luanti_node(node, keep_all);
  if (out.visibility != Visibility::empty && keeps_luanti_param2(node.name))
    out.name = world_name_of({row_of(out), node.states});
  return out;
}

}  // namespace runstone
