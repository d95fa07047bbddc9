// GivenShapes: shapes that a record of the log gives to materials of the world that are cubes.
// docs/edit-log.md specifies the bytes.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/given_shape.hpp"
#include "common/core/result.hpp"
#include "common/shapes/shape_bytes.hpp"

namespace runstone {

struct GivenShapes {
  std::vector<GivenShape> rows;  // 1 .. kGivenShapesMax, ascending by material
  friend bool operator==(const GivenShapes&, const GivenShapes&) = default;
};

/// The rows of one record, at most.
inline constexpr std::size_t kGivenShapesMax = 512;
/// The different shapes of one record, at most.
inline constexpr std::size_t kDifferentShapesMax = 256;
/// The maximum size of the bytes: both counts, the shapes, and of each row the step from the
/// material before and the number of its shape. A record is then no larger than the largest edit of
/// a player.
inline constexpr std::size_t kGivenShapesBytesMax =
    2 + kDifferentShapesMax * kShapeBytesMax + 2 + kGivenShapesMax * (3 + 2);

/// Fails if a shape is not valid or a cube, if the materials do not ascend or are out of range, or
/// if there are too many rows or different shapes. Cost: O(n log n).
Result<void> validate(const GivenShapes& given);

/// Returns the first rows, as many as one record may have. Requires at least one row, and rows that
/// are valid and ascend by material. Cost: O(n log n) for the rows that are returned.
GivenShapes first_of(std::span<const GivenShape> rows);

/// Appends the canonical bytes: the different shapes, then each material with the number of its
/// shape. Requires validate().
void write_given_shapes(ByteWriter& w, const GivenShapes& given);
/// Reads what write_given_shapes() wrote. A failure is found in the reader, also if the shapes do
/// not ascend, or if one is used by no row. The result is not validated. Memory: O(bytes) and a
/// copy of a shape for each row, thus at most 512 x 32 boxes.
GivenShapes read_given_shapes(ByteReader& r);

}  // namespace runstone
