#include "tests/support/formats/vox_bytes.hpp"

namespace runstone::test {
namespace {

void append(Bytes& out, const Bytes& more) { out.insert(out.end(), more.begin(), more.end()); }

void append(Bytes& out, std::string_view more) { out.insert(out.end(), more.begin(), more.end()); }

void append_number(Bytes& out, std::int64_t number) {
  for (unsigned shift : {0U, 8U, 16U, 24U})
    out.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> shift));
}

}  // namespace

Bytes vox_chunk(std::string_view id, const Bytes& content) {
  Bytes out;
  append(out, id);
  append_number(out, static_cast<std::int64_t>(content.size()));
  append_number(out, 0);
  append(out, content);
  return out;
}

Bytes vox_model(std::array<std::int32_t, 3> sides, const std::vector<VoxVoxel>& voxels) {
  Bytes size, content;
  for (const std::int32_t side : sides) append_number(size, side);
  append_number(content, static_cast<std::int64_t>(voxels.size()));
  for (const VoxVoxel& voxel : voxels) content.insert(content.end(), voxel.begin(), voxel.end());
  Bytes out = vox_chunk("SIZE", size);
  append(out, vox_chunk("XYZI", content));
  return out;
}

Bytes vox_pairs(const VoxPairs& pairs) {
  Bytes out;
  append_number(out, static_cast<std::int64_t>(pairs.size()));
  for (const auto& [key, value] : pairs) {
    append_number(out, static_cast<std::int64_t>(key.size()));
    append(out, key);
    append_number(out, static_cast<std::int64_t>(value.size()));
    append(out, value);
  }
  return out;
}

Bytes vox_numbered(std::string_view chunk_id, std::int32_t id, const VoxPairs& pairs,
                   const Bytes& behind) {
  Bytes content;
  append_number(content, id);
  append(content, vox_pairs(pairs));
  append(content, behind);
  return vox_chunk(chunk_id, content);
}

Bytes vox_transform(std::int32_t id, std::int32_t child, const VoxPairs& frame,
                    const VoxPairs& attributes, std::int32_t layer) {
  Bytes behind;
  append_number(behind, child);
  append_number(behind, -1);
  append_number(behind, layer);
  append_number(behind, 1);
  append(behind, vox_pairs(frame));
  return vox_numbered("nTRN", id, attributes, behind);
}

Bytes vox_group(std::int32_t id, const std::vector<std::int32_t>& children) {
  Bytes behind;
  append_number(behind, static_cast<std::int64_t>(children.size()));
  for (const std::int32_t child : children) append_number(behind, child);
  return vox_numbered("nGRP", id, {}, behind);
}

Bytes vox_shape(std::int32_t id, std::int32_t model) {
  Bytes behind;
  append_number(behind, 1);
  append_number(behind, model);
  append(behind, vox_pairs({}));
  return vox_numbered("nSHP", id, {}, behind);
}

Bytes vox_file(const std::vector<Bytes>& chunks, std::uint32_t version) {
  Bytes all;
  for (const Bytes& chunk : chunks) append(all, chunk);
  Bytes out;
  append(out, "VOX ");
  append_number(out, version);
  append(out, "MAIN");
  append_number(out, 0);
  append_number(out, static_cast<std::int64_t>(all.size()));
  append(out, all);
  return out;
}

}  // namespace runstone::test
