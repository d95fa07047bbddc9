// PngRows: the rows of a PNG, one after the other, by libpng. Internal to height maps. Every byte is
// untrusted: the sides are checked before libpng sees the file, and a row is all that is decoded at
// once.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

struct PngHead {
  std::uint32_t width = 0, height = 0;
  unsigned bits = 8;  // of a sample
  bool is_grey = false;
  std::string_view height_max;  // value of the text "runstone:height_max" before the pixels
};

/// Fails if the file is no PNG, has sides outside 1 .. `side_max`, or is interlaced. The offset of an
/// error is a byte of the file.
Result<PngHead> read_png_head(ByteView file, std::uint32_t side_max);

class PngRows {
 public:
  /// Grey samples of 16 bits, upper byte first (8 bits as v * 256), or red, green and blue of 8 bits.
  enum class Pixel { grey16, rgb8 };
  static constexpr std::size_t bytes_of(Pixel pixel) { return pixel == Pixel::grey16 ? 2 : 3; }

  /// Fails with bad_value if the file is damaged before its pixels. `file` must outlive the rows, and
  /// read_png_head() must accept it. Requires a grey PNG for grey16.
  static Result<PngRows> open(ByteView file, Pixel pixel);

  /// Reads the next row: width * bytes_of(pixel) bytes. Fails with bad_value if the file is damaged or
  /// ends early. Requires a row that is left.
  Result<void> read(std::span<std::uint8_t> row);
  /// Reads the end of the file. Fails if it is missing or damaged.
  Result<void> finish();

 private:
  struct State;
  struct StateDeleter {
    void operator()(State* state) const;
  };
  explicit PngRows(std::unique_ptr<State, StateDeleter> state) : state_(std::move(state)) {}
  std::unique_ptr<State, StateDeleter> state_;
};

}  // namespace runstone
