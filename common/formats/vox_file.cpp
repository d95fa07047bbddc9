#include "common/formats/vox_file.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>
#include <utility>

namespace runstone {
namespace {

/// Entries of a dictionary, and frames of a node.
constexpr std::uint32_t kVoxEntriesMax = 4096;
/// All entries of all dictionaries of a file.
constexpr std::size_t kVoxAllEntriesMax = std::size_t{1} << 22;

std::string_view chars_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::optional<std::int64_t> vox_integer(std::string_view& text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

/// Returns a number such as "0.25", or -1 if it is none or lies outside 0 .. 1000.
double vox_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end == text.data() || !(value >= 0 && value <= 1000)) return -1;
  return value;
}

using VoxDictionary = std::vector<std::pair<std::string_view, std::string_view>>;

std::string_view entry_of(const VoxDictionary& dictionary, std::string_view key) {
  for (const auto& [known, value] : dictionary) {
    if (known == key) return value;
  }
  return {};
}

/// Reads the contents of one chunk after the other.
class VoxChunks {
 public:
  VoxChunks(ByteView file, VoxFile& out) : file_(file), out_(out) {}

  Result<void> read();

 private:
  Result<void> take(std::string_view id, std::size_t at, ByteView content);
  void take_size(ByteReader& in);
  void take_voxels(ByteReader& in);
  void take_packed(ByteReader& in);
  void take_palette(ByteReader& in);
  void take_shown(ByteReader& in);
  void take_notes(ByteReader& in);
  void take_material(ByteReader& in);
  void take_layer(ByteReader& in);
  void take_transform(ByteReader& in);
  void take_group(ByteReader& in);
  void take_shape(ByteReader& in);

  void check_side(ByteReader& in, std::int32_t side);
  std::string_view text(ByteReader& in);
  VoxDictionary dictionary(ByteReader& in);
  void add_node(ByteReader& in, std::int32_t id, VoxNode node);
  static std::int32_t number(ByteReader& in) { return static_cast<std::int32_t>(in.u32()); }

