#include "common/formats/qb.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/formats/grid_pieces.hpp"
#include "common/formats/vox_look.hpp"
#include "common/runs/cut.hpp"

namespace runstone {
namespace {

constexpr std::uint32_t kQbCode = 2, kQbNextSlice = 6;

class QbReader {
 public:
  QbReader(ByteView file, const PieceSink& sink) : in_(file), sink_(sink) {}

  Result<void> read();

 private:
  Result<void> read_matrix();
  Result<void> read_slice(GridPieces& pieces, std::uint64_t cells);
  Result<void> append(GridPieces& pieces, std::uint64_t count, std::uint32_t data);
  Unexpected<Error> at(ErrorCode code, const char* what) const {
    return fail(code, what, in_.offset());
  }
  Unexpected<Error> ends() const { return at(ErrorCode::truncated, "qb: file ends in a matrix"); }

  ByteReader in_;
  const PieceSink& sink_;
  bool is_bgra_ = false, is_right_handed_ = false, is_compressed_ = false;
  std::vector<ForeignBlock> blocks_;
  std::map<std::uint32_t, Material> materials_;  // by colour
  std::uint64_t cells_ = 0;
};

Result<void> QbReader::append(GridPieces& pieces, std::uint64_t count, std::uint32_t data) {
  if (data >> 24 == 0) return pieces.append(count, 0);
  const std::uint32_t rgb = data & 0xff'ffffU;
  const auto [known, is_new] = materials_.try_emplace(rgb, Material{0});
  if (is_new) {
    if (blocks_.size() == kMaterialCountMax - 1)
      return at(ErrorCode::limit_exceeded, "qb: more than 65535 colours");
    MaterialColour colour{static_cast<std::uint8_t>(rgb), static_cast<std::uint8_t>(rgb >> 8),
                          static_cast<std::uint8_t>(rgb >> 16), 255};
    if (is_bgra_) std::swap(colour[0], colour[2]);
    blocks_.push_back({"colour " + vox_colour_text(colour), "", ForeignLook{colour}});
    known->second = static_cast<Material>(blocks_.size());
  }
  return pieces.append(count, known->second);
}

Result<void> QbReader::read_slice(GridPieces& pieces, std::uint64_t cells) {
  while (true) {
    std::uint32_t data = in_.u32();
    std::uint64_t count = 1;
    if (!in_.ok()) return ends();
    if (data == kQbNextSlice) break;
    if (data == kQbCode) {
      count = in_.u32();
      data = in_.u32();
      if (!in_.ok()) return ends();
    }
    if (count > cells)
      return at(ErrorCode::bad_value, "qb: a slice has more voxels than its sides");
    cells -= count;
    if (auto done = append(pieces, count, data); !done) return done;
  }
  // Layers that a slice lacks at its end are empty.
  return pieces.append(cells, 0);
}

Result<void> QbReader::read_matrix() {
  in_.bytes(in_.u8());  // the name
  VoxelPos sides, place;
  for (std::int32_t* side : {&sides.x, &sides.y, &sides.z})
    *side = static_cast<std::int32_t>(in_.u32());
  for (std::int32_t* part : {&place.x, &place.y, &place.z}) {
    *part = static_cast<std::int32_t>(in_.u32());
    if (*part < -kWorldLimit || *part >= kWorldLimit)
      return at(ErrorCode::bad_value, "qb: a matrix lies outside the world");
  }
  if (!in_.ok()) return ends();
  // Its documentation calls the lowest corner the place of a matrix.
  const PieceSink turned = [&](ForeignPiece&& piece) {
    if (!is_right_handed_) {
      const Extent extent = piece.voxels.extent;
      piece.origin.z = -(piece.origin.z + extent.z);
      piece.voxels = cut(piece.voxels, {0, 0, 0}, extent, 4);
    }
    return sink_(std::move(piece));
  };
  if (!GridPieces::are_sides(sides, AxisOrder::xyz))
    return at(ErrorCode::limit_exceeded, "qb: a side of a matrix is outside 1 .. 1048576");
  const VoxelBox box{place, {place.x + sides.x, place.y + sides.y, place.z + sides.z}};
  GridPieces pieces(box, AxisOrder::xyz, blocks_, turned);
  cells_ += pieces.left();
  if (cells_ > kQbCellsMax)
    return at(ErrorCode::limit_exceeded, "qb: matrices have more than 2^32 cells");
  if (is_compressed_) {
    for (std::int32_t z = 0; z < sides.z; ++z) {
      const std::uint64_t cells =
          static_cast<std::uint64_t>(sides.x) * static_cast<std::uint64_t>(sides.y);
      if (auto done = read_slice(pieces, cells); !done) return done;
    }
    return {};
  }
  if (pieces.left() > in_.left() / 4) return ends();
  while (pieces.left() > 0) {
    if (auto done = append(pieces, 1, in_.u32()); !done) return done;
  }
  return {};
}

Result<void> QbReader::read() {
  const std::uint32_t version = in_.u32();
  if (in_.ok() && version != 0x0101)
    return fail(ErrorCode::bad_version, "qb: is not a .qb of version 1.1", 0);
  const std::uint32_t order = in_.u32(), hand = in_.u32(), compressed = in_.u32();
  in_.u32();  // whether alpha is a mask of faces
  const std::uint32_t matrices = in_.u32();
  if (!in_.ok()) return fail(ErrorCode::truncated, "qb: file ends in its head", in_.offset());
  if (order > 1 || hand > 1 || compressed > 1)
    return fail(ErrorCode::bad_value, "qb: a flag of the head is neither 0 nor 1", 4);
  if (matrices > kQbMatricesMax)
    return fail(ErrorCode::limit_exceeded, "qb: more than 65536 matrices", 20);
  is_bgra_ = order == 1;
  is_right_handed_ = hand == 1;
  is_compressed_ = compressed == 1;
  for (std::uint32_t i = 0; i < matrices; ++i) {
    if (auto done = read_matrix(); !done) return done;
  }
  return {};
}

}  // namespace

Result<ForeignInfo> read_qb(ByteView file, const PieceSink& sink) {
  if (auto done = QbReader(file, sink).read(); !done) return failure(done.error());
  return ForeignInfo{};
}

}  // namespace runstone
