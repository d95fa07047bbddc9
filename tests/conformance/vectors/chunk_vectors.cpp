#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/hash.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/conformance/vectors/vector_values.hpp"

namespace runstone::conformance {
namespace {

struct NamedChunk {
  std::string name;
  RunChunk chunk;
};

/// 3 voxels of material 1, 197 of air, the rest of material 300, y fastest: the chunk of
/// docs/protocol.md.
RunChunk page_chunk() {
  RunBuilder builder({8, 8, 8}, AxisOrder::yxz);
  builder.append_to(3, 1);
  builder.append_to(200, kEmpty);
  builder.append_to(512, 300);
  return builder.finish();
}

RunChunk noise_chunk(Extent extent, AxisOrder order, unsigned materials) {
  RunBuilder builder(extent, order);
  for (VoxelIndex i = 0; i < extent.volume(); ++i)
    builder.append(1, static_cast<Material>(mix64(i ^ 0x5eedU) % materials));
  return builder.finish();
}

/// Runs of `lengths` in turn, with the materials 0, 1, 2 and so on up to `materials` in turn.
RunChunk striped_chunk(Extent extent, AxisOrder order, const std::vector<std::uint32_t>& lengths,
                       unsigned materials) {
  RunBuilder builder(extent, order);
  for (std::uint32_t i = 0; builder.filled() < extent.volume(); ++i) {
    const std::uint32_t left = extent.volume() - builder.filled();
    builder.append(std::min(left, lengths[i % lengths.size()]),
                   static_cast<Material>(i % materials));
  }
  return builder.finish();
}

std::vector<NamedChunk> chunks_of_vectors() {
  std::vector<NamedChunk> out;
  out.push_back({"the chunk of docs/protocol.md", page_chunk()});
  out.push_back({"air", uniform_chunk(Extent::cube(16), kEmpty)});
  out.push_back({"one material", uniform_chunk(Extent::cube(32), 1, AxisOrder::zyx)});
  out.push_back({"the largest material", uniform_chunk(Extent::cube(64), 65'535)});
  for (const AxisOrder order : kAxisOrders) {
    out.push_back({std::string("sides that differ, ") + name_of(order),
                   striped_chunk({8, 9, 10}, order, {1, 3, 8, 40, 90}, 4)});
  }
  out.push_back({"ground of edge 16", ground_chunk({0, 0, 0}, 16, AxisOrder::yxz)});
  out.push_back({"ground of edge 32", ground_chunk({-1, 0, 2}, 32, AxisOrder::zxy)});
  out.push_back({"noise of 2 materials", noise_chunk({8, 8, 8}, AxisOrder::xyz, 2)});
  out.push_back({"noise of 5 materials", noise_chunk({8, 8, 8}, AxisOrder::yzx, 5)});
  out.push_back({"a palette of more than 256", noise_chunk({8, 8, 12}, AxisOrder::xzy, 900)});
  out.push_back(
      {"lengths of 191, 192 and more",
       striped_chunk(Extent::cube(16), AxisOrder::xyz, {191, 192, 193, 400, 5, 16, 32, 1008}, 3)});
  out.push_back({"a volume of more than 65,535",
                 striped_chunk(Extent::cube(64), AxisOrder::xyz, {70'000, 1, 64, 4'095}, 3)});
  out.push_back({"edge 128, the largest",
                 striped_chunk(Extent::cube(128), AxisOrder::zyx, {1'000'000, 128, 1, 2'000}, 4)});
  return out;
}

Json entry_of(const NamedChunk& named) {
  const RunChunk& chunk = named.chunk;
  Json runs = Json::array();
  for (std::size_t i = 0; i < chunk.runs.size(); ++i)
    runs.push_back({chunk.runs.end(i), chunk.runs.material(i)});
  Json bytes = {{"raw", raw_hex(chunk)}};
  const Bytes packed = encode_chunk(chunk, ChunkEncoding::packed);
  // Other releases of zstd make other bytes.
  if ((packed[2] & 8) == 0) bytes["packed"] = to_hex(packed);
  bytes["coded"] = to_hex(encode_chunk(chunk, ChunkEncoding::coded));
  return {{"name", named.name},
          {"sides", {chunk.extent.x, chunk.extent.y, chunk.extent.z}},
          {"order", name_of(chunk.order)},
          {"runs", std::move(runs)},
          {"digest", json_of(digest_of(chunk))},
          {"bytes", std::move(bytes)}};
}

/// A chunk whose body is a zstd frame: 64 times 40 voxels of material 1 and 24 of air. The bytes
/// are those of one release of zstd.
Json compressed_entry() {
  static constexpr const char* kBytes =
      "02010d101010800102000020ff7d0000200100fe28030004920c27dd5deab0";
  RunBuilder builder(Extent::cube(16), AxisOrder::zyx);
  for (int i = 0; i < 64; ++i) {
    builder.append(40, 1);
    builder.append(24, kEmpty);
  }
  Json entry = entry_of({"a body in a zstd frame", builder.finish()});
  entry["bytes"]["packed"] = kBytes;
  return entry;
}

Bytes hex(std::string_view digits) {
  Bytes out(digits.size() / 2);
  const bool read = read_hex(digits, out);
  RUNSTONE_ASSERT(read);
  return out;
}

/// Collects bytes that a reader must refuse.
class Refusals {
 public:
  void add(const std::string& name, const Bytes& bytes) {
    const auto decoded = decode_chunk(bytes);
    RUNSTONE_ASSERT(!decoded.has_value());
    out_.push_back(refusal_of(name, bytes, decoded));
  }
  /// Adds each truncation that is not the spelling of another chunk.
  void add_truncations(const std::string& name, const Bytes& bytes) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const Bytes part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      if (!decode_chunk(part)) add(name + ", cut after byte " + std::to_string(size), part);
    }
  }
  /// Adds the bytes with one of them replaced.
  void add_changed(const std::string& name, Bytes bytes, std::size_t at, std::uint8_t value) {
    bytes[at] = value;
    add(name, bytes);
  }
  void add_longer(const std::string& name, Bytes bytes) {
    bytes.push_back(0);
    add(name, bytes);
  }
  Json take() { return std::move(out_); }

 private:
  Json out_ = Json::array();
};

Json refused_chunks() {
  Refusals out;
  out.add("no encoding 0", hex("0001020008080800"));
  out.add("no encoding 4", hex("0401020008080800"));
  const Bytes raw = encode_chunk(page_chunk(), ChunkEncoding::raw);
  out.add_truncations("raw", raw);
  out.add_longer("raw, a byte too many", raw);
  out.add_changed("raw, version 2", raw, 1, 2);
  out.add_changed("raw, axis order 6", raw, 2, 6);
  out.add_changed("raw, byte 3 is not 0", raw, 3, 1);
  out.add_changed("raw, side 7", raw, 4, 7);
  out.add_changed("raw, side 129", raw, 5, 129);
  out.add_changed("raw, byte 7 is not 0", raw, 7, 1);
  out.add("raw, no runs", hex("010102000808080000000000"));
  out.add("raw, more runs than voxels", hex("0101020008080800ffffffff03000100"));
  out.add("raw, ends that fall", hex("01010200080808000300000003000100020000000002"
                                     "2c01"));
  out.add("raw, an end twice", hex("010102000808080003000000030001000300000000022c01"));
  out.add("raw, the last end is not the volume", hex("010102000808080003000000"
                                                     "03000100"
                                                     "c8000000"
                                                     "ff012c01"));
  out.add("raw, the last end is beyond the volume", hex("010102000808080003000000"
                                                        "03000100"
                                                        "c8000000"
                                                        "01022c01"));
  out.add("raw, neighbours of one material", hex("010102000808080003000000"
                                                 "03000100"
                                                 "c8000100"
                                                 "00022c01"));

  const Bytes packed = encode_chunk(page_chunk(), ChunkEncoding::packed);
  out.add_truncations("packed", packed);
  out.add_longer("packed, a byte too many", packed);
  out.add_changed("packed, version 0", packed, 1, 0);
  out.add_changed("packed, axis order 7", packed, 2, 7);
  out.add_changed("packed, bit 4 of the axis order", packed, 2, 18);
  out.add_changed("packed, no runs", packed, 6, 0);
  out.add_changed("packed, a palette of more materials than runs", packed, 7, 4);
  out.add("packed, more runs than voxels", hex("0201020808088104"
                                               "0300"
                                               "00aa02"
                                               "010002e703"));
  out.add("packed, a number that is not written in the shortest way", hex("020102080808"
                                                                          "8300"
                                                                          "03"
                                                                          "0000aa02"
                                                                          "010002"
                                                                          "e703"));
  out.add("packed, a material above 65,535", hex("020102080808"
                                                 "03"
                                                 "03"
                                                 "0000ffff03"
                                                 "010002"
                                                 "e703"));
  out.add("packed, a material of the palette does not occur", hex("020102080808"
                                                                  "03"
                                                                  "03"
                                                                  "0000aa02"
                                                                  "010001"
                                                                  "e703"));
  out.add("packed, an index beyond the palette", hex("020102080808"
                                                     "03"
                                                     "03"
                                                     "0000aa02"
                                                     "010003"
                                                     "e703"));
  out.add("packed, neighbours of one material", hex("020102080808"
                                                    "03"
                                                    "03"
                                                    "0000aa02"
                                                    "010102"
                                                    "e703"));
  out.add("packed, a run that ends with a line and is written by its length", hex("020102080808"
                                                                                  "03"
                                                                                  "03"
                                                                                  "0000aa02"
                                                                                  "010002"
                                                                                  "00"
                                                                                  "03"
                                                                                  "c501"));
  out.add("packed, a zstd frame that is cut",
          hex("02010d101010800102000020ff7d0000200100fe28030004920c27dd5d"));
  out.add("packed, a zstd frame that does not tell its content size",
          hex("02010d101010800102000000587d0000200100fe28030004920c27dd5deab0"));

  const Bytes coded = encode_chunk(page_chunk(), ChunkEncoding::coded);
  out.add_truncations("coded", coded);
  out.add_longer("coded, a byte too many", coded);
  out.add_changed("coded, version 2", coded, 1, 2);
  out.add_changed("coded, axis order 8", coded, 2, 8);
  out.add("coded, a body that begins with ff ff ff ff", hex("030102080808"
                                                            "03"
                                                            "0000aa02"
                                                            "ffffffff00"));
  out.add("coded, a palette of one material and a body", hex("030100202020"
                                                             "01"
                                                             "01"
                                                             "00"));
  out.add("coded, no palette", hex("030100202020"
                                   "00"));
  return out.take();
}

}  // namespace

Json chunk_vectors() {
  Json chunks = Json::array();
  for (const NamedChunk& named : chunks_of_vectors()) chunks.push_back(entry_of(named));
  chunks.push_back(compressed_entry());
  return {{"format", "runstone chunk vectors 1"},
          {"chunks", std::move(chunks)},
          {"refused", refused_chunks()}};
}

}  // namespace runstone::conformance