  ByteView file_;
  VoxFile& out_;
  std::size_t at_ = 0;  // of the content of the chunk
  std::size_t entries_ = 0;
};

std::string_view VoxChunks::text(ByteReader& in) {
  const std::uint32_t size = in.u32();
  if (size > in.left()) in.reject(ErrorCode::truncated, "vox: a text is longer than its chunk");
  return chars_of(in.bytes(in.ok() ? size : 0));
}

VoxDictionary VoxChunks::dictionary(ByteReader& in) {
  const std::uint32_t count = in.u32();
  entries_ += count;
  if (count > kVoxEntriesMax || entries_ > kVoxAllEntriesMax)
    in.reject(ErrorCode::limit_exceeded, "vox: a dictionary has more than 4096 entries");
  VoxDictionary out;
  for (std::uint32_t i = 0; i < count && in.ok(); ++i) {
    const std::string_view key = text(in);
    out.emplace_back(key, text(in));
  }
  return out;
}

void VoxChunks::check_side(ByteReader& in, std::int32_t side) {
  if (in.ok() && (side < 1 || side > kVoxModelSideMax))
    in.reject(ErrorCode::bad_value, "vox: a side of a model is outside 1 .. 256");
}

void VoxChunks::take_size(ByteReader& in) {
  if (!out_.models.empty() && !out_.models.back().has_voxels)
    in.reject(ErrorCode::bad_value, "vox: a model has a size and no voxels");
  if (out_.models.size() == kVoxNodesMax)
    in.reject(ErrorCode::limit_exceeded, "vox: more than 65536 models");
  VoxModel model;
  for (std::int32_t* side : {&model.x, &model.y, &model.z}) {
    *side = number(in);
    check_side(in, *side);
  }
  if (in.ok()) out_.models.push_back(model);
}

void VoxChunks::take_voxels(ByteReader& in) {
  if (out_.models.empty() || out_.models.back().has_voxels) {
    in.reject(ErrorCode::bad_value, "vox: voxels have no size before them");
    return;
  }
  VoxModel& model = out_.models.back();
  const std::uint32_t count = in.u32();
  if (in.ok() && count > in.left() / 4)
    in.reject(ErrorCode::truncated, "vox: a model has fewer voxels than it says");
  if (!in.ok()) return;
  model.offset = at_ + in.offset();
  model.voxels = in.bytes(std::size_t{count} * 4);
  model.has_voxels = true;
}

void VoxChunks::take_packed(ByteReader& in) {
  if (out_.models.empty() || out_.models.back().has_voxels) {
    in.reject(ErrorCode::bad_value, "vox: voxels have no size before them");
    return;
  }
  VoxModel& model = out_.models.back();
  if (number(in) != model.x || number(in) != model.y || number(in) != model.z)
    in.reject(ErrorCode::bad_value, "vox: the sides of packed voxels are not those of the model");
  if (!in.ok()) return;
  model.offset = at_ + in.offset();
  model.voxels = in.bytes(in.left());
  model.is_packed = true;
  model.has_voxels = true;
}

void VoxChunks::take_palette(ByteReader& in) {
  // Entry i is the colour of voxels of colour i + 1. The last one has no use, and some files lack it.
  for (std::size_t i = 0; i < kVoxColours && (i + 1 < kVoxColours || in.left() > 0); ++i) {
    auto& colour = out_.palette[(i + 1) % kVoxColours];
    for (std::uint8_t& part : colour) part = in.u8();
  }
}

void VoxChunks::take_shown(ByteReader& in) {
  for (std::size_t i = 0; i < kVoxColours; ++i)
    out_.shown_at[in.u8()] = static_cast<std::uint8_t>((i + 1) % kVoxColours);
}

void VoxChunks::take_notes(ByteReader& in) {
  const std::uint32_t count = in.u32();
  if (count > kVoxEntriesMax)
    in.reject(ErrorCode::limit_exceeded, "vox: the palette has more than 4096 notes");
  out_.notes.clear();
  for (std::uint32_t i = 0; i < count && in.ok(); ++i) out_.notes.push_back(text(in));
}

void VoxChunks::take_material(ByteReader& in) {
  const std::int32_t id = number(in);
  const VoxDictionary entries = dictionary(in);
  // Programs write an entry 256, which no voxel has.
  if (!in.ok() || id < 1 || id >= static_cast<std::int32_t>(kVoxColours)) return;
  VoxMaterial& material = out_.materials[static_cast<std::size_t>(id)];
  material.type = entry_of(entries, "_type");
  material.weight = vox_number(entry_of(entries, "_weight"));
  material.trans = vox_number(entry_of(entries, "_trans"));
  if (material.trans < 0) material.trans = vox_number(entry_of(entries, "_alpha"));
  material.rough = vox_number(entry_of(entries, "_rough"));
  material.emit = vox_number(entry_of(entries, "_emit"));
  for (const auto& [key, value] : entries) material.has_name |= key == "_runstone_name";
  material.name = entry_of(entries, "_runstone_name");
  material.states = entry_of(entries, "_runstone_states");
  material.look = entry_of(entries, "_runstone_look");
}

void VoxChunks::take_layer(ByteReader& in) {
  const std::int32_t id = number(in);
  const VoxDictionary entries = dictionary(in);
  if (in.ok() && entry_of(entries, "_hidden") == "1") {
    if (out_.hidden_layers.size() == kVoxNodesMax)
      in.reject(ErrorCode::limit_exceeded, "vox: more than 65536 layers");
    out_.hidden_layers[id] = true;
  }
}

void VoxChunks::add_node(ByteReader& in, std::int32_t id, VoxNode node) {
  if (!in.ok()) return;
  node.offset = at_;
  if (out_.nodes.size() == kVoxNodesMax) {
    in.reject(ErrorCode::limit_exceeded, "vox: the scene has more than 65536 nodes");
  } else if (!out_.nodes.try_emplace(id, std::move(node)).second) {
    in.reject(ErrorCode::bad_value, "vox: two nodes have one number");
  }
}

void VoxChunks::take_transform(ByteReader& in) {
  const std::int32_t id = number(in);
  const VoxDictionary entries = dictionary(in);
  VoxNode node;
  node.kind = VoxNode::Kind::transform;
  node.is_hidden = entry_of(entries, "_hidden") == "1";
  node.children = {number(in)};
  in.u32();  // reserved
  node.layer = number(in);
  const std::uint32_t frames = in.u32();
  if (frames > kVoxEntriesMax)
    in.reject(ErrorCode::limit_exceeded, "vox: a node has more than 4096 frames");
  // Of an animation, the first frame counts.
  if (in.ok() && frames > 0) {
    const VoxDictionary frame = dictionary(in);
    if (std::string_view turn = entry_of(frame, "_r"); !turn.empty()) {
      const auto bits = vox_integer(turn);
      const auto low = static_cast<std::uint8_t>(bits.value_or(-1) & 3);
      const auto middle = static_cast<std::uint8_t>(bits.value_or(-1) >> 2 & 3);
      if (!bits || *bits < 0 || *bits > 127 || low > 2 || middle > 2 || low == middle) {
        in.reject(ErrorCode::bad_value, "vox: a rotation of the scene is none");
        return;
      }
      node.place.turn.from = {low, middle, static_cast<std::uint8_t>(3 - low - middle)};
      for (unsigned i = 0; i < 3; ++i)
        node.place.turn.sign[i] = (*bits >> (4 + i) & 1) != 0 ? std::int8_t{-1} : std::int8_t{1};
    }
    if (std::string_view shift = entry_of(frame, "_t"); !shift.empty()) {
      for (std::int32_t& part : node.place.shift) {
        const auto value = vox_integer(shift);
        if (!value || *value < -kWorldLimit || *value > kWorldLimit) {
          in.reject(ErrorCode::bad_value, "vox: a translation of the scene is none, or too far");
          return;
        }
        part = static_cast<std::int32_t>(*value);
      }
    }
  }
  add_node(in, id, std::move(node));
  for (const auto& [key, value] : entries) {
    if (key == "_runstone_name") out_.name = value;
    if (key == "_runstone_author") out_.author = value;
    std::string_view rest = value;
    if (key == "_runstone_created_us") out_.created_us = vox_integer(rest).value_or(0);
    if (key != "_runstone_origin") continue;
    for (std::int32_t* part : {&out_.origin.x, &out_.origin.y, &out_.origin.z}) {
      const auto at = vox_integer(rest);
      *part = at && *at > -2 * std::int64_t{kWorldLimit} && *at < 2 * std::int64_t{kWorldLimit}
                  ? static_cast<std::int32_t>(*at)
                  : 0;
    }
  }
}

void VoxChunks::take_group(ByteReader& in) {
  const std::int32_t id = number(in);
  VoxNode node;
  node.kind = VoxNode::Kind::group;
  node.is_hidden = entry_of(dictionary(in), "_hidden") == "1";
  const std::uint32_t count = in.u32();
  if (in.ok() && count > in.left() / 4)
    in.reject(ErrorCode::truncated, "vox: a group has fewer children than it says");
  if (!in.ok()) return;
  node.children.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) node.children.push_back(number(in));
  add_node(in, id, std::move(node));
}

