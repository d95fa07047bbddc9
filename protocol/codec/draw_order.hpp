// Draw orders: a program without OpenGL writes them to the standard input of a child process,
// `runstone-client --draw`, which draws pictures of a world (docs/client.md). Little-endian:
//   frame   u32 body bytes | u8 kind | body
//   world   1: u8 version (2) | u8 chunk edge | material table as TOML, without generation. First,
//           and once
//   chunk   2: u8 lod (0) | i32 x, y, z | chunk bytes in any encoding (chunk_codec.hpp). Stored
//           from now on
//   forget  3: u8 lod (0) | i32 x, y, z. Removes the chunk
//   picture 4: f64 x, y, z, yaw, pitch, fov_y, near, far | u16 width, height | file name, UTF-8
//   end     5: empty. Nothing follows
// A chunk that is not stored counts as empty. Only pictures are answered (draw_answer.hpp).
// Both sides are programs of one build, yet the reader trusts no length, number or name.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"
#include "protocol/limits.hpp"

namespace runstone {

inline constexpr std::uint8_t kDrawVersion = 2;
inline constexpr std::size_t kDrawHeaderBytes = 5;
// A full table of materials, with the longest names and looks, fits. So does the largest chunk.
inline constexpr std::size_t kDrawBodyBytesMax = std::size_t{24} << 20;
static_assert(kDrawBodyBytesMax >= kServerChunkBytesMax);
inline constexpr std::size_t kDrawFileBytesMax = 4096;
inline constexpr std::uint16_t kDrawSideMin = 16, kDrawSideMax = 8192;    // pixels
inline constexpr double kDrawDistanceMin = 0.01, kDrawDistanceMax = 1e6;  // voxels, of near and far
inline constexpr double kDrawAngleMax = 628;  // radians in both directions: a hundred turns

/// The camera of a picture. Right-handed, y up. yaw 0 looks along +z and grows towards +x; pitch is
/// positive upward. Angles are in radians, lengths in voxels.
struct DrawCamera {
  double x = 0, y = 0, z = 0;  // eye, within +-2 kWorldLimit
  double yaw = 0, pitch = 0;
  double fov_y = 1.2;  // 0.01 .. 3.1
  double near = 0.1;   // what is nearer is clipped
  double far = 1000;   // everything fades into the sky towards this distance
  friend bool operator==(const DrawCamera&, const DrawCamera&) = default;
};

struct PictureSize {
  std::uint16_t width = 1280, height = 720;  // pixels, kDrawSideMin .. kDrawSideMax
  friend bool operator==(const PictureSize&, const PictureSize&) = default;
};

struct DrawWorld {
  std::int32_t edge = 32;   // 16, 32, 64 or 128
  MaterialTable materials;  // names, colours and visibility, without the rules of generation
};
struct DrawChunk {
  ChunkKey key;
  RunChunk voxels;  // a cube of the world's chunk edge
};
struct DrawForget {
  ChunkKey key;
};
struct DrawPicture {
  DrawCamera camera;
  PictureSize size;
  std::string file;  // a PNG file, relative to the folder in which both programs run
};
struct DrawEnd {};
using DrawOrder = std::variant<DrawWorld, DrawChunk, DrawForget, DrawPicture, DrawEnd>;

/// Fails if a field is outside its range; the error names the first one.
Result<void> validate(const DrawPicture& picture);

// Each function appends one whole frame. Requires values that the reader accepts.
void append_draw_world(std::int32_t edge, const MaterialTable& materials, Bytes& out);
/// Appends the chunk in the encoding `packed`. Cost: O(runs).
void append_draw_chunk(const ChunkKey& key, const RunChunk& voxels, Bytes& out);
void append_draw_forget(const ChunkKey& key, Bytes& out);
void append_draw_picture(const DrawPicture& picture, Bytes& out);
void append_draw_end(Bytes& out);

/// Reads the stream in pieces of any size and delivers one order after another. Holds at most one
/// body. After an error of its own or of on_order, every call returns that error. Offsets of errors
/// count bytes since the stream began and name the first byte of the frame. Thread: one.
class DrawOrderReader {
 public:
  using OnOrder = std::function<Result<void>(DrawOrder)>;
  Result<void> feed(ByteView bytes, const OnOrder& on_order);
  /// Ends the stream. Fails (truncated) unless its last order was `end`.
  Result<void> finish();
  bool ended() const { return ended_; }

 private:
  Result<void> advance(ByteView bytes, const OnOrder& on_order);
  Result<void> open_frame();
  Result<DrawOrder> decode() const;

  std::array<std::uint8_t, kDrawHeaderBytes> header_{};
  std::size_t header_have_ = 0;
  std::size_t body_bytes_ = 0;
  Bytes body_;
  std::uint64_t offset_ = 0, frame_at_ = 0;
  std::int32_t edge_ = 0;  // 0: no world yet
  bool ended_ = false;
  std::optional<Error> broken_;
};

}  // namespace runstone
