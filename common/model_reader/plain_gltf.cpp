#include "common/model_reader/plain_gltf.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "common/model_reader/gltf_buffers.hpp"
#include "common/model_reader/gltf_head.hpp"

namespace runstone {
namespace {

using Json = nlohmann::json;

// Numbers that glTF defines.
constexpr std::uint64_t kI8 = 5120, kU8 = 5121, kI16 = 5122, kU16 = 5123, kF32 = 5126;
constexpr std::uint64_t kStrideMax = 252;

constexpr int kJsonDepthMax = 64;  // that of a file that is sound is below 12
constexpr std::uint64_t kFloatsBytesMax = std::uint64_t{1} << 30;
/// Greater places and counts are refused before they are added or multiplied.
constexpr std::uint64_t kNumberMax = std::uint64_t{1} << 40;

/// The JSON is none of glTF.
struct NoGltf {};

std::uint64_t whole_number(const Json& json) {
  if (!json.is_number_unsigned()) throw NoGltf();
  const auto number = json.get<std::uint64_t>();
  if (number > kNumberMax) throw NoGltf();
  return number;
}
std::uint64_t whole_number(const Json& object, const char* key, std::uint64_t otherwise) {
  const auto found = object.find(key);
  return found == object.end() ? otherwise : whole_number(*found);
}

bool is_quantised_type(std::uint64_t type) { return type >= kI8 && type <= kU16; }

/// The integers of an accessor.
struct Integers {
  std::uint64_t accessor = 0;
  std::uint64_t type = 0, parts = 0;  // numbers of an element
  bool is_normalised = false;
  std::uint64_t buffer = 0, offset = 0, stride = 0, count = 0;
  std::uint64_t part_bytes() const { return type <= kU8 ? 1 : 2; }
  std::uint64_t floats_bytes() const { return count * parts * sizeof(float); }
};

float float_of(const std::uint8_t* at, std::uint64_t type, bool is_normalised) {
  const auto word = [&] { return static_cast<std::uint16_t>(at[0] | at[1] << 8); };
  int value = 0, greatest = 1;
  switch (type) {
    case kI8:
      value = static_cast<std::int8_t>(*at);
      greatest = 127;
      break;
    case kU8:
      value = *at;
      greatest = 255;
      break;
    case kI16:
      value = static_cast<std::int16_t>(word());
      greatest = 32767;
      break;
    default:
      value = word();
      greatest = 65535;
  }
  if (!is_normalised) return static_cast<float>(value);
  return std::max(static_cast<float>(value) / static_cast<float>(greatest), -1.0F);
}

class GltfConversion {
 public:
  GltfConversion(const ModelFolder& folder, const OpenedFile& file, GltfHead head)
      : folder_(folder), file_(file), head_(std::move(head)) {}

  Result<PlainGltf, std::string> run() {
    json_ = Json::parse(head_.json, [](int depth, Json::parse_event_t, Json&) {
      if (depth > kJsonDepthMax) throw NoGltf();
      return true;
    });
    head_.json = {};
    find_attributes();
    std::uint64_t bytes = 0;
    for (const std::uint64_t accessor : attributes_) {
      auto found = integers_of(accessor);
      if (!found) return failure(found.error());
      if (found->parts == 0) continue;
      integers_.push_back(*found);
      bytes += found->floats_bytes();
      if (bytes > kFloatsBytesMax)
        return failure(
            std::string("has too many quantised numbers: export the model without "
                        "KHR_mesh_quantization"));
    }
    out_.floats.resize(static_cast<std::size_t>(bytes));
    if (auto converted = convert(); !converted) return failure(converted.error());
    write_head();
    return std::move(out_);
  }

 private:
  /// Finds the accessors of attributes whose numbers may be integers.
  void find_attributes() {
    const auto take = [&](const Json& attributes) {
      for (const auto& [name, accessor] : attributes.items()) {
        const bool is_vector = name == "POSITION" || name == "NORMAL" || name == "TANGENT" ||
                               name.compare(0, 9, "TEXCOORD_") == 0;
        if (is_vector) attributes_.insert(whole_number(accessor));
      }
    };
    for (const Json& mesh : json_.at("meshes")) {
      for (const Json& primitive : mesh.at("primitives")) {
        take(primitive.at("attributes"));
        const auto targets = primitive.find("targets");
        if (targets == primitive.end()) continue;
        for (const Json& target : *targets) take(target);
      }
    }
  }