void VoxChunks::take_shape(ByteReader& in) {
  const std::int32_t id = number(in);
  VoxNode node;
  node.kind = VoxNode::Kind::shape;
  node.is_hidden = entry_of(dictionary(in), "_hidden") == "1";
  const std::uint32_t count = in.u32();
  // Several models are the frames of an animation.
  if (in.ok() && count > 0) node.children = {number(in)};
  add_node(in, id, std::move(node));
}

Result<void> VoxChunks::take(std::string_view id, std::size_t at, ByteView content) {
  constexpr std::pair<std::string_view, void (VoxChunks::*)(ByteReader&)> kTakers[] = {
      {"SIZE", &VoxChunks::take_size},      {"XYZI", &VoxChunks::take_voxels},
      {"TDCZ", &VoxChunks::take_packed},    {"RGBA", &VoxChunks::take_palette},
      {"IMAP", &VoxChunks::take_shown},     {"NOTE", &VoxChunks::take_notes},
      {"MATL", &VoxChunks::take_material},  {"LAYR", &VoxChunks::take_layer},
      {"nTRN", &VoxChunks::take_transform}, {"nGRP", &VoxChunks::take_group},
      {"nSHP", &VoxChunks::take_shape},
  };
  for (const auto& [known, taker] : kTakers) {
    if (id != known) continue;
    ByteReader in(content);
    at_ = at;
    (this->*taker)(in);
    if (in.ok()) return {};
    if (in.error().code != ErrorCode::truncated || in.error().what[0] == 'v')
      return fail(in.error().code, in.error().what, at + in.error().offset);
    return fail(ErrorCode::truncated, "vox: a chunk ends inside a field", at + in.error().offset);
  }
  return {};  // PACK, rOBJ, rCAM, MATT, META and others say nothing about voxels
}

