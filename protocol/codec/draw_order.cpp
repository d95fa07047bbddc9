#include "protocol/codec/draw_order.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"
#include "protocol/chunks/chunk_codec.hpp"

namespace runstone {
namespace {

enum class Kind : std::uint8_t { world = 1, chunk = 2, forget = 3, picture = 4, end = 5 };

/// Appends a frame whose body `write` appends.
template <class Write>
void append_frame(Kind kind, Bytes& out, Write write) {
  const std::size_t at = out.size();
  ByteWriter w(out);
  w.u32(0);  // filled in below
  w.u8(static_cast<std::uint8_t>(kind));
  write(w);
  const std::size_t body = out.size() - at - kDrawHeaderBytes;
  RUNSTONE_ASSERT(body <= kDrawBodyBytesMax);
  for (std::size_t i = 0; i < 4; ++i) out[at + i] = static_cast<std::uint8_t>(body >> (8 * i));
}

void write_key(ByteWriter& w, const ChunkKey& key) {
  w.u8(key.lod);
  for (const std::int32_t c : {key.at.x, key.at.y, key.at.z}) w.u32(static_cast<std::uint32_t>(c));
}

ChunkKey read_key(ByteReader& r, std::int32_t edge) {
  ChunkKey key;
  key.lod = r.u8();
  if (key.lod != 0) r.reject(ErrorCode::bad_value, "draw order: level of detail is not 0");
  const std::int32_t reach = kWorldLimit / edge;
  for (std::int32_t* c : {&key.at.x, &key.at.y, &key.at.z}) {
    *c = static_cast<std::int32_t>(r.u32());
    if (*c < -reach || *c >= reach)
      r.reject(ErrorCode::bad_value, "draw order: chunk outside the world");
  }
  return key;
}

constexpr bool is_edge(std::int32_t edge) {
  return edge == 16 || edge == 32 || edge == 64 || edge == 128;
}

ByteView bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
std::string_view text_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<DrawOrder> decode_world(ByteReader& r) {
  const std::uint8_t version = r.u8();
  const std::int32_t edge = r.u8();
  const ByteView toml = r.bytes(r.left());
  if (!r.ok()) return failure(r.error());
  if (version != kDrawVersion) {
    return fail(ErrorCode::bad_version,
                "draw order: the orders are of another version of Runstone");
  }
  if (!is_edge(edge))
    return fail(ErrorCode::bad_value, "draw order: chunk edge is not 16, 32, 64 or 128");
  auto materials = parse_material_table(text_of(toml), "materials");
  if (!materials)
    return fail(ErrorCode::bad_value, "draw order: the materials are no material table");
  return DrawOrder{DrawWorld{edge, *std::move(materials)}};
}

Result<DrawOrder> decode_chunk_order(ByteReader& r, std::int32_t edge) {
  const ChunkKey key = read_key(r, edge);
  const ByteView bytes = r.bytes(r.left());
  if (!r.ok()) return failure(r.error());
  auto voxels = decode_chunk(bytes, Extent::cube(static_cast<unsigned>(edge)));
  if (!voxels) return failure(voxels.error());
  return DrawOrder{DrawChunk{key, *std::move(voxels)}};
}

Result<DrawOrder> decode_picture(ByteReader& r) {
  DrawPicture picture;
  DrawCamera& c = picture.camera;
  for (double* v : {&c.x, &c.y, &c.z, &c.yaw, &c.pitch, &c.fov_y, &c.near, &c.far}) *v = r.f64();
  picture.size.width = r.u16();
  picture.size.height = r.u16();
  picture.file = text_of(r.bytes(r.left()));
  if (!r.ok()) return failure(r.error());
  if (const auto sound = validate(picture); !sound) return failure(sound.error());
  return DrawOrder{std::move(picture)};
}

}  // namespace

Result<void> validate(const DrawPicture& picture) {
  const DrawCamera& c = picture.camera;
  // Written so that a NaN is outside.
  const auto inside = [](double v, double low, double high) { return v >= low && v <= high; };
  const auto bad = [](const char* what) { return fail(ErrorCode::bad_value, what); };
  constexpr double kReach = 2.0 * kWorldLimit;
  for (const double v : {c.x, c.y, c.z}) {
    if (!inside(v, -kReach, kReach)) return bad("draw order: the eye is outside the world");
  }
  for (const double v : {c.yaw, c.pitch}) {
    if (!inside(v, -kDrawAngleMax, kDrawAngleMax))
      return bad("draw order: yaw or pitch is no angle");
  }
  if (!inside(c.fov_y, 0.01, 3.1))
    return bad("draw order: field of view is not 0.01 to 3.1 radians");
  if (!inside(c.near, kDrawDistanceMin, kDrawDistanceMax) ||
      !inside(c.far, c.near * 1.01, kDrawDistanceMax)) {
    return bad("draw order: near and far are not 0.01 to 1e6 voxels, one after the other");
  }
  for (const std::uint16_t side : {picture.size.width, picture.size.height}) {
    if (side < kDrawSideMin || side > kDrawSideMax)
      return bad("draw order: a side is not 16 to 8192 pixels");
  }
  if (picture.file.empty() || picture.file.size() > kDrawFileBytesMax ||
      !is_printable_utf8(picture.file)) {
    return bad("draw order: the file name is not 1 to 4096 bytes of printable UTF-8");
  }
  return {};
}

void append_draw_world(std::int32_t edge, const MaterialTable& materials, Bytes& out) {
  RUNSTONE_ASSERT(is_edge(edge));
  // A full table with its rules of generation would exceed the limit of a body.
  MaterialTable plain;
  for (std::size_t id = 1; id < materials.size(); ++id) {
    MaterialInfo info = materials[static_cast<Material>(id)];
    info.generation.reset();
    const auto added = plain.add(std::move(info));
    RUNSTONE_ASSERT(added.has_value());
  }
  const std::string toml = to_toml(plain);
  append_frame(Kind::world, out, [&](ByteWriter& w) {
    w.u8(kDrawVersion);
    w.u8(static_cast<std::uint8_t>(edge));
    w.bytes(bytes_of(toml));
  });
}

void append_draw_chunk(const ChunkKey& key, const RunChunk& voxels, Bytes& out) {
  append_frame(Kind::chunk, out, [&](ByteWriter& w) {
    write_key(w, key);
    encode_chunk(voxels, ChunkEncoding::packed, out);
  });
}

void append_draw_forget(const ChunkKey& key, Bytes& out) {
  append_frame(Kind::forget, out, [&](ByteWriter& w) { write_key(w, key); });
}

void append_draw_picture(const DrawPicture& picture, Bytes& out) {
  RUNSTONE_ASSERT(validate(picture).has_value());
  append_frame(Kind::picture, out, [&](ByteWriter& w) {
    const DrawCamera& c = picture.camera;
    for (const double v : {c.x, c.y, c.z, c.yaw, c.pitch, c.fov_y, c.near, c.far}) w.f64(v);
    w.u16(picture.size.width);
    w.u16(picture.size.height);
    w.bytes(bytes_of(picture.file));
  });
}

void append_draw_end(Bytes& out) {
  append_frame(Kind::end, out, [](ByteWriter&) {});
}

Result<void> DrawOrderReader::feed(ByteView bytes, const OnOrder& on_order) {
  if (broken_) return failure(*broken_);
  auto result = advance(bytes, on_order);
  if (!result) broken_ = result.error();
  return result;
}

Result<void> DrawOrderReader::finish() {
  if (broken_) return failure(*broken_);
  if (ended_) return {};
  broken_ = Error{ErrorCode::truncated, "draw order: the orders break off", frame_at_};
  return failure(*broken_);
}

Result<void> DrawOrderReader::advance(ByteView bytes, const OnOrder& on_order) {
  while (!bytes.empty()) {
    if (ended_)
      return fail(ErrorCode::trailing_bytes, "draw order: bytes after the last order", offset_);
    if (header_have_ < kDrawHeaderBytes) {
      if (header_have_ == 0) frame_at_ = offset_;
      const std::size_t take = std::min(bytes.size(), kDrawHeaderBytes - header_have_);
      std::copy_n(bytes.begin(), take, header_.begin() + static_cast<std::ptrdiff_t>(header_have_));
      header_have_ += take;
      offset_ += take;
      bytes = bytes.subspan(take);
      if (header_have_ < kDrawHeaderBytes) return {};
      if (auto opened = open_frame(); !opened) return opened;
    }
    // The announced length is not reserved: memory grows only with the bytes that the peer sends.
    const std::size_t take = std::min(bytes.size(), body_bytes_ - body_.size());
    body_.insert(body_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(take));
    offset_ += take;
    bytes = bytes.subspan(take);
    if (body_.size() < body_bytes_) return {};
    auto order = decode();
    if (!order) return fail(order.error().code, order.error().what, frame_at_);
    header_have_ = 0;
    body_.clear();
    if (const auto* world = std::get_if<DrawWorld>(&*order)) edge_ = world->edge;
    ended_ = std::holds_alternative<DrawEnd>(*order);
    if (auto taken = on_order(*std::move(order)); !taken) return taken;
  }
  return {};
}

Result<void> DrawOrderReader::open_frame() {
  ByteReader in(header_);
  body_bytes_ = in.u32();
  const auto kind = static_cast<Kind>(in.u8());
  if (kind < Kind::world || kind > Kind::end) {
    return fail(ErrorCode::unknown_kind, "draw order: unknown kind", frame_at_);
  }
  if (body_bytes_ > kDrawBodyBytesMax) {
    return fail(ErrorCode::limit_exceeded, "draw order: longer than 24 MiB", frame_at_);
  }
  if ((kind == Kind::world) != (edge_ == 0)) {
    return fail(ErrorCode::broken_invariant, "draw order: the world comes first, and once",
                frame_at_);
  }
  return {};
}

Result<DrawOrder> DrawOrderReader::decode() const {
  ByteReader r(body_);
  switch (static_cast<Kind>(header_[4])) {
    case Kind::world:
      return decode_world(r);
    case Kind::chunk:
      return decode_chunk_order(r, edge_);
    case Kind::picture:
      return decode_picture(r);
    case Kind::forget: {
      const ChunkKey key = read_key(r, edge_);
      if (const auto done = r.finish(); !done) return failure(done.error());
      return DrawOrder{DrawForget{key}};
    }
    case Kind::end:
      if (const auto done = r.finish(); !done) return failure(done.error());
      return DrawOrder{DrawEnd{}};
  }
  return fail(ErrorCode::unknown_kind, "draw order: unknown kind");
}

}  // namespace runstone
