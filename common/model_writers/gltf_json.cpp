#include <algorithm>
#include <string>
#include <string_view>
#include <unordered_map>

#include "common/core/version.hpp"
#include "common/model_writers/gltf_layout.hpp"
#include "common/model_writers/linear_colour.hpp"

namespace runstone {
namespace {

// Numbers that glTF defines.
constexpr int kGltfArrayBuffer = 34962, kGltfIndexBuffer = 34963;
constexpr int kGltfI8 = 5120, kGltfU8 = 5121, kGltfU16 = 5123, kGltfU32 = 5125, kGltfF32 = 5126;

void write_json_text(std::string_view text, ModelOutput& out) {
  constexpr char kHex[] = "0123456789abcdef";
  out.text("\"");
  std::size_t begin = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c >= 0x20 && c != '"' && c != '\\') continue;
    out.text(text.substr(begin, i - begin));
    const char escape[] = {'\\', 'u', '0', '0', kHex[c >> 4], kHex[c & 15]};
    out.text({escape, sizeof escape});
    begin = i + 1;
  }
  out.text(text.substr(begin));
  out.text("\"");
}

class GltfJson {
 public:
  GltfJson(const WrittenBuild& source, const ModelWriting& writing, const GltfLayout& layout,
           ModelOutput& out)
      : source_(source), writing_(writing), layout_(layout), out_(out) {}