  /// Returns where the integers of an accessor are, or no parts if it has floats.
  Result<Integers, std::string> integers_of(std::uint64_t number) const {
    const Json& accessor = json_.at("accessors").at(static_cast<std::size_t>(number));
    Integers out;
    out.accessor = number;
    out.type = whole_number(accessor.at("componentType"));
    if (out.type == kF32) return out;
    if (!is_quantised_type(out.type))
      return failure(std::string("a place, normal or texture place has numbers of another kind"));
    if (accessor.contains("sparse") || !accessor.contains("bufferView"))
      return failure(
          std::string("has quantised numbers that are sparse or compressed: export "
                      "the model without them"));
    const auto& form = accessor.at("type").get_ref<const std::string&>();
    if (form.size() != 4 || form.compare(0, 3, "VEC") != 0 || form[3] < '2' || form[3] > '4')
      throw NoGltf();
    out.parts = static_cast<std::uint64_t>(form[3] - '0');
    out.is_normalised = accessor.value("normalized", false);
    out.count = whole_number(accessor.at("count"));
    const Json& view = json_.at("bufferViews")
                           .at(static_cast<std::size_t>(whole_number(accessor.at("bufferView"))));
    const std::uint64_t element = out.parts * out.part_bytes();
    out.stride = whole_number(view, "byteStride", element);
    out.buffer = whole_number(view.at("buffer"));
    const std::uint64_t at = whole_number(accessor, "byteOffset", 0);
    out.offset = whole_number(view, "byteOffset", 0) + at;
    if (out.stride < element || out.stride > kStrideMax || out.count == 0) throw NoGltf();
    if (at + out.stride * (out.count - 1) + element > whole_number(view.at("byteLength")))
      return failure(std::string("has quantised numbers outside of their buffer"));
    return out;
  }

  /// Converts all integers, and lets their accessors name the floats.
  Result<void, std::string> convert() {
    GltfBuffers buffers(folder_, file_, head_, json_.at("buffers"));
    constexpr std::size_t kBlock = 4096;  // elements
    std::vector<std::uint8_t> block;
    std::size_t to = 0;
    Json& views = json_.at("bufferViews");
    const std::size_t floats_buffer = json_.at("buffers").size();
    for (const Integers& from : integers_) {
      const std::size_t begin = to;
      const auto element = static_cast<std::size_t>(from.parts * from.part_bytes());
      for (std::uint64_t i = 0; i < from.count; i += kBlock) {
        const auto count =
            static_cast<std::size_t>(std::min<std::uint64_t>(kBlock, from.count - i));
        block.resize(static_cast<std::size_t>(from.stride) * (count - 1) + element);
        if (auto got = buffers.read(from.buffer, from.offset + from.stride * i, block.data(),
                                    block.size());
            !got)
          return got;
        for (std::size_t k = 0; k < count; ++k) {
          for (std::size_t part = 0; part < from.parts; ++part) {
            const std::uint8_t* const at = block.data() +
                                           k * static_cast<std::size_t>(from.stride) +
                                           part * static_cast<std::size_t>(from.part_bytes());
            const float value = float_of(at, from.type, from.is_normalised);
            std::memcpy(out_.floats.data() + to, &value, sizeof value);
            to += sizeof value;
          }
        }
      }
      Json& accessor = json_.at("accessors").at(static_cast<std::size_t>(from.accessor));
      for (const char* key : {"byteOffset", "normalized", "min", "max"}) accessor.erase(key);
      accessor["bufferView"] = views.size();
      accessor["componentType"] = kF32;
      views.push_back(
          Json{{"buffer", floats_buffer}, {"byteOffset", begin}, {"byteLength", to - begin}});
    }
    return {};
  }

  void write_head() {
    if (!out_.floats.empty()) {
      json_.at("buffers").push_back(
          Json{{"byteLength", out_.floats.size()}, {"uri", std::string(kFloatsFile)}});
    }
    std::string text = json_.dump();
    json_ = {};
    out_.rest_at = head_.end;
    if (!head_.is_binary) {
      out_.head = std::move(text);
      return;
    }
    text.append((4 - text.size() % 4) % 4, ' ');
    const std::uint64_t rest = file_.bytes() - std::min(head_.end, file_.bytes());
    const auto append = [&](std::uint64_t number) {
      for (unsigned i = 0; i < 4; ++i) out_.head.push_back(static_cast<char>(number >> 8 * i));
    };
    out_.head.reserve(kGlbHeadBytes + text.size());
    out_.head = "glTF";
    append(2);
    append(std::min<std::uint64_t>(kGlbHeadBytes + text.size() + rest,
                                   std::numeric_limits<std::uint32_t>::max()));
    append(text.size());
    out_.head += "JSON";
    out_.head += text;
  }

  const ModelFolder& folder_;
  const OpenedFile& file_;
  GltfHead head_;
  Json json_;
  std::set<std::uint64_t> attributes_;
  std::vector<Integers> integers_;
  PlainGltf out_;
};

}  // namespace

Result<PlainGltf, std::string> plain_gltf(const ModelFolder& folder, const OpenedFile& file) {
  try {
    return GltfConversion(folder, file, gltf_head(file)).run();
  } catch (const NoGltf&) {
  } catch (const Json::exception&) {
  }
  return failure(std::string("cannot be read: its JSON is none of glTF, or damaged"));
}

}  // namespace runstone