Result<void> VoxChunks::read() {
  ByteReader in(file_);
  if (chars_of(in.bytes(4)) != "VOX ") {
    if (file_.size() < 4) return fail(ErrorCode::truncated, "vox: no bytes of a mark", 0);
    return fail(ErrorCode::bad_value, "vox: is not a .vox of MagicaVoxel", 0);
  }
  const std::uint32_t version = in.u32();
  if (in.ok() && version != 150 && version != 200)
    return fail(ErrorCode::bad_version, "vox: of another version than 150 and 200", 4);
  const std::string_view main = chars_of(in.bytes(4));
  if (in.ok() && main != "MAIN") return fail(ErrorCode::bad_value, "vox: chunk MAIN is missing", 8);
  const std::uint32_t main_bytes = in.u32();
  const std::uint32_t child_bytes_of_main = in.u32();
  if (!in.ok()) return fail(ErrorCode::truncated, "vox: file ends in its head", in.offset());
  if (main_bytes > in.left() || child_bytes_of_main > in.left() - main_bytes)
    return fail(ErrorCode::truncated, "vox: file is shorter than its chunk MAIN says",
                file_.size());
  if (child_bytes_of_main == 0) return fail(ErrorCode::bad_value, "vox: chunk MAIN is empty", 16);
  in = ByteReader(file_.first(in.offset() + main_bytes + child_bytes_of_main));
  in.bytes(20 + std::size_t{main_bytes});
  while (!in.at_end()) {
    const std::size_t begin = in.offset();
    const std::string_view id = chars_of(in.bytes(4));
    const std::uint32_t bytes = in.u32();
    const std::uint32_t child_bytes = in.u32();
    if (!in.ok() || bytes > in.left())
      return fail(ErrorCode::truncated, "vox: file ends inside a chunk", begin);
    const std::size_t at = in.offset();
    if (const auto taken = take(id, at, in.bytes(bytes)); !taken) return taken;
    if (child_bytes > in.left())
      return fail(ErrorCode::truncated, "vox: file ends inside a chunk", begin);
    in.bytes(child_bytes);
  }
  if (!out_.models.empty() && !out_.models.back().has_voxels)
    return fail(ErrorCode::bad_value, "vox: a model has a size and no voxels", file_.size());
  return {};
}

/// The colours of a file without a palette: the cube of six steps a channel, from white on, blue
/// changing first, without black; and ten shades each of red, green, blue and grey.
void set_default_palette(VoxFile& out) {
  constexpr std::array<std::uint8_t, 6> kSteps = {255, 204, 153, 102, 51, 0};
  constexpr std::array<std::uint8_t, 10> kShades = {238, 221, 187, 170, 136, 119, 85, 68, 34, 17};
  std::size_t at = 1;
  for (const std::uint8_t red : kSteps) {
    for (const std::uint8_t green : kSteps) {
      for (const std::uint8_t blue : kSteps) {
        if (at <= 215) out.palette[at++] = {red, green, blue, 255};
      }
    }
  }
  for (unsigned channel = 0; channel < 4; ++channel) {
    for (const std::uint8_t shade : kShades) {
      out.palette[at] = {0, 0, 0, 255};
      for (unsigned i = 0; i < 3; ++i) {
        if (channel == 3 || channel == i) out.palette[at][i] = shade;
      }
      ++at;
    }
  }
}

}  // namespace

Result<VoxFile> read_vox_file(ByteView file) {
  VoxFile out;
  set_default_palette(out);
  for (std::size_t i = 0; i < kVoxColours; ++i) out.shown_at[i] = static_cast<std::uint8_t>(i);
  if (const auto read = VoxChunks(file, out).read(); !read) return failure(read.error());
  return out;
}

}  // namespace runstone