  void write() {
    out_.text(R"({"asset":{"version":"2.0","generator":"Runstone )");
    out_.text(version());
    out_.text("\"},");
    write_extensions();
    out_.text(R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[)");
    for (std::size_t level = 0; level < layout_.level_ends.size(); ++level) write_level(level);
    out_.text("],\"meshes\":[");
    for (const GltfRegion& region : layout_.regions) write_mesh(region);
    out_.text("],\"materials\":[");
    write_materials();
    out_.text("],\"accessors\":[");
    for (std::size_t i = 0; i < layout_.regions.size(); ++i) write_accessors(i);
    out_.text("],\"bufferViews\":[");
    write_views();
    out_.text(R"(],"buffers":[{"byteLength":)");
    out_.number(layout_.buffer_bytes);
  }

 private:
  template <class T, class... More>
  void numbers(T first, More... more) {
    out_.text("[");
    out_.number(first);
    ((out_.text(","), out_.number(more)), ...);
    out_.text("]");
  }
  /// Writes a place, which is in sixteenths of a voxel, in this many of them.
  void corner(const Corner& at, double units) {
    numbers(at[0] / units, at[1] / units, at[2] / units);
  }

  bool has_levels() const { return layout_.level_ends.size() > 1; }
  std::size_t first_region(std::size_t level) const {
    return level == 0 ? 0 : layout_.level_ends[level - 1];
  }
  /// Returns the node of a level, which is the parent of its regions. They follow it.
  std::size_t node_of(std::size_t level) const { return first_region(level) + level; }

  void write_extensions() {
    if (writing_.is_quantised || has_levels()) {
      out_.text("\"extensionsUsed\":[");
      if (writing_.is_quantised) out_.text("\"KHR_mesh_quantization\"");
      if (writing_.is_quantised && has_levels()) out_.text(",");
      if (has_levels()) out_.text("\"MSFT_lod\"");
      out_.text("],");
    }
    if (writing_.is_quantised) out_.text(R"("extensionsRequired":["KHR_mesh_quantization"],)");
  }
  void write_level(std::size_t level) {
    out_.text(level == 0 ? "{" : ",{");
    if (level != 0 || !source_.info.name.empty()) {
      out_.text("\"name\":");
      write_json_text(source_.info.name + (level == 0 ? "" : " level " + std::to_string(level)),
                      out_);
      out_.text(",");
    }
    const double scale = writing_.metres_per_voxel * static_cast<double>(1U << level);
    if (scale != 1) {
      out_.text("\"scale\":");
      numbers(scale, scale, scale);
      out_.text(",");
    }
    out_.text("\"children\":[");
    const std::size_t regions = layout_.level_ends[level] - first_region(level);
    for (std::size_t i = 1; i <= regions; ++i) {
      if (i != 1) out_.text(",");
      out_.number(node_of(level) + i);
    }
    out_.text("]");
    if (level == 0) write_root_members();
    out_.text("}");
    for (std::size_t i = first_region(level); i < layout_.level_ends[level]; ++i) write_node(i);
  }
  /// Writes the levels of detail of the root, and its extras.
  void write_root_members() {
    if (has_levels()) {
      out_.text(R"(,"extensions":{"MSFT_lod":{"ids":[)");
      for (std::size_t level = 1; level < layout_.level_ends.size(); ++level) {
        if (level != 1) out_.text(",");
        out_.number(node_of(level));
      }
      out_.text("]}}");
    }
    out_.text(",\"extras\":{");
    if (has_levels()) write_coverages();
    const VoxelPos& origin = source_.info.origin;
    const VoxelPos sides = source_.build.sides();
    out_.text(R"("runstone":{"origin":)");
    numbers(origin.x, origin.y, origin.z);
    out_.text(",\"sides\":");
    numbers(sides.x, sides.y, sides.z);
    if (!source_.info.author.empty()) {
      out_.text(",\"author\":");
      write_json_text(source_.info.author, out_);
    }
    if (source_.info.created_us != 0) {
      out_.text(",\"created_us\":");
      out_.number(source_.info.created_us);
    }
    out_.text("}}");
  }
  /// Writes for each level the least share of the screen's area with which it is shown. The first
  /// coarser one begins where its voxels are two lines high on a screen of 1,024 lines, and at the
  /// latest with half of the screen. Each further one begins with a quarter of that area, so that
  /// its voxels are as high there. The last one is never hidden.
  void write_coverages() {
    const VoxelPos sides = source_.build.sides();
    const double height = std::max({sides.x, sides.y, sides.z}) / 1024.0;
    double coverage = std::min(0.5, height * height);
    out_.text("\"MSFT_screencoverage\":[");
    for (std::size_t level = 1; level < layout_.level_ends.size(); ++level) {
      out_.rounded(coverage);
      out_.text(",");
      coverage /= 4;
    }
    out_.text("0],");
  }
  void write_node(std::size_t i) {
    const VoxelPos& at = layout_.regions[i].origin;
    out_.text(R"(,{"name":"region )");
    out_.number(at.x);
    out_.text(" ");
    out_.number(at.y);
    out_.text(" ");
    out_.number(at.z);
    out_.text(R"(","translation":)");
    numbers(at.x, at.y, at.z);
    if (writing_.is_quantised && layout_.regions[i].is_fine) {
      out_.text(",\"scale\":");
      constexpr double kSixteenth = 1.0 / kShapeUnits;
      numbers(kSixteenth, kSixteenth, kSixteenth);
    }
    out_.text(",\"mesh\":");
    out_.number(i);
    out_.text("}");
  }
  void write_mesh(const GltfRegion& region) {
    out_.text(region.first_part == 0 ? "" : ",");
    out_.text("{\"primitives\":[");
    for (std::size_t k = 0; k < region.part_count; ++k) {
      const std::size_t part = region.first_part + k;
      out_.text(k == 0 ? "" : ",");
      out_.text(R"({"attributes":{"POSITION":)");
      out_.number(3 * part);
      out_.text(",\"NORMAL\":");
      out_.number(3 * part + 1);
      out_.text("},\"indices\":");
      out_.number(3 * part + 2);
      out_.text(",\"material\":");
      const std::uint16_t number = layout_.parts[part].number;
      out_.number(materials_.try_emplace(number, materials_.size()).first->second);
      if (materials_.size() > order_.size()) order_.push_back(number);
      out_.text("}");
    }
    out_.text("]}");
  }
  /// Writes the materials that occur, in the order of their first primitive.
  void write_materials() {
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const WrittenMaterial& material = source_.materials[order_[i] - 1U];
      const MaterialColour& colour = material.colour;
      const auto light = [&](double share) {
        for (std::size_t k = 0; k < 3; ++k) {
          out_.text(k == 0 ? "" : ",");
          out_.rounded(linear_share(colour[k]) * share);
        }
      };
      out_.text(i == 0 ? "{" : ",{");
      out_.text("\"name\":");
      write_json_text(material.name, out_);
      out_.text(R"(,"pbrMetallicRoughness":{"baseColorFactor":[)");
      light(1);
      out_.text(",");
      out_.rounded(colour[3] / 255.0);
      out_.text(R"(],"metallicFactor":0,"roughnessFactor":)");
      out_.rounded(material.look.roughness / 100.0);
      out_.text("}");
      if (material.look.emission > 0) {
        out_.text(",\"emissiveFactor\":[");
        light(material.look.emission / 100.0);
        out_.text("]");
      }
      if (material.visibility == Visibility::transparent) out_.text(R"(,"alphaMode":"BLEND")");
      if (material.shape.form == ShapeForm::crossed) out_.text(R"(,"doubleSided":true)");
      out_.text("}");
    }
  }
  void write_accessors(std::size_t i) {
    const GltfRegion& region = layout_.regions[i];
    const bool is_quantised = writing_.is_quantised;
    const GltfVertex vertex = gltf_vertex(is_quantised, region.is_fine);
    const int place_type = !is_quantised ? kGltfF32 : region.is_fine ? kGltfU16 : kGltfU8;
    const double place_units = is_quantised && region.is_fine ? 1 : kShapeUnits;
    std::uint64_t vertices_at = 0, indices_at = 0;
    const auto accessor = [&](std::size_t view, std::uint64_t at, int type, std::uint32_t count) {
      out_.text("{\"bufferView\":");
      out_.number(view);
      out_.text(",\"byteOffset\":");
      out_.number(at);
      out_.text(",\"componentType\":");
      out_.number(type);
      out_.text(",\"count\":");
      out_.number(count);
    };
    for (std::size_t k = 0; k < region.part_count; ++k) {
      const GltfPart& part = layout_.parts[region.first_part + k];
      out_.text(region.first_part + k == 0 ? "" : ",");
      accessor(2 * i, vertices_at, place_type, part.vertices);
      out_.text(R"(,"type":"VEC3","min":)");
      corner(part.min, place_units);
      out_.text(",\"max\":");
      corner(part.max, place_units);
      out_.text("},");
      accessor(2 * i, vertices_at + vertex.normal_at, is_quantised ? kGltfI8 : kGltfF32,
               part.vertices);
      out_.text(is_quantised ? R"(,"normalized":true,"type":"VEC3"},)" : R"(,"type":"VEC3"},)");
      accessor(2 * i + 1, indices_at, part.index_bytes() == 2 ? kGltfU16 : kGltfU32, part.indices);
      out_.text(R"(,"type":"SCALAR"})");
      vertices_at += std::uint64_t{part.vertices} * vertex.bytes;
      indices_at += part.indices_bytes();
    }
  }
  void write_views() {
    std::uint64_t at = 0;
    const auto view = [&](std::uint64_t bytes) {
      out_.text(at == 0 ? "" : ",");
      out_.text(R"({"buffer":0,"byteOffset":)");
      out_.number(at);
      out_.text(",\"byteLength\":");
      out_.number(bytes);
      at += bytes;
    };
    for (const GltfRegion& region : layout_.regions) {
      view(region.vertices_bytes);
      out_.text(",\"byteStride\":");
      out_.number(gltf_vertex(writing_.is_quantised, region.is_fine).bytes);
      out_.text(",\"target\":");
      out_.number(kGltfArrayBuffer);
      out_.text("}");
      view(region.indices_bytes);
      out_.text(",\"target\":");
      out_.number(kGltfIndexBuffer);
      out_.text("}");
    }
  }

  const WrittenBuild& source_;
  const ModelWriting& writing_;
  const GltfLayout& layout_;
  ModelOutput& out_;
  std::unordered_map<std::uint16_t, std::size_t> materials_;  // their places in the list, by number
  std::vector<std::uint16_t> order_;
};

}  // namespace

void write_gltf_json(const WrittenBuild& source, const ModelWriting& writing,
                     const GltfLayout& layout, ModelOutput& out) {
  GltfJson(source, writing, layout, out).write();
}

}  // namespace runstone
