#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "tests/support/model_writers/written_model.hpp"

namespace runstone::test {
namespace {

using Json = nlohmann::json;

void gltf_rule(bool holds, const char* rule) {
  if (!holds) throw std::runtime_error(std::string("glTF: ") + rule);
}

template <class T>
T gltf_value(const Bytes& bytes, std::size_t at) {
  gltf_rule(at + sizeof(T) <= bytes.size(), "a value lies outside of the bytes");
  T v;
  std::memcpy(&v, bytes.data() + at, sizeof v);
  return v;
}

/// A number of the table of component types.
double gltf_component(const Bytes& buffer, std::size_t at, int type) {
  switch (type) {
    case 5120:
      return gltf_value<std::int8_t>(buffer, at);
    case 5121:
      return gltf_value<std::uint8_t>(buffer, at);
    case 5123:
      return gltf_value<std::uint16_t>(buffer, at);
    case 5125:
      return gltf_value<std::uint32_t>(buffer, at);
    case 5126:
      return gltf_value<float>(buffer, at);
  }
  throw std::runtime_error("glTF: unknown component type");
}

std::size_t gltf_component_bytes(int type) { return type <= 5121 ? 1 : type <= 5123 ? 2 : 4; }

class GltfReader {
 public:
  GltfReader(Json json, Bytes buffer) : json_(std::move(json)), buffer_(std::move(buffer)) {}

  WrittenModel read() {
    gltf_rule(json_.at("asset").at("version") == "2.0", "version");
    const Json& buffers = json_.at("buffers");
    gltf_rule(buffers.size() == 1 && buffers[0].at("byteLength") == buffer_.size(), "byteLength");
    for (const Json& material : json_.at("materials")) {
      out_.material_names.push_back(material.value("name", ""));
      gltf_rule(material.at("pbrMetallicRoughness").at("metallicFactor") == 0, "metallicFactor");
    }
    out_.node_count = json_.at("nodes").size();
    for (const Json& node : json_.at("scenes").at(json_.at("scene").get<std::size_t>()).at("nodes"))
      visit(node, {0, 0, 0}, 1);
    read_levels();
    gltf_rule(visited_ == out_.node_count, "a node is in no scene and no level");
    return std::move(out_);
  }

 private:
  void read_levels() {
    const Json& root = json_["nodes"].at(json_["scenes"][0]["nodes"].at(0).get<std::size_t>());
    const bool is_named =
        json_.value("extensionsUsed", Json::array()).dump().find("MSFT_lod") != std::string::npos;
    gltf_rule(is_named == root.contains("extensions"), "MSFT_lod is not in extensionsUsed");
    if (!is_named) return;
    const Json& ids = root.at("extensions").at("MSFT_lod").at("ids");
    const Json& coverages = root.at("extras").at("MSFT_screencoverage");
    gltf_rule(!ids.empty() && coverages.size() == ids.size() + 1, "coverages");
    for (std::size_t i = 0; i < ids.size(); ++i) {
      gltf_rule(coverages[i] > coverages[i + 1] && coverages[i] <= 1, "coverages do not descend");
      WrittenModel finest = std::exchange(out_, {});
      visit(ids[i], {0, 0, 0}, 1);
      finest.levels.push_back(std::exchange(out_, {}));
      out_ = std::move(finest);
    }
    gltf_rule(coverages.back() == 0, "the last level is hidden");
  }
  void visit(const Json& number, ModelPlace at, double scale) {
    ++visited_;
    const Json& node = json_.at("nodes").at(number.get<std::size_t>());
    if (node.contains("translation")) {
      for (std::size_t i = 0; i < 3; ++i) at[i] += scale * node["translation"].at(i).get<double>();
    }
    if (node.contains("scale")) scale *= node["scale"].at(0).get<double>();
    if (node.contains("mesh")) {
      for (const Json& primitive :
           json_.at("meshes").at(node["mesh"].get<std::size_t>()).at("primitives"))
        read_primitive(primitive, at, scale);
    }
    if (!node.contains("children")) return;
    gltf_rule(!node["children"].empty(), "an empty list");
    for (const Json& child : node["children"]) visit(child, at, scale);
  }

