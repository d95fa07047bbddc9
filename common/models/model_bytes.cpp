#include "common/models/model_bytes.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "common/core/text.hpp"

namespace runstone {
namespace {

constexpr std::array<std::uint8_t, 4> kModelMark = {'R', 'S', 'M', 'B'};
constexpr std::uint8_t kModelBytesVersion = 1;
constexpr std::uint8_t kHasPlaces = 1, kHasColours = 2, kHasMaterialOf = 4;
constexpr std::size_t kModelHeadBytes = 4 + 1 + 1 + 5 * 4 + 8;
constexpr std::size_t kModelPieceBytes = 64 * 1024;

/// Returns the 32 bits of a number.
template <class Word>
std::uint32_t bits_of(Word word) {
  static_assert(sizeof(Word) == 4);
  std::uint32_t bits;
  std::memcpy(&bits, &word, sizeof bits);
  return bits;
}

class ModelEncoder {
 public:
  explicit ModelEncoder(const ModelByteSink& sink) : sink_(sink) {
    piece_.reserve(kModelPieceBytes);
  }

  void bytes(ByteView bytes) {
    while (!bytes.empty() && !failed_) {
      const std::size_t count = std::min(bytes.size(), kModelPieceBytes - piece_.size());
      piece_.insert(piece_.end(), bytes.begin(),
                    bytes.begin() + static_cast<std::ptrdiff_t>(count));
      bytes = bytes.subspan(count);
      if (piece_.size() == kModelPieceBytes) flush();
    }
  }
  void text(std::string_view text) {
    bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  void u32(std::uint32_t number) {
    std::array<std::uint8_t, 4> little;
    for (std::size_t i = 0; i < 4; ++i) little[i] = static_cast<std::uint8_t>(number >> (8 * i));
    bytes(little);
  }
  template <class Word, std::size_t N>
  void rows(const std::vector<std::array<Word, N>>& rows) {
    for (const auto& row : rows) {
      for (const Word word : row) u32(bits_of(word));
    }
  }
  bool finish() {
    flush();
    return !failed_;
  }

 private:
  void flush() {
    if (!failed_ && !piece_.empty()) failed_ = !sink_(piece_);
    piece_.clear();
  }

  const ModelByteSink& sink_;
  Bytes piece_;
  bool failed_ = false;
};

/// Reads from a source and counts. After the first failure every read returns zeros.
class ModelDecoder {
 public:
  ModelDecoder(const ModelByteSource& source, std::size_t bytes_max)
      : source_(source), left_(bytes_max), piece_(kModelPieceBytes) {}

  bool ok() const { return ok_; }
  const Error& error() const { return error_; }
  void reject(ErrorCode code, const char* what) {
    if (std::exchange(ok_, false)) error_ = {code, what, offset_};
  }

  /// Returns the next bytes, at most kModelPieceBytes, until the next call.
  ByteView bytes(std::size_t count) {
    const std::span<std::uint8_t> to(piece_.data(), count);
    if (ok_ && count > left_) reject(ErrorCode::limit_exceeded, "the model takes too many bytes");
    if (ok_ && !source_(to)) reject(ErrorCode::truncated, "the bytes of the model end early");
    if (!ok_) std::fill(to.begin(), to.end(), std::uint8_t{0});
    if (ok_) {
      left_ -= count;
      offset_ += count;
    }
    return to;
  }
  /// Fails unless `count` elements of `bytes` bytes each are allowed. Call it before memory is taken.
  bool has_room(std::uint64_t count, std::uint64_t bytes) {
    if (ok_ && count > left_ / bytes)
      reject(ErrorCode::limit_exceeded, "the model takes too many bytes");
    return ok_;
  }
  static std::uint32_t word(const std::uint8_t* at) {
    return static_cast<std::uint32_t>(at[0]) | static_cast<std::uint32_t>(at[1]) << 8 |
           static_cast<std::uint32_t>(at[2]) << 16 | static_cast<std::uint32_t>(at[3]) << 24;
  }
  std::uint8_t u8() { return bytes(1)[0]; }
  std::uint32_t u32() { return word(bytes(4).data()); }
  std::uint32_t count(std::size_t max, const char* what) {
    const std::uint32_t number = u32();
    if (number <= max) return number;
    reject(ErrorCode::limit_exceeded, what);
    return 0;
  }
  template <class Word, std::size_t N>
  void rows(std::vector<std::array<Word, N>>& rows, std::size_t count) {
    if (!has_room(count, 4 * N)) return;
    rows.reserve(count);
    constexpr std::size_t kRowsMax = kModelPieceBytes / (4 * N);
    while (ok_ && rows.size() < count) {
      const std::size_t some = std::min(kRowsMax, count - rows.size());
      const ByteView raw = bytes(some * 4 * N);
      for (std::size_t i = 0; i < some && ok_; ++i) {
        std::array<Word, N>& row = rows.emplace_back();
        for (std::size_t k = 0; k < N; ++k) {
          const std::uint32_t bits = word(raw.data() + 4 * (i * N + k));
          std::memcpy(&row[k], &bits, sizeof bits);
        }
      }
    }
  }
  void append(std::vector<std::uint8_t>& to, std::size_t count) {
    if (!has_room(count, 1)) return;
    to.reserve(to.size() + count);
    while (ok_ && count > 0) {
      const std::size_t some = std::min(kModelPieceBytes, count);
      const ByteView raw = bytes(some);
      to.insert(to.end(), raw.begin(), raw.end());
      count -= some;
    }
  }
  std::string text(std::size_t count) {
    const ByteView raw = bytes(count);
    return {reinterpret_cast<const char*>(raw.data()), raw.size()};
  }

