#include "bench/wire/transfer_form.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>

#include "bench/wire/luanti_form.hpp"
#include "bench/wire/palette_form.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/reorder.hpp"
#include "protocol/chunks/chunk_codec.hpp"

namespace runstone::bench {
namespace {

constexpr std::size_t kBlockSide = 16, kBlocks = 8;
constexpr int kZstdLevel = 3;
// Luanti's id of air. The others follow it, so that every material has an id.
constexpr std::uint16_t kLuantiAir = 126;

constexpr std::array<std::string_view, 8> kNames = {
    "dense", "dense_zstd", "luanti_light", "luanti", "minecraft", "raw", "packed", "coded"};

void check(bool good) {
  if (!good) std::abort();  // a form that cannot read its bytes measures nothing
}

/// Returns the index in the chunk of a voxel of block `b`. Blocks lie x fastest, then y, then z.
std::size_t in_chunk(std::size_t b, std::size_t x, std::size_t y, std::size_t z) {
  const std::size_t wide_x = x + kBlockSide * (b & 1), wide_y = y + kBlockSide * (b >> 1 & 1),
                    wide_z = z + kBlockSide * (b >> 2);
  return wide_x + kByteEdge * (wide_y + kByteEdge * wide_z);
}

/// Calls f(block, index in the chunk, x, y, z in the block) for every voxel.
template <class F>
void each_voxel(F&& f) {
  for (std::size_t b = 0; b < kBlocks; ++b) {
    for (std::size_t z = 0; z < kBlockSide; ++z) {
      for (std::size_t y = 0; y < kBlockSide; ++y) {
        for (std::size_t x = 0; x < kBlockSide; ++x) f(b, in_chunk(b, x, y, z), x, y, z);
      }
    }
  }
}

std::vector<std::uint8_t> no_light() { return {}; }

TransferForm dense_form(const LitChunk& chunk) {
  struct State {
    std::vector<Material> received;
    Bytes bytes;
  };
  const auto s = std::make_shared<State>();
  return {"dense",
          [s, &chunk] {
            s->bytes.resize(2 * chunk.voxels.size());
            std::memcpy(s->bytes.data(), chunk.voxels.data(), s->bytes.size());
          },
          [s] {
            s->received.resize(s->bytes.size() / 2);
            std::memcpy(s->received.data(), s->bytes.data(), s->bytes.size());
          },
          [s] { return s->bytes.size(); },
          [s] { return s->received; },
          no_light};
}

TransferForm dense_zstd_form(const LitChunk& chunk) {
  struct State {
    ZSTD_CCtx* compressor = ZSTD_createCCtx();
    ZSTD_DCtx* decompressor = ZSTD_createDCtx();
    std::vector<Material> received;
    Bytes bytes;
    std::size_t size = 0;
    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
      ZSTD_freeCCtx(compressor);
      ZSTD_freeDCtx(decompressor);
    }
  };
  const auto s = std::make_shared<State>();
  const std::size_t dense = 2 * chunk.voxels.size();
  s->bytes.resize(ZSTD_compressBound(dense));
  s->received.resize(chunk.voxels.size());
  return {"dense_zstd",
          [s, &chunk, dense] {
            s->size = ZSTD_compressCCtx(s->compressor, s->bytes.data(), s->bytes.size(),
                                        chunk.voxels.data(), dense, kZstdLevel);
            check(ZSTD_isError(s->size) == 0);
          },
          [s, dense] {
            check(ZSTD_decompressDCtx(s->decompressor, s->received.data(), dense, s->bytes.data(),
                                      s->size) == dense);
          },
          [s] { return s->size; },
          [s] { return s->received; },
          no_light};
}

TransferForm luanti_form(const LitChunk& chunk, bool lit) {
  struct State {
    std::array<LuantiNodes, kBlocks> nodes, received;
    Bytes bytes;
    std::array<std::size_t, kBlocks + 1> ends{};  // of the blocks, each a packet of its own
  };
  const auto s = std::make_shared<State>();
  each_voxel([&](std::size_t b, std::size_t from, std::size_t x, std::size_t y, std::size_t z) {
    const std::size_t to = x + kBlockSide * (y + kBlockSide * z);
    s->nodes[b].id[to] = static_cast<std::uint16_t>(chunk.voxels[from] + kLuantiAir);
    s->nodes[b].param1[to] = lit ? chunk.light[from] : std::uint8_t{0};
  });
  const auto encode = [s] {
    s->bytes.clear();
    for (std::size_t b = 0; b < kBlocks; ++b) {
      encode_luanti_block(s->nodes[b], s->bytes);
      s->ends[b + 1] = s->bytes.size();
    }
  };
  const auto decode = [s] {
    for (std::size_t b = 0; b < kBlocks; ++b) {
      const ByteView block = ByteView(s->bytes).subspan(s->ends[b], s->ends[b + 1] - s->ends[b]);
      check(decode_luanti_wire(block, s->received[b]).has_value());
    }
  };
  const auto voxels = [s] {
    std::vector<Material> out(kBlocks * kLuantiNodes);
    each_voxel([&](std::size_t b, std::size_t to, std::size_t x, std::size_t y, std::size_t z) {
      out[to] = static_cast<Material>(s->received[b].id[x + kBlockSide * (y + kBlockSide * z)] -
                                      kLuantiAir);
    });
    return out;
  };
  const auto light = [s] {
    std::vector<std::uint8_t> out(kBlocks * kLuantiNodes);
    each_voxel([&](std::size_t b, std::size_t to, std::size_t x, std::size_t y, std::size_t z) {
      out[to] = s->received[b].param1[x + kBlockSide * (y + kBlockSide * z)];
    });
    return out;
  };
  TransferForm form{lit ? "luanti_light" : "luanti", encode, decode,
                    [s] { return s->bytes.size(); }, voxels, no_light};
  if (lit) form.light = light;
  return form;
}

TransferForm minecraft_form(const LitChunk& chunk) {
  struct State {
    std::array<PaletteSection, kBlocks> sections, received;
    Bytes bytes;
  };
  const auto s = std::make_shared<State>();
  each_voxel([&](std::size_t b, std::size_t from, std::size_t x, std::size_t y, std::size_t z) {
    s->sections[b][x + kBlockSide * (z + kBlockSide * y)] = chunk.voxels[from];
  });
  return {
      "minecraft",
      [s] {
        s->bytes.clear();
        encode_palette_sections(s->sections, s->bytes);
      },
      [s] { check(decode_palette_sections(s->bytes, s->received).has_value()); },
      [s] { return s->bytes.size(); },
      [s] {
        std::vector<Material> out(kBlocks * kLuantiNodes);
        each_voxel([&](std::size_t b, std::size_t to, std::size_t x, std::size_t y, std::size_t z) {
          out[to] = s->received[b][x + kBlockSide * (z + kBlockSide * y)];
        });
        return out;
      },
      no_light};
}

TransferForm our_form(std::string_view name, const LitChunk& chunk, ChunkEncoding encoding) {
  struct State {
    std::optional<RunChunk> received;
    Bytes bytes;
  };
  const auto s = std::make_shared<State>();
  return {name,
          [s, &chunk, encoding] {
            s->bytes.clear();
            encode_chunk(chunk.runs, encoding, s->bytes);
          },
          [s] {
            auto decoded = decode_chunk(s->bytes);
            check(decoded.has_value());
            s->received = std::move(*decoded);
          },
          [s] { return s->bytes.size(); },
          [s] { return to_dense(reorder(*s->received, AxisOrder::xyz)); },
          no_light};
}

}  // namespace

std::span<const std::string_view> transfer_form_names() { return kNames; }

std::vector<TransferForm> make_transfer_forms(const LitChunk& chunk) {
  std::vector<TransferForm> out;
  out.push_back(dense_form(chunk));
  out.push_back(dense_zstd_form(chunk));
  out.push_back(luanti_form(chunk, true));
  out.push_back(luanti_form(chunk, false));
  out.push_back(minecraft_form(chunk));
  out.push_back(our_form("raw", chunk, ChunkEncoding::raw));
  out.push_back(our_form("packed", chunk, ChunkEncoding::packed));
  out.push_back(our_form("coded", chunk, ChunkEncoding::coded));
  return out;
}

}  // namespace runstone::bench