  /// Returns the numbers of an accessor, and checks its place and bounds.
  std::vector<double> numbers(std::size_t index, std::size_t count, int target) {
    const Json& accessor = json_.at("accessors").at(index);
    const Json& view = json_.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const int type = accessor.at("componentType");
    const std::size_t size = gltf_component_bytes(type);
    const std::size_t view_at = view.value("byteOffset", std::size_t{0});
    const std::size_t view_bytes = view.at("byteLength");
    gltf_rule(view.at("target") == target, "target");
    gltf_rule(view_at + view_bytes <= buffer_.size(), "a view leaves the buffer");
    const std::size_t stride = view.value("byteStride", size * count);
    if (target == 34962) gltf_rule(stride % 4 == 0 && stride >= 4 && stride <= 252, "byteStride");
    const std::size_t at = accessor.value("byteOffset", std::size_t{0});
    gltf_rule(at % size == 0 && (view_at + at) % size == 0, "an accessor is not aligned");
    if (target == 34962) gltf_rule(at % 4 == 0, "an attribute is not aligned");
    const std::size_t elements = accessor.at("count");
    gltf_rule(elements > 0, "an accessor is empty");
    gltf_rule(at + stride * (elements - 1) + size * count <= view_bytes, "an accessor is too long");
    gltf_rule(accessor.at("type") == (count == 3 ? "VEC3" : "SCALAR"), "type");
    const bool is_small = type >= 5120 && type <= 5123;
    if (count == 3 && is_small) {
      gltf_rule(json_.at("extensionsRequired").at(0) == "KHR_mesh_quantization", "extension");
      gltf_rule(json_.at("extensionsUsed").at(0) == "KHR_mesh_quantization", "extension");
    } else if (count == 3) {
      gltf_rule(type == 5126, "a vector is no float");
    }
    const double unit = accessor.value("normalized", false) ? 127 : 1;
    std::vector<double> out;
    for (std::size_t i = 0; i < elements; ++i) {
      for (std::size_t k = 0; k < count; ++k)
        out.push_back(gltf_component(buffer_, view_at + at + stride * i + size * k, type) / unit);
    }
    if (accessor.contains("min")) {
      for (std::size_t k = 0; k < count; ++k) {
        double low = out[k], high = out[k];
        for (std::size_t i = k; i < out.size(); i += count) {
          low = std::min(low, out[i]);
          high = std::max(high, out[i]);
        }
        gltf_rule(accessor.at("min").at(k) == low && accessor.at("max").at(k) == high, "min, max");
      }
    }
    if (target == 34963) {
      const double restart = type == 5123 ? 65'535.0 : 4'294'967'295.0;
      for (const double v : out) gltf_rule(v != restart, "an index is the restart value");
    }
    return out;
  }

  std::string colour_of(const Json& material) const {
    std::string out;
    for (std::size_t i = 0; i < 4; ++i) {
      double v = material.at("pbrMetallicRoughness").at("baseColorFactor").at(i);
      if (i < 3) v = v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
      out += (i == 0 ? "" : " ") + std::to_string(std::lround(v * 255));
    }
    return out;
  }

