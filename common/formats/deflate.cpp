#include "common/formats/deflate.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr int kWindowBits = 15;
// zlib counts in 32 bits, so both sides are given in parts.
constexpr std::size_t kZlibPartMax = std::size_t{1} << 30;
constexpr std::size_t kInflatePartMin = 16'384;

int window_bits_of(DeflateForm form) {
  switch (form) {
    case DeflateForm::zlib:
      return kWindowBits;
    case DeflateForm::gzip:
      return kWindowBits + 16;
    case DeflateForm::raw:
      return -kWindowBits;
    case DeflateForm::zlib_or_gzip:
      break;
  }
  return kWindowBits + 32;
}

}  // namespace

struct Inflater::State {
  z_stream stream{};
};

void Inflater::StateDeleter::operator()(State* state) const {
  inflateEnd(&state->stream);
  delete state;
}

Inflater::Inflater(ByteView packed, DeflateForm form) : state_(new State), packed_(packed) {
  const int begun = inflateInit2(&state_->stream, window_bits_of(form));
  RUNSTONE_ASSERT(begun == Z_OK);
}

std::size_t Inflater::packed_offset() const { return given_ - state_->stream.avail_in; }

Result<std::size_t> Inflater::read(std::span<std::uint8_t> out) {
  z_stream& stream = state_->stream;
  std::size_t filled = 0;
  while (filled < out.size() && !at_end_) {
    if (stream.avail_in == 0) {
      const std::size_t part = std::min(packed_.size() - given_, kZlibPartMax);
      stream.next_in = const_cast<Bytef*>(packed_.data() + given_);
      stream.avail_in = static_cast<uInt>(part);
      given_ += part;
    }
    const std::size_t room = std::min(out.size() - filled, kZlibPartMax);
    stream.next_out = out.data() + filled;
    stream.avail_out = static_cast<uInt>(room);
    const int status = inflate(&stream, Z_NO_FLUSH);
    filled += room - stream.avail_out;
    at_end_ = status == Z_STREAM_END;
    if (status == Z_OK || at_end_) continue;
    if (status == Z_BUF_ERROR)
      return fail(ErrorCode::truncated, "a deflate stream ends early", packed_offset());
    return fail(ErrorCode::bad_value, "not a deflate stream, or a damaged one", packed_offset());
  }
  return filled;
}

Result<std::size_t> inflate_all(ByteView data, std::size_t at, DeflateForm form,
                                std::size_t bytes_max, Bytes* out) {
  RUNSTONE_ASSERT(at <= data.size());
  Inflater in(data.subspan(at), form);
  Bytes dropped;
  Bytes& to = out != nullptr ? *out : dropped;
  const std::size_t first = to.size();
  std::size_t total = 0;
  while (true) {
    const std::size_t kept = out != nullptr ? first + total : 0;
    // One byte more than allowed shows that the stream is too long.
    const std::size_t part =
        std::min(std::max(kept - first, kInflatePartMin) - 1, bytes_max - total) + 1;
    to.resize(kept + part);
    const auto made = in.read(std::span(to).subspan(kept));
    total += made ? *made : 0;
    if (out != nullptr) to.resize(first + std::min(total, bytes_max));
    if (!made) return fail(made.error().code, made.error().what, at + made.error().offset);
    if (total > bytes_max) {
      return fail(ErrorCode::limit_exceeded, "a deflate stream is too long",
                  at + in.packed_offset());
    }
    if (in.at_end()) return at + in.packed_offset();
  }
}

struct Deflater::State {
  z_stream stream{};
};

void Deflater::StateDeleter::operator()(State* state) const {
  deflateEnd(&state->stream);
  delete state;
}

Deflater::Deflater(DeflateForm form, int level, Bytes& out) : state_(new State), out_(out) {
  RUNSTONE_ASSERT(form != DeflateForm::zlib_or_gzip && level >= 1 && level <= 9);
  constexpr int kMemoryLevel = 8;
  const int begun = deflateInit2(&state_->stream, level, Z_DEFLATED, window_bits_of(form),
                                 kMemoryLevel, Z_DEFAULT_STRATEGY);
  RUNSTONE_ASSERT(begun == Z_OK);
}

void Deflater::run(int flush) {
  z_stream& stream = state_->stream;
  int status = Z_OK;
  do {
    const std::size_t filled = out_.size();
    out_.resize(filled + kInflatePartMin);
    stream.next_out = out_.data() + filled;
    stream.avail_out = static_cast<uInt>(kInflatePartMin);
    status = deflate(&stream, flush);
    RUNSTONE_ASSERT(status != Z_STREAM_ERROR);
    out_.resize(filled + kInflatePartMin - stream.avail_out);
  } while (flush == Z_FINISH ? status != Z_STREAM_END : stream.avail_in != 0);
}

void Deflater::write(ByteView plain) {
  while (!plain.empty()) {
    const std::size_t part = std::min(plain.size(), kZlibPartMax);
    state_->stream.next_in = const_cast<Bytef*>(plain.data());
    state_->stream.avail_in = static_cast<uInt>(part);
    run(Z_NO_FLUSH);
    plain = plain.subspan(part);
  }
}

void Deflater::finish() { run(Z_FINISH); }

Bytes deflate_all(ByteView plain, DeflateForm form, int level) {
  Bytes out;
  Deflater deflater(form, level, out);
  deflater.write(plain);
  deflater.finish();
  return out;
}

}  // namespace runstone