 private:
  const ModelByteSource& source_;
  std::size_t left_;
  std::uint64_t offset_ = 0;
  Bytes piece_;
  bool ok_ = true;
  Error error_{};
};

struct ModelHead {
  std::uint8_t flags = 0;
  std::uint32_t positions = 0, triangles = 0, materials = 0, textures = 0, notices = 0;
  double metres = 0;
};

ModelHead read_head(ModelDecoder& in) {
  ModelHead head;
  const ByteView mark = in.bytes(kModelMark.size());
  if (!std::equal(mark.begin(), mark.end(), kModelMark.begin()))
    in.reject(ErrorCode::bad_value, "the bytes are no model");
  if (in.u8() != kModelBytesVersion)
    in.reject(ErrorCode::bad_version, "the model is of another version");
  head.flags = in.u8();
  if (head.flags > (kHasPlaces | kHasColours | kHasMaterialOf))
    in.reject(ErrorCode::bad_value, "the model has unknown flags");
  head.positions = in.count(kModelVerticesMax, "the model has more than 100,000,000 vertices");
  head.triangles = in.count(kModelTrianglesMax, "the model has more than 100,000,000 triangles");
  head.materials = in.count(kModelMaterialsMax, "the model has more than 65,535 materials");
  head.textures = in.count(kModelTexturesMax, "the model has more than 1,024 textures");
  head.notices = in.count(kModelNoticesMax, "the model has too many notices");
  ByteReader metres(in.bytes(8));
  head.metres = metres.f64();
  return head;
}

void read_colours(ModelDecoder& in, std::vector<ModelColour>& colours, std::size_t count) {
  if (!in.has_room(count, 4)) return;
  colours.reserve(count);
  while (in.ok() && colours.size() < count) {
    const std::size_t some = std::min(kModelPieceBytes / 4, count - colours.size());
    const ByteView raw = in.bytes(4 * some);
    for (std::size_t i = 0; i < some; ++i)
      colours.push_back({raw[4 * i], raw[4 * i + 1], raw[4 * i + 2], raw[4 * i + 3]});
  }
}

void read_material_of(ModelDecoder& in, std::vector<std::uint32_t>& numbers, std::size_t count) {
  if (!in.has_room(count, 4)) return;
  numbers.reserve(count);
  while (in.ok() && numbers.size() < count) {
    const std::size_t some = std::min(kModelPieceBytes / 4, count - numbers.size());
    const ByteView raw = in.bytes(4 * some);
    for (std::size_t i = 0; i < some; ++i) numbers.push_back(ModelDecoder::word(&raw[4 * i]));
  }
}

ModelMaterial read_material(ModelDecoder& in) {
  ModelMaterial material;
  material.name = in.text(in.u8());
  const ByteView colour = in.bytes(4);
  std::copy(colour.begin(), colour.end(), material.colour.begin());
  if (const std::uint32_t texture = in.u32(); texture != 0) material.texture = texture - 1;
  return material;
}

ModelTexture read_texture(ModelDecoder& in, std::size_t bytes_max) {
  ModelTexture texture;
  texture.width = in.u32();
  texture.height = in.u32();
  if (texture.width > kModelTextureSideMax || texture.height > kModelTextureSideMax)
    in.reject(ErrorCode::limit_exceeded, "a texture is not 1 .. 16,384 texels a side");
  const std::size_t bytes = std::size_t{4} * texture.width * texture.height;
  if (bytes > bytes_max)
    in.reject(ErrorCode::limit_exceeded, "the textures take more than 512 MiB");
  in.append(texture.texels, in.ok() ? bytes : 0);
  return texture;
}

std::string read_notice(ModelDecoder& in) {
  const ByteView size = in.bytes(2);
  const std::size_t bytes = static_cast<std::size_t>(size[0] | size[1] << 8);
  if (bytes > kModelNoticeBytesMax) {
    in.reject(ErrorCode::limit_exceeded, "a notice is longer than 256 bytes");
    return {};
  }
  std::string text = in.text(bytes);
  if (!is_printable_utf8(text)) in.reject(ErrorCode::bad_value, "a notice is no printable line");
  return text;
}

}  // namespace

bool encode_model(const ReadModel& read, const ModelByteSink& sink) {
  const Model& m = read.model;
  ModelEncoder out(sink);
  Bytes head(kModelMark.begin(), kModelMark.end());
  ByteWriter writer(head);
  writer.u8(kModelBytesVersion);
  writer.u8(static_cast<std::uint8_t>((m.texture_places.empty() ? 0 : kHasPlaces) |
                                      (m.colours.empty() ? 0 : kHasColours) |
                                      (m.material_of.empty() ? 0 : kHasMaterialOf)));
  for (const std::size_t count : {m.positions.size(), m.triangles.size(), m.materials.size(),
                                  m.textures.size(), read.notices.size()})
    writer.u32(static_cast<std::uint32_t>(count));
  writer.f64(m.metres_per_unit.value_or(0));
  RUNSTONE_ASSERT(head.size() == kModelHeadBytes);
  out.bytes(head);
  out.rows(m.positions);
  out.rows(m.texture_places);
  for (const ModelColour& colour : m.colours) out.bytes(colour);
  out.rows(m.triangles);
  for (const std::uint32_t material : m.material_of) out.u32(material);
  for (const ModelMaterial& material : m.materials) {
    const auto bytes = static_cast<std::uint8_t>(material.name.size());
    out.bytes({&bytes, 1});
    out.text(material.name);
    out.bytes(material.colour);
    out.u32(material.texture ? *material.texture + 1 : 0);
  }
  for (const ModelTexture& texture : m.textures) {
    out.u32(texture.width);
    out.u32(texture.height);
    out.bytes(texture.texels);
  }
  for (const std::string& notice : read.notices) {
    const std::array<std::uint8_t, 2> bytes = {static_cast<std::uint8_t>(notice.size()),
                                               static_cast<std::uint8_t>(notice.size() >> 8)};
    out.bytes(bytes);
    out.text(notice);
  }
  return out.finish();
}

Result<ReadModel> decode_model(const ModelByteSource& source, std::size_t bytes_max) {
  ModelDecoder in(source, bytes_max);
  ReadModel read;
  Model& m = read.model;
  const ModelHead head = read_head(in);
  if (!in.ok()) return failure(in.error());
  const auto if_has = [&head](std::uint8_t flag, std::size_t count) {
    return (head.flags & flag) != 0 ? count : 0;
  };
  in.rows(m.positions, head.positions);
  in.rows(m.texture_places, if_has(kHasPlaces, head.positions));
  read_colours(in, m.colours, if_has(kHasColours, head.positions));
  in.rows(m.triangles, head.triangles);
  read_material_of(in, m.material_of, if_has(kHasMaterialOf, head.triangles));
  for (std::uint32_t i = 0; in.ok() && i < head.materials; ++i)
    m.materials.push_back(read_material(in));
  std::size_t texture_left = kModelTextureBytesMax;
  for (std::uint32_t i = 0; in.ok() && i < head.textures; ++i) {
    m.textures.push_back(read_texture(in, texture_left));
    texture_left -= m.textures.back().texels.size();
  }
  for (std::uint32_t i = 0; in.ok() && i < head.notices; ++i)
    read.notices.push_back(read_notice(in));
  if (!in.ok()) return failure(in.error());
  if (head.metres != 0) m.metres_per_unit = head.metres;
  if (const auto valid = validate(m); !valid) return failure(valid.error());
  return read;
}

}  // namespace runstone
