#include "common/formats/png_rows.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr std::array<std::uint8_t, 8> kPngMark = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
constexpr std::string_view kPngHeightKey = "runstone:height_max";

std::uint32_t png_u32(ByteReader& in) {
  std::uint32_t out = 0;
  for (int i = 0; i < 4; ++i) out = out << 8 | in.u8();
  return out;
}

std::string_view png_text(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Result<PngHead> read_png_head(ByteView file, std::uint32_t side_max) {
  ByteReader in(file);
  const ByteView mark = in.bytes(kPngMark.size());
  if (in.ok() && !std::equal(mark.begin(), mark.end(), kPngMark.begin()))
    return fail(ErrorCode::bad_value, "png: is not a PNG", 0);
  const std::uint32_t bytes = png_u32(in);
  const std::string_view id = png_text(in.bytes(4));
  PngHead out;
  out.width = png_u32(in);
  out.height = png_u32(in);
  out.bits = in.u8();
  const std::uint8_t kind = in.u8();
  in.bytes(2);  // packing, filters
  const std::uint8_t interlace = in.u8();
  in.bytes(4);  // checksum
  if (!in.ok()) return fail(ErrorCode::truncated, "png: file ends in its head", file.size());
  if (bytes != 13 || id != "IHDR")
    return fail(ErrorCode::bad_value, "png: does not begin with its head", 8);
  if (out.width < 1 || out.height < 1 || out.width > side_max || out.height > side_max)
    return fail(ErrorCode::limit_exceeded, "png: a side is outside 1 .. 8192", 16);
  if (interlace != 0) return fail(ErrorCode::bad_value, "png: is interlaced", 28);
  out.is_grey = kind == 0 || kind == 4;
  while (in.left() >= 8) {
    const std::uint32_t size = png_u32(in);
    const std::string_view chunk = png_text(in.bytes(4));
    if (chunk == "IDAT" || size > in.left()) break;
    const std::string_view text = png_text(in.bytes(size));
    in.bytes(std::min<std::size_t>(4, in.left()));
    if (chunk == "tEXt" && text.size() > kPngHeightKey.size() && text.starts_with(kPngHeightKey) &&
        text[kPngHeightKey.size()] == '\0')
      out.height_max = text.substr(kPngHeightKey.size() + 1);
  }
  return out;
}

/// libpng jumps out of its functions when it finds an error. So each function here that calls it has
/// only locals without destructors.
struct PngRows::State {
  png_structp png = nullptr;
  png_infop info = nullptr;
  const std::uint8_t* bytes = nullptr;
  std::size_t size = 0, at = 0;
  std::size_t row_bytes = 0;

  static void on_error(png_structp png, png_const_charp) { png_longjmp(png, 1); }
  static void on_warning(png_structp, png_const_charp) {}
  static void on_read(png_structp png, png_bytep out, png_size_t count) {
    auto* state = static_cast<State*>(png_get_io_ptr(png));
    if (count > state->size - state->at) png_longjmp(png, 1);
    std::memcpy(out, state->bytes + state->at, count);
    state->at += count;
  }

  bool start(Pixel pixel) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_read_fn(png, this, on_read);
    png_set_chunk_cache_max(png, 128);
    png_set_chunk_malloc_max(png, png_alloc_size_t{1} << 20);
    // libpng takes memory for the length that a text or a profile states, up to 2 GiB, before it
    // reads one byte of it. None of them is needed, so all optional chunks but tRNS are skipped.
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    // Colours are taken as they are stored.
    png_read_info(png, info);
    const unsigned bits = png_get_bit_depth(png, info);
    if (pixel == Pixel::grey16) {
      if (bits < 8) png_set_expand_gray_1_2_4_to_8(png);
      if (bits <= 8) png_set_expand_16(png);
    } else {
      png_set_expand(png);
      png_set_scale_16(png);
      png_set_gray_to_rgb(png);
    }
    png_set_strip_alpha(png);
    png_read_update_info(png, info);
    row_bytes = png_get_rowbytes(png, info);
    return true;
  }
  bool read(std::uint8_t* row) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_read_row(png, row, nullptr);
    return true;
  }
  bool finish() {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_read_end(png, nullptr);
    return true;
  }
};

void PngRows::StateDeleter::operator()(State* state) const {
  png_destroy_read_struct(&state->png, &state->info, nullptr);
  delete state;
}

Result<PngRows> PngRows::open(ByteView file, Pixel pixel) {
  std::unique_ptr<State, StateDeleter> state(new State);
  state->bytes = file.data();
  state->size = file.size();
  state->png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, State::on_error, State::on_warning);
  RUNSTONE_ASSERT(state->png != nullptr);
  state->info = png_create_info_struct(state->png);
  RUNSTONE_ASSERT(state->info != nullptr);
  if (!state->start(pixel))
    return fail(ErrorCode::bad_value, "png: is damaged before its pixels", state->at);
  return PngRows(std::move(state));
}

Result<void> PngRows::read(std::span<std::uint8_t> row) {
  if (row.size() != state_->row_bytes)
    return fail(ErrorCode::bad_value, "png: has other pixels than its head says", state_->at);
  if (state_->read(row.data())) return {};
  return fail(ErrorCode::bad_value, "png: pixels are damaged or end early", state_->at);
}

Result<void> PngRows::finish() {
  if (state_->finish()) return {};
  return fail(ErrorCode::bad_value, "png: is damaged behind its pixels, or ends early", state_->at);
}

}  // namespace runstone