  void read_primitive(const Json& primitive, const ModelPlace& at, double scale) {
    gltf_rule(primitive.value("mode", 4) == 4, "mode");
    const Json& attributes = primitive.at("attributes");
    gltf_rule(json_["accessors"].at(attributes.at("POSITION").get<std::size_t>()).contains("min"),
              "positions have no min");
    const auto places = numbers(attributes.at("POSITION"), 3, 34962);
    const auto normals = numbers(attributes.at("NORMAL"), 3, 34962);
    const auto indices = numbers(primitive.at("indices"), 1, 34963);
    gltf_rule(places.size() == normals.size(), "attributes have different counts");
    gltf_rule(indices.size() % 3 == 0, "indices of no triangle");
    const Json& material = json_.at("materials").at(primitive.at("material").get<std::size_t>());
    const std::string colour = colour_of(material);
    const bool is_blended = material.value("alphaMode", "OPAQUE") == "BLEND";
    const bool is_double_sided = material.value("doubleSided", false);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      WrittenTriangle triangle;
      triangle.colour = colour;
      triangle.is_blended = is_blended;
      triangle.is_double_sided = is_double_sided;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto vertex = static_cast<std::size_t>(indices[i + k]);
        gltf_rule(vertex < places.size() / 3, "an index names no vertex");
        triangle.vertices[k] = out_.vertex_count + vertex;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          triangle.places[k][axis] = at[axis] + scale * places[3 * vertex + axis];
          if (k != 0)
            gltf_rule(triangle.normal[axis] == normals[3 * vertex + axis], "normals differ");
          triangle.normal[axis] = normals[3 * vertex + axis];
        }
      }
      out_.triangles.push_back(triangle);
    }
    out_.vertex_count += places.size() / 3;
  }

  Json json_;
  Bytes buffer_;
  WrittenModel out_;
  std::size_t visited_ = 0;
};

Bytes decoded_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  gltf_rule(text.size() % 4 == 0, "base64 is not in groups of four");
  Bytes out;
  for (std::size_t i = 0; i < text.size(); i += 4) {
    std::uint32_t bits = 0;
    std::size_t count = 3;
    for (std::size_t k = 0; k < 4; ++k) {
      if (text[i + k] == '=') {
        gltf_rule(i + 4 == text.size() && k >= 2, "base64 ends early");
        count = std::min(count, k - 1);
        bits <<= 6;
        continue;
      }
      const std::size_t digit = digits.find(text[i + k]);
      gltf_rule(digit != std::string::npos, "no digit of base64");
      bits = bits << 6 | static_cast<std::uint32_t>(digit);
    }
    for (std::size_t k = 0; k < count; ++k)
      out.push_back(static_cast<std::uint8_t>(bits >> (16 - 8 * k)));
  }
  return out;
}

}  // namespace

WrittenModel read_written_glb(const Bytes& file) {
  gltf_rule(gltf_value<std::uint32_t>(file, 0) == 0x46546C67, "magic");
  gltf_rule(gltf_value<std::uint32_t>(file, 4) == 2, "version");
  gltf_rule(gltf_value<std::uint32_t>(file, 8) == file.size(), "length");
  const std::size_t json_bytes = gltf_value<std::uint32_t>(file, 12);
  gltf_rule(json_bytes % 4 == 0, "the JSON is not aligned");
  gltf_rule(gltf_value<std::uint32_t>(file, 16) == 0x4E4F534A, "the first chunk is no JSON");
  const std::size_t second = 20 + json_bytes;
  const std::size_t buffer_bytes = gltf_value<std::uint32_t>(file, second);
  gltf_rule(buffer_bytes % 4 == 0, "the buffer is not aligned");
  gltf_rule(gltf_value<std::uint32_t>(file, second + 4) == 0x004E4942,
            "the second chunk is no BIN");
  gltf_rule(second + 8 + buffer_bytes == file.size(), "bytes follow the buffer");
  const auto begin = file.begin() + static_cast<std::ptrdiff_t>(20);
  const auto end = begin + static_cast<std::ptrdiff_t>(json_bytes);
  return GltfReader(Json::parse(begin, end), Bytes(end + 8, file.end())).read();
}

WrittenModel read_written_gltf(const Bytes& file) {
  Json json = Json::parse(file.begin(), file.end());
  const std::string uri = json.at("buffers").at(0).at("uri");
  const std::string head = "data:application/octet-stream;base64,";
  gltf_rule(uri.compare(0, head.size(), head) == 0, "the buffer is not in the file");
  return GltfReader(std::move(json), decoded_base64(uri.substr(head.size()))).read();
}

}  // namespace runstone::test
